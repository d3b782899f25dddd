// Bounding boxes of links: a kernel of quick calls.

#include "export.h"
#include "quick_calls.h"
#include "turns.h"

namespace {

double along(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector absolute(Vector v) { return {__builtin_fabs(v.x), __builtin_fabs(v.y), __builtin_fabs(v.z)}; }

}  // namespace

// Arguments: body, link, connection.
extern "C" CAROM_EXPORT int carom_link_box(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    if (!body.boxes || !has_link(body, in[1]))
        return 0;
    const int64_t link = static_cast<int64_t>(in[1]);
    const Box& box = body.boxes[link + 1];
    const double* pose = link < 0 ? body.position : body.pose + (link + 1) * POSE_NUMBERS;
    const Quaternion q = quaternion_at(pose + 3);
    if (!(dot(q, q) > 0.0))
        return 0;
    double center[3], half[3];
    for (int axis = 0; axis < 3; ++axis)
        center[axis] = box.center[axis], half[axis] = box.half[axis];
    if (box.is_moved) {
        Matrix turn = matrix_of(q);
        if (!box.is_turned)
            turn.rows[0] = {1.0, 0.0, 0.0}, turn.rows[1] = {0.0, 1.0, 0.0}, turn.rows[2] = {0.0, 0.0, 1.0};
        for (int axis = 0; axis < 3; ++axis) {
            center[axis] = along(turn.rows[axis], vector_at(box.center)) + pose[axis];
            half[axis] = along(absolute(turn.rows[axis]), vector_at(box.half));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        out[axis] = center[axis] - half[axis];
        out[3 + axis] = center[axis] + half[axis];
    }
    return 2;
}
