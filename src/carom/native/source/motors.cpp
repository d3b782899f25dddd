// Commands to the motors of joints: kernels of quick calls.

#include "export.h"
#include "quick_calls.h"

namespace {

using namespace motor_commands;

// Most joints in one call, and entries in the longest list for one of them, a quaternion.
enum { MAX_JOINTS = 64, ENTRIES = TARGET_ENTRIES };

// What a joint is told. Lists end before the first NaN; one of the wrong length counts as not given.
struct Targets {
    double position[ENTRIES], velocity[ENTRIES], force[ENTRIES], kp[ENTRIES], kd[ENTRIES], damping[ENTRIES];
    double clamp;
};
static_assert(sizeof(Targets) == (TARGET_LISTS * ENTRIES + 1) * sizeof(double), "as Python packs it");

double* list_of(Targets& targets, int number) { return reinterpret_cast<double*>(&targets) + number * ENTRIES; }

bool is_mode(double mode) { return mode == VELOCITY || mode == TORQUE || mode == POSITION || mode == PD; }

double clipped(double position, const Joint& joint) {
    return position < joint.lower ? joint.lower : position > joint.upper ? joint.upper : position;
}

void write_target(double* row, double position, double velocity, double kp, double kd, double bound) {
    const double numbers[] = {position, velocity, kp, kd, bound};
    __builtin_memcpy(row, numbers, sizeof numbers);
}

double* motor_row(const Body& body, const Joint& joint) { return body.motor + joint.velocity * MOTOR_NUMBERS; }

void limit_speed(double* motor, double clamp) {
    if (clamp > 0.0)
        motor[codes::MOTOR_VELOCITY_CLAMP] = clamp;
}

// Turns a spherical joint towards a quaternion; other numbers are one for each axis.
void aim(const Body& body, const Joint& joint, const Targets& to, double seconds) {
    double* motor = motor_row(body, joint);
    motor[codes::MOTOR_TARGET_W] = to.position[3];
    for (int axis = 0; axis < 3; ++axis, motor += MOTOR_NUMBERS) {
        write_target(motor, to.position[axis], to.velocity[axis], to.kp[axis], to.kd[axis], to.force[axis] * seconds);
        motor[codes::MOTOR_DAMPING] = to.damping[axis];
        limit_speed(motor, to.clamp);
    }
}

// One number of each kind, as for `setJointMotorControl2`.
struct Command {
    double position, velocity, force, kp, kd, clamp;
};

void command(const Body& body, const Joint& joint, double mode, const Command& to, double seconds) {
    if (joint.dof_count && mode == TORQUE) {
        body.torque[joint.velocity] += to.force;
    } else if (joint.dof_count == 1 && mode == PD) {
        const double bound = to.force >= magnitudes::MIN_PD_FORCE ? to.force : 0.0;
        double* row = body.pd + joint.velocity * MOTOR_NUMBERS;
        write_target(row, clipped(to.position, joint), to.velocity, to.kp, to.kd, bound);
    } else if (joint.dof_count == 1 && mode == POSITION) {
        double* motor = motor_row(body, joint);
        write_target(motor, clipped(to.position, joint), to.velocity, to.kp, to.kd, to.force * seconds);
        limit_speed(motor, to.clamp);
    } else if (joint.dof_count == 1 && mode == VELOCITY) {
        double* motor = motor_row(body, joint);
        write_target(motor, 0.0, to.velocity, 0.0, to.kd, to.force * seconds);
        motor[codes::MOTOR_VELOCITY_CLAMP] = __builtin_inf();
    } else if (is_spherical(joint) && mode == POSITION) {
        // A single number is not an orientation; as in PyBullet, it is used as x of the quaternion.
        const double f = to.force, kp = to.kp, kd = to.kd, x = to.position == 0.0 ? 0.0 : to.position;
        aim(body, joint,
            {{x, 0.0, 0.0, x == 0.0 ? 1.0 : 0.0},
             {to.velocity, 0.0, 0.0},
             {f, f, f},
             {kp, kp, kp},
             {kd, kd, kd},
             {1.0, 1.0, 1.0},
             to.clamp},
            seconds);
    }
}

int length_of(const double* list) {
    int length = 0;
    while (length < ENTRIES && list[length] == list[length])
        ++length;
    return length;
}

// The first number of a list, if it has one or `more` of them.
double first(const double* list, int more, double otherwise) {
    const int length = length_of(list);
    return length == 1 || length == more ? list[0] : otherwise;
}

void fill(double* axes, double number) { axes[0] = axes[1] = axes[2] = number; }

void turn_towards(const Body& body, const Joint& joint, Targets to, double seconds) {
    const bool has_position = length_of(to.position) == 4, has_velocity = length_of(to.velocity) == 3;
    if (!has_position && !has_velocity)
        return;
    if (!has_position)
        fill(to.position, 0.0), to.position[3] = 1.0;
    if (!has_velocity)
        fill(to.velocity, 0.0);
    // Unless forces, kp and kd are all given for each axis, one value of each holds for all axes.
    if (length_of(to.force) != 3 || length_of(to.kp) != 3 || length_of(to.kd) != 3) {
        fill(to.force, first(to.force, 3, UNSTATED_FORCE));
        fill(to.kp, first(to.kp, 3, has_position ? UNSTATED_GAIN : 0.0));
        fill(to.kd, first(to.kd, 3, has_velocity ? UNSTATED_GAIN : 0.0));
    }
    if (length_of(to.damping) != 3)
        fill(to.damping, first(to.damping, 1, 1.0));
    aim(body, joint, to, seconds);
}

// What `setJointMotorControlMultiDof` tells a joint.
void command(const Body& body, const Joint& joint, double mode, const Targets& to, double seconds) {
    const bool has_position = length_of(to.position) == 1, has_velocity = length_of(to.velocity) == 1;
    if (mode == TORQUE) {
        for (int axis = 0; length_of(to.force) == joint.dof_count && axis < joint.dof_count; ++axis)
            body.torque[joint.velocity + axis] += to.force[axis];
    } else if (is_spherical(joint)) {
        if (mode == POSITION)
            turn_towards(body, joint, to, seconds);
    } else if (joint.dof_count == 1 && (has_position || has_velocity)) {
        const Command one = {
            has_position ? to.position[0] : 0.0,
            has_velocity ? to.velocity[0] : 0.0,
            first(to.force, 1, UNSTATED_FORCE),
            first(to.kp, 1, has_position ? UNSTATED_GAIN : 0.0),
            first(to.kd, 1, has_velocity ? UNSTATED_GAIN : 0.0),
            to.clamp,
        };
        command(body, joint, mode, one, seconds);
    } else if (joint.dof_count == 1) {
        limit_speed(motor_row(body, joint), to.clamp);
    }
}

// Reads a number, or a list of not too many; false if Python has to handle it.
bool read_list(PyObject* value, double* list) {
    if (read_number(value, list))
        return true;
    const intptr_t length = length_of_list(value);
    return 0 <= length && length <= ENTRIES && read_numbers(value, static_cast<int>(length), list);
}

bool is_turn(const double* position) {
    if (length_of(position) != ENTRIES)
        return true;
    const double x = position[0], y = position[1], z = position[2], w = position[3];
    const double squared = x * x + y * y + z * z + w * w;
    return magnitudes::MIN_SQUARE < squared && squared < magnitudes::MAX_SQUARE;
}

Targets not_given(double clamp) {
    Targets targets;
    for (int i = 0; i < TARGET_LISTS * ENTRIES; ++i)
        list_of(targets, 0)[i] = __builtin_nan("");
    targets.kp[0] = DEFAULT_POSITION_GAIN;
    targets.kd[0] = DEFAULT_VELOCITY_GAIN;
    targets.damping[0] = 1.0;
    targets.clamp = clamp;
    return targets;
}

}  // namespace

