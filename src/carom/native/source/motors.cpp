// Commands to one motor, and to several at once: kernels of quick calls.

#include "export.h"
#include "quick_calls.h"

namespace {

using namespace motor_commands;

double clipped(double position, const Joint& joint) {
    return position < joint.lower ? joint.lower : position > joint.upper ? joint.upper : position;
}

void write_target(double* row, double position, double velocity, double kp, double kd, double bound) {
    const double numbers[] = {position, velocity, kp, kd, bound};
    __builtin_memcpy(row, numbers, sizeof numbers);
}

bool are_those_of(const MotorGroup& group, PyObject* indices) {
    if (!indices || length_of(indices) != group.count)
        return false;
    for (int64_t i = 0; i < group.count; ++i) {
        double index;
        if (!read_item(indices, i, &index) || index != group.indices[i])
            return false;
    }
    return true;
}

}  // namespace

// Arguments: body, joint, mode, position, velocity, force, position gain, velocity gain, maximum velocity, connection.
// `carom.scene.joint_motor.AxisMotor` does the same.
extern "C" CAROM_EXPORT int carom_command_motor(const double* in, double* out, const Call* call) {
    const Body& body = *call->body;
    if (!has_joint(body, in[1]))
        return 0;
    const Joint& joint = body.joints[static_cast<int64_t>(in[1])];
    const double mode = in[2], position = in[3], velocity = in[4], force = in[5], kp = in[6], kd = in[7], clamp = in[8];
    double seconds;
    if (joint.dof_count != 1 || !read_time_step(*call->client, &seconds))
        return 0;
    double* const motor = body.motor + joint.velocity * MOTOR_NUMBERS;
    if (mode == POSITION) {
        write_target(motor, clipped(position, joint), velocity, kp, kd, force * seconds);
        if (clamp > 0.0)
            motor[codes::MOTOR_VELOCITY_CLAMP] = clamp;
    } else if (mode == VELOCITY) {
        write_target(motor, 0.0, velocity, 0.0, kd, force * seconds);
        motor[codes::MOTOR_VELOCITY_CLAMP] = __builtin_inf();
    } else if (mode == TORQUE) {
        body.torque[joint.velocity] += force;
    } else if (mode == PD) {
        const double bound = force >= magnitudes::MIN_PD_FORCE ? force : 0.0;
        write_target(body.pd + joint.velocity * MOTOR_NUMBERS, clipped(position, joint), velocity, kp, kd, bound);
    } else {
        return 0;
    }
    return 1;
}

// Arguments: body, mode, connection; then sequences: joints, positions, velocities, forces, position gains, velocity
// gains. Python handles joints other than those commanded last, and uncommon modes.
extern "C" CAROM_EXPORT int carom_command_motors(const double* in, double* out, const Call* call) {
    const MotorGroup* group = call->body->motors;
    const double mode = in[1];
    if (!group || !are_those_of(*group, call->sequences[0]) || (mode != VELOCITY && mode != TORQUE && mode != POSITION))
        return 0;
    double* const places[] = {group->position, group->velocity, group->force, group->kp, group->kd};
    double seconds;
    int32_t given = 0;
    for (int i = 0; i < 5; ++i)
        if (PyObject* numbers = call->sequences[i + 1]) {
            if (!read_numbers(numbers, static_cast<int>(group->count), places[i]))
                return 0;
            given |= 1 << i;
        }
    if (!read_time_step(*call->client, &seconds))
        return 0;
    const TemporaryValue<int32_t> asked_mode(group->mode, static_cast<int32_t>(mode));
    const TemporaryValue<int32_t> asked_given(group->given, given);
    const TemporaryValue<double> asked_time_step(group->time_step, seconds);
    run(group->command);
    return !*group->refused;
}
