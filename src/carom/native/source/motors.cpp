// Commands to several motors at once: a kernel of quick calls.

#include "export.h"
#include "quick_calls.h"

namespace {

enum { VELOCITY = 0, TORQUE = 1, POSITION = 2 };

bool are_those_of(const MotorGroup& group, PyObject* indices) {
    if (!indices || python.PySequence_Size(indices) != group.count)
        return false;
    for (int64_t i = 0; i < group.count; ++i) {
        PyObject* item = python.PySequence_GetItem(indices, i);
        double index = -1.0;
        const bool well = item && read_integer(item, &index) && index == group.indices[i];
        if (item)
            python.Py_DecRef(item);
        if (!well)
            return false;
    }
    return true;
}

}  // namespace

// Arguments: body, mode, connection; then sequences: joints, positions, velocities, forces, position gains, velocity
// gains. Python handles joints other than those commanded last, and uncommon modes.
extern "C" CAROM_EXPORT int carom_command_motors(const double* in, double* out, const Call* call) {
    const MotorGroup* group = call->body->motors;
    const double mode = in[1];
    if (!group || !are_those_of(*group, call->sequences[0]) || (mode != VELOCITY && mode != TORQUE && mode != POSITION))
        return 0;
    double* const places[] = {group->positions, group->velocities, group->forces, group->kps, group->kds};
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
    const Instead<int32_t> asked_mode(group->mode, static_cast<int32_t>(mode));
    const Instead<int32_t> asked_given(group->given, given);
    const Instead<double> asked_time_step(group->time_step, seconds);
    group->command.function(group->command.bounds, group->command.arguments);
    return !*group->refused;
}