// Arguments: body, joint, mode, position, velocity, force, position gain, velocity gain, maximum velocity, connection.
extern "C" CAROM_EXPORT int carom_command_motor(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    if (!has_joint(body, in[1]) || !is_mode(in[2]))
        return 0;
    const Command to = {in[3], in[4], in[5], in[6], in[7], in[8]};
    command(body, body.joints[static_cast<int64_t>(in[1])], in[2], to, call->client->time_step);
    return 1;
}

// Arguments: body, mode, number of joints; then for each its index and a `Command`.
extern "C" CAROM_EXPORT int carom_command_each(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    const int64_t count = static_cast<int64_t>(in[2]);
    const double* each = in + 3;
    for (int64_t i = 0; i < count; ++i, each += 1 + sizeof(Command) / sizeof(double)) {
        Command to;
        __builtin_memcpy(&to, each + 1, sizeof to);
        command(body, body.joints[static_cast<int64_t>(each[0])], in[1], to, call->client->time_step);
    }
    return 1;
}

// Arguments: body, mode, connection; then sequences: joints, positions, velocities, forces, position gains, velocity
// gains.
extern "C" CAROM_EXPORT int carom_command_motors(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    int64_t joints[MAX_JOINTS];
    double lists[5][MAX_JOINTS];
    const intptr_t count = read_indices(call->sequences[0], body.link_count, MAX_JOINTS, joints);
    if (count < 1 || !is_mode(in[1]))
        return 0;
    const double defaults[] = {0.0, 0.0, DEFAULT_FORCE, DEFAULT_POSITION_GAIN, DEFAULT_VELOCITY_GAIN};
    for (int k = 0; k < 5; ++k) {
        PyObject* numbers = call->sequences[k + 1];
        if (numbers && !read_numbers(numbers, static_cast<int>(count), lists[k]))
            return 0;
        for (intptr_t i = 0; !numbers && i < count; ++i)
            lists[k][i] = defaults[k];
    }
    for (intptr_t i = 0; i < count; ++i) {
        const Command to = {lists[0][i], lists[1][i], lists[2][i], lists[3][i], lists[4][i], NO_CLAMP};
        command(body, body.joints[joints[i]], in[1], to, call->client->time_step);
    }
    return 1;
}

