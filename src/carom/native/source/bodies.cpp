// Reading and writing the state of bodies: kernels of quick calls.

#include "export.h"
#include "rows.h"

#define CAROM_QUICK(name) extern "C" CAROM_EXPORT int carom_##name(const double* in, double* out, const Call* call)

namespace {

// Numbers in the state of a link, and the maximum number of links in one call; more are left to Python.
enum { LINK_NUMBERS = 3 * POSE_NUMBERS + SPATIAL_NUMBERS, MAX_LINKS = 32 };

bool is_given(double number) { return number == number; }

struct Pose {
    Vector position;
    Quaternion orientation;
};

// Pose of the inertial frame of a link; -1 is the base.
Pose pose_of(const Body& body, int64_t link) {
    if (link < 0)
        return {vector_at(body.position), canonical(quaternion_at(body.position + 3))};
    const double* row = body.pose + (link + 1) * POSE_NUMBERS;
    return {vector_at(row), quaternion_at(row + 3)};
}

void push(const Body& body, int64_t link, Vector force, Vector torque) {
    double* row = body.wrench + (link + 1) * SPATIAL_NUMBERS;
    const double factor = body.force_factor;
    put(put(row, vector_at(row) + factor * force), vector_at(row + 3) + factor * torque);
}

}  // namespace

// Arguments: body, connection.
CAROM_QUICK(base_pose) {
    const Pose pose = pose_of(*call->body, -1);
    put(put(out, pose.position), pose.orientation);
    return 2;
}

// Arguments: body, link; -1 is the base.
CAROM_QUICK(inertial_frame) {
    if (!has_link(*call->body, in[1]))
        return 0;
    const Pose pose = pose_of(*call->body, static_cast<int64_t>(in[1]));
    put(put(out, pose.position), pose.orientation);
    return 2;
}

// Arguments: body, connection.
CAROM_QUICK(base_velocity) {
    const double* velocity = call->body->velocity;
    put(put(out, vector_at(velocity + 3)), vector_at(velocity));
    return 2;
}

// Arguments: body, link, force, position, frame, connection.
CAROM_QUICK(apply_force) {
    const Body& body = *call->body;
    const double frame = in[8];
    if (!has_link(body, in[1]) || (frame != codes::WORLD_FRAME && frame != codes::LINK_FRAME))
        return 0;
    const int64_t link = static_cast<int64_t>(in[1]);
    const Pose pose = pose_of(body, link);
    Vector force = vector_at(in + 2), arm = vector_at(in + 5);
    if (frame == codes::LINK_FRAME)
        force = turned(pose.orientation, force), arm = turned(pose.orientation, arm);
    else
        arm = arm - pose.position;
    push(body, link, force, cross(arm, force));
    return 1;
}

// Arguments: body, link, torque, frame, connection.
CAROM_QUICK(apply_torque) {
    const Body& body = *call->body;
    const double frame = in[5];
    if (!has_link(body, in[1]) || (frame != codes::WORLD_FRAME && frame != codes::LINK_FRAME))
        return 0;
    const int64_t link = static_cast<int64_t>(in[1]);
    Vector torque = vector_at(in + 2);
    if (frame == codes::LINK_FRAME)
        torque = turned(pose_of(body, link).orientation, torque);
    push(body, link, {0.0, 0.0, 0.0}, torque);
    return 1;
}

// Contacts of a scene are not warm started in the next step, because a body was moved; as in `contact_arrays.py`. It is
// called as a kernel is.
extern "C" CAROM_EXPORT void carom_start_cold(void* its_scene, void*) {
    const Scene& scene = *static_cast<const Scene*>(its_scene);
    for (int32_t i = 0; i < *scene.contact_count && i < scene.contact_room; ++i) {
        double& counter = scene.contact_warm_starts[i];
        const bool held = counter == contacts::HOLDING || counter == contacts::HELD_BEFORE;
        counter = held ? contacts::HELD_BEFORE : 0.0;
    }
}

// Arguments: body, position, orientation, connection.
CAROM_QUICK(place_base) {
    const Body& body = *call->body;
    const Scene& scene = *call->client->scene;
    const Lock lock(*call->client);
    if (!lock.is_held || !scene.find_poses.call.function)
        return 0;
    const Quaternion q = quaternion_at(in + 4);
    const double squared = dot(q, q);
    // A pose that was read and is written back stays exactly the same.
    const double scale =
        __builtin_fabs(squared - 1.0) < magnitudes::UNIT_ROUNDING ? 1.0 : 1.0 / __builtin_sqrt(squared);
    for (int i = 0; i < SPATIAL_NUMBERS; ++i)
        body.velocity[i] = 0.0;
    double before[POSE_NUMBERS];
    for (int i = 0; i < POSE_NUMBERS; ++i)
        before[i] = body.position[i];
    put(put(body.position, vector_at(in + 1)), Quaternion{q.x * scale, q.y * scale, q.z * scale, q.w * scale});
    bool moved = false;
    for (int i = 0; i < POSE_NUMBERS; ++i)
        moved |= body.position[i] != before[i];
    note_reset(scene, body.tree, moved);
    carom_start_cold(const_cast<Scene*>(&scene), nullptr);
    run(scene.find_poses, body.tree);
    return 1;
}

