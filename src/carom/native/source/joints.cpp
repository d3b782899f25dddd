// Reading and setting the state of joints: kernels of quick calls.

#include "export.h"
#include "quick_calls.h"
#include "rows.h"

namespace {

enum { MAX_JOINTS = 64 };

// The state of a joint; what it does not have is 0.
struct State {
    double position[4], velocity[3], wrench[SPATIAL_NUMBERS], torque[3];
};
enum { STATE_NUMBERS = sizeof(State) / sizeof(double) };

// PyBullet reports two of the three coordinates of a planar joint.
bool is_planar(const Joint& joint) { return joint.dof_count > 1 && !is_spherical(joint); }
int positions_of(const Joint& joint) { return is_planar(joint) ? 2 : joint.position_count; }
int velocities_of(const Joint& joint) { return is_planar(joint) ? 2 : joint.dof_count; }

State state_of(const Body& body, int64_t index, double seconds) {
    const Joint& joint = body.joints[index];
    State state = {};
    for (int i = 0; i < positions_of(joint); ++i)
        state.position[i] = body.position[joint.position + i];
    for (int i = 0; i < velocities_of(joint); ++i) {
        state.velocity[i] = body.velocity[joint.velocity + i];
        state.torque[i] = body.motor_impulse[joint.velocity + i] / seconds;
    }
    if (joint.has_sensor)
        __builtin_memcpy(state.wrench, body.reaction + (index + 1) * SPATIAL_NUMBERS, sizeof state.wrench);
    return state;
}

// The torque that `getJointState` returns.
double torque_of(const State& state, int dof_count) { return dof_count == 1 ? state.torque[0] : 0.0; }

// Several joints and their states, read before the first object is made.
struct States {
    State states[MAX_JOINTS];
    Joint joints[MAX_JOINTS];
    intptr_t count;

    bool read(const Call& call) {
        const Body& body = *call.body;
        int64_t indices[MAX_JOINTS];
        count = read_indices(call.sequences[0], body.link_count, MAX_JOINTS, indices);
        for (intptr_t i = 0; i < count; ++i) {
            joints[i] = body.joints[indices[i]];
            states[i] = state_of(body, indices[i], call.client->time_step);
        }
        return count > 0;
    }
};

PyObject* tuple_of(const State& state, const Joint& joint) {
    Row row(4);
    row.add(::tuple_of(state.position, positions_of(joint)));
    row.add(::tuple_of(state.velocity, velocities_of(joint)));
    row.add(::tuple_of(state.wrench, SPATIAL_NUMBERS));
    row.add(::tuple_of(state.torque, velocities_of(joint)));
    return row.tuple;
}

}  // namespace

// Arguments: body, joint, connection.
extern "C" CAROM_EXPORT int carom_joint_state(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    if (!has_joint(body, in[1]))
        return 0;
    const int64_t index = static_cast<int64_t>(in[1]);
    const State state = state_of(body, index, call->client->time_step);
    *out++ = state.position[0];
    *out++ = state.velocity[0];
    __builtin_memcpy(out, state.wrench, sizeof state.wrench);
    out[SPATIAL_NUMBERS] = torque_of(state, body.joints[index].dof_count);
    return 4;
}

// Arguments: body, joint. Results: positions, velocities, wrench and torques, as many as fit any joint.
extern "C" CAROM_EXPORT int carom_joint_coordinates(const double* in, double* out, const Call* call) {
    if (!has_joint(*call->body, in[1]))
        return 0;
    const State state = state_of(*call->body, static_cast<int64_t>(in[1]), call->client->time_step);
    __builtin_memcpy(out, &state, sizeof state);
    return STATE_NUMBERS;
}

// Arguments: body, joint, connection.
extern "C" CAROM_EXPORT PyObject* carom_joint_state_multi_dof(const double* in, const Call* call) {
    if (!has_joint(*call->body, in[1]))
        return nullptr;
    const Joint joint = call->body->joints[static_cast<int64_t>(in[1])];
    return tuple_of(state_of(*call->body, static_cast<int64_t>(in[1]), call->client->time_step), joint);
}

// Arguments: body, connection; a sequence of joints.
extern "C" CAROM_EXPORT PyObject* carom_joint_states(const double* in, const Call* call) {
    States read;
    if (!read.read(*call))
        return nullptr;
    // From here on the body may be gone: making a tuple can start garbage collection, which may run any code.
    const double zeros[SPATIAL_NUMBERS] = {};
    PyObject* no_wrench = tuple_of(zeros, SPATIAL_NUMBERS);
    Row all(static_cast<int>(read.count));
    for (intptr_t i = 0; no_wrench && i < read.count; ++i) {
        const State& state = read.states[i];
        Row row(4);
        row.add(state.position[0]);
        row.add(state.velocity[0]);
        if (!read.joints[i].has_sensor)
            python.Py_IncRef(no_wrench);
        row.add(read.joints[i].has_sensor ? tuple_of(state.wrench, SPATIAL_NUMBERS) : no_wrench);
        row.add(torque_of(state, read.joints[i].dof_count));
        all.add(row.tuple);
    }
    if (no_wrench)
        python.Py_DecRef(no_wrench);
    else
        all.add(static_cast<PyObject*>(nullptr));
    return all.tuple;
}

// Arguments: body, connection; a sequence of joints.
extern "C" CAROM_EXPORT PyObject* carom_joint_states_multi_dof(const double* in, const Call* call) {
    States read;
    if (!read.read(*call))
        return nullptr;
    Row all(static_cast<int>(read.count));
    for (intptr_t i = 0; all.tuple && i < read.count; ++i)
        all.add(tuple_of(read.states[i], read.joints[i]));
    return all.tuple;
}

// Arguments: body, joint, position, velocity, connection. Only joints with one degree of freedom move.
extern "C" CAROM_EXPORT int carom_reset_joint(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    const Scene& scene = *call->client->scene;
    if (!has_joint(body, in[1]))
        return 0;
    const Joint joint = body.joints[static_cast<int64_t>(in[1])];
    const Lock lock(*call->client);
    if (!lock.is_held || !scene.find_poses.call.function)
        return 0;
    note_reset(scene, body.tree, joint.dof_count == 1 && body.position[joint.position] != in[2]);
    if (joint.dof_count == 1) {
        body.position[joint.position] = in[2];
        body.velocity[joint.velocity] = in[3];
    }
    run(scene.find_poses, body.tree);
    return 1;
}