// Arguments: body, joint, mode; then `Targets`.
extern "C" CAROM_EXPORT int carom_command_joint(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    if (!has_joint(body, in[1]) || !is_mode(in[2]))
        return 0;
    Targets to;
    __builtin_memcpy(&to, in + 3, sizeof to);
    command(body, body.joints[static_cast<int64_t>(in[1])], in[2], to, call->client->time_step);
    return 1;
}

// Arguments: body, joint, mode, maximum velocity, connection; then numbers or lists: position, velocity, force, position
// gain, velocity gain, damping.
extern "C" CAROM_EXPORT int carom_command_joint_by_lists(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    Targets to = not_given(in[3]);
    if (!has_joint(body, in[1]) || (in[2] != TORQUE && in[2] != POSITION))
        return 0;
    for (int k = 0; k < TARGET_LISTS; ++k)
        if (PyObject* given = call->sequences[k]) {
            // A single number is none of the first three lists.
            list_of(to, k)[0] = __builtin_nan("");
            if ((k < 3 && length_of_list(given) < 0) || !read_list(given, list_of(to, k)))
                return 0;
        }
    if (length_of(to.velocity) > 3 || length_of(to.force) > 3 || length_of(to.kp) > 3 || length_of(to.kd) > 3)
        return 0;
    if (length_of(to.damping) > 3 || (in[2] == POSITION && !is_turn(to.position)))
        return 0;
    command(body, body.joints[static_cast<int64_t>(in[1])], in[2], to, call->client->time_step);
    return 1;
}

// Arguments: body, mode, connection; then sequences: joints, and for each a list of positions, of velocities and of
// forces, a position gain and a velocity gain.
extern "C" CAROM_EXPORT int carom_command_joints_by_lists(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    int64_t joints[MAX_JOINTS];
    double gains[2][MAX_JOINTS];
    Targets targets[MAX_JOINTS];
    const intptr_t count = read_indices(call->sequences[0], body.link_count, MAX_JOINTS, joints);
    if (count < 1 || (in[1] != TORQUE && in[1] != POSITION && in[1] != PD))
        return 0;
    for (int k = 0; k < 5; ++k)
        if (PyObject* given = call->sequences[k + 1])
            if (length_of_list(given) != count ||
                (k > 2 && !read_numbers(given, static_cast<int>(count), gains[k - 3])))
                return 0;
    for (intptr_t i = 0; i < count; ++i) {
        Targets& to = targets[i] = not_given(NO_CLAMP);
        for (int k = 0; k < 3; ++k)
            if (PyObject* given = call->sequences[k + 1]) {
                PyObject* entry = item_of_list(given, i);
                if (!entry || length_of_list(entry) < 0 || !read_list(entry, list_of(to, k)))
                    return 0;
            }
        if (length_of(to.velocity) > 3 || length_of(to.force) > 3 || !is_turn(to.position))
            return 0;
        if (call->sequences[4])
            to.kp[0] = gains[0][i];
        if (call->sequences[5])
            to.kd[0] = gains[1][i];
    }
    for (intptr_t i = 0; i < count; ++i)
        command(body, body.joints[joints[i]], in[1], targets[i], call->client->time_step);
    return 1;
}