// Arguments: body, linear velocity, angular velocity, connection.
CAROM_QUICK(set_base_velocity) {
    const Body& body = *call->body;
    const Scene& scene = *call->client->scene;
    if (!is_given(in[1]) && !is_given(in[4]))
        return 0;
    const Lock lock(*call->client);
    if (!lock.is_held || !scene.find_poses.call.function)
        return 0;
    if (is_given(in[1]))
        put(body.velocity + 3, vector_at(in + 1));
    if (is_given(in[4]))
        put(body.velocity, vector_at(in + 4));
    note_reset(scene, body.tree, false);
    // As in PyBullet, getLinkState returns current poses after this call.
    run(scene.find_poses, body.tree);
    return 1;
}

namespace {

// Updates the requested data of links; false if data for this are missing.
bool prepare_links(const Call& call, bool with_velocity, bool with_poses) {
    const Body& body = *call.body;
    const Scene& scene = *call.client->scene;
    if (!body.links || (with_velocity && !scene.find_twists.call.function) ||
        (with_poses && !scene.find_poses.call.function))
        return false;
    if (with_poses)
        run(scene.find_poses, body.tree);
    if (with_velocity)
        run(scene.find_twists, body.tree);
    return true;
}

// A tuple of tuples: positions (3 numbers) and orientations (4) in turn, three times; then velocities (3 numbers each).
PyObject* tuple_of_poses(const double* numbers, int count) {
    Row row(count);
    for (int i = 0; row.tuple && i < count; ++i) {
        const int length = i % 2 && i < 6 ? 4 : 3;
        row.add(tuple_of(numbers, length));
        numbers += length;
    }
    return row.tuple;
}

// Writes the state of a link as groups of numbers; returns the number of groups.
int put_link_state(double* out, const Body& body, int64_t index, bool with_velocity) {
    const Link& link = body.links[index];
    const Pose pose = pose_of(body, index);
    out = put(put(out, pose.position), pose.orientation);
    for (int i = 0; i < POSE_NUMBERS; ++i)
        *out++ = link.inertial_frame[i];
    out = put(out, pose.position + turned(pose.orientation, vector_at(link.from_inertial_frame)));
    const Quaternion turn = quaternion_at(link.from_inertial_frame + 3);
    out = put(out, link.is_turned ? canonical(pose.orientation * turn) : pose.orientation);
    if (!with_velocity)
        return 6;
    const double* twist = body.twist + (index + 1) * SPATIAL_NUMBERS;
    put(put(out, vector_at(twist)), vector_at(twist + 3));
    return 8;
}

}  // namespace

// Arguments: body, link, whether to compute velocities, whether to compute poses, connection.
CAROM_QUICK(link_state) {
    const Body& body = *call->body;
    const bool with_velocity = in[2] != 0.0;
    if (!has_joint(body, in[1]) || !prepare_links(*call, with_velocity, in[3] != 0.0))
        return 0;
    return put_link_state(out, body, static_cast<int64_t>(in[1]), with_velocity);
}

// Arguments: body, whether to compute velocities, whether to compute poses, connection; a sequence of links.
extern "C" CAROM_EXPORT PyObject* carom_link_states(const double* in, const Call* call) {
    const Body& body = *call->body;
    const bool with_velocity = in[1] != 0.0;
    double numbers[MAX_LINKS][LINK_NUMBERS];
    int64_t links[MAX_LINKS];
    const intptr_t count = read_indices(call->sequences[0], body.link_count, MAX_LINKS, links);
    if (count < 0 || !prepare_links(*call, with_velocity, in[2] != 0.0))
        return nullptr;
    int groups = 0;
    for (intptr_t i = 0; i < count; ++i)
        groups = put_link_state(numbers[i], body, links[i], with_velocity);
    // From here on the body may be gone: making a tuple can start garbage collection, which may run any code.
    Row states(static_cast<int>(count));
    for (intptr_t i = 0; states.tuple && i < count; ++i)
        states.add(tuple_of_poses(numbers[i], groups));
    return states.tuple;
}
