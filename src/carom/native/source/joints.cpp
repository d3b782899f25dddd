// Reading and setting the state of joints: kernels of quick calls.

#include "export.h"
#include "quick_calls.h"
#include "rows.h"

namespace {

enum { MAX_JOINTS = 64 };

struct State {
    double position, velocity, torque;
    double wrench[SPATIAL_NUMBERS];
    bool has_sensor;
};

State state_of(const Body& body, int64_t index, double seconds) {
    const Joint& joint = body.joints[index];
    State state = {};
    if (joint.dof_count) {
        state.position = body.position[joint.position];
        state.velocity = body.velocity[joint.velocity];
    }
    if (joint.dof_count == 1)
        state.torque = body.motor_impulse[joint.velocity] / seconds;
    state.has_sensor = joint.has_sensor;
    if (joint.has_sensor)
        __builtin_memcpy(state.wrench, body.reaction + (index + 1) * SPATIAL_NUMBERS, sizeof state.wrench);
    return state;
}

// Whether torques can be told from impulses, which takes the duration of a step.
bool read_duration(const Call& call, double* seconds) {
    return read_time_step(*call.client, seconds) && *seconds != 0.0;
}

}  // namespace

// Arguments: body, joint, connection.
extern "C" CAROM_EXPORT int carom_joint_state(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    double seconds;
    if (!has_joint(body, in[1]) || !read_duration(*call, &seconds))
        return 0;
    const State state = state_of(body, static_cast<int64_t>(in[1]), seconds);
    *out++ = state.position;
    *out++ = state.velocity;
    __builtin_memcpy(out, state.wrench, sizeof state.wrench);
    out[SPATIAL_NUMBERS] = state.torque;
    return 4;
}

// Arguments: body, connection; a sequence of joints.
extern "C" CAROM_EXPORT PyObject* carom_joint_states(const double* in, const Call* call) {
    const Body& body = *call->body;
    State states[MAX_JOINTS];
    int64_t joints[MAX_JOINTS];
    double seconds;
    const intptr_t count = read_indices(call->sequences[0], body.link_count, MAX_JOINTS, joints);
    if (count < 1 || !read_duration(*call, &seconds))
        return nullptr;
    for (intptr_t i = 0; i < count; ++i)
        states[i] = state_of(body, joints[i], seconds);
    // From here on the body may be gone: making a tuple can start garbage collection, which may run any code.
    const double zeros[SPATIAL_NUMBERS] = {};
    PyObject* no_wrench = tuple_of(zeros, SPATIAL_NUMBERS);
    Row all(static_cast<int>(count));
    for (intptr_t i = 0; no_wrench && i < count; ++i) {
        const State& state = states[i];
        Row row(4);
        row.add(state.position);
        row.add(state.velocity);
        if (!state.has_sensor)
            python.Py_IncRef(no_wrench);
        row.add(state.has_sensor ? tuple_of(state.wrench, SPATIAL_NUMBERS) : no_wrench);
        row.add(state.torque);
        all.add(row.tuple);
    }
    if (no_wrench)
        python.Py_DecRef(no_wrench);
    else
        all.add(static_cast<PyObject*>(nullptr));
    return all.tuple;
}

// Arguments: body, joint, position, velocity, connection.
extern "C" CAROM_EXPORT int carom_reset_joint(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    const Scene& scene = *call->client->scene;
    if (!has_joint(body, in[1]))
        return 0;
    const Joint joint = body.joints[static_cast<int64_t>(in[1])];
    const Lock lock(*call->client);
    if (!lock.is_held || !scene.find_poses.call.function || joint.dof_count != 1)
        return 0;
    note_reset(scene, body.tree, body.position[joint.position] != in[2]);
    body.position[joint.position] = in[2];
    body.velocity[joint.velocity] = in[3];
    run(scene.find_poses, body.tree);
    return 1;
}
