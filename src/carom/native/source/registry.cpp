// Which bodies there are, and what does not change about them: quick calls that make their results of what the host
// keeps. None of it lets Python collect garbage.

#include "export.h"
#include "quick_calls.h"

namespace {

// What the host keeps of a body, borrowed; null if there is no such body.
PyObject* handle_of(const Client& client, double body) {
    PyObject* number = python.PyLong_FromLong(static_cast<long>(body));
    PyObject* handle = number ? python.PyDict_GetItemWithError(client.world_bodies, number) : nullptr;
    if (number)
        python.Py_DecRef(number);
    if (!handle)
        python.PyErr_Clear();
    return handle;
}

// An attribute of that; null if it is None.
PyObject* attribute(const Client& client, double body, PyObject* name) {
    PyObject* handle = handle_of(client, body);
    PyObject* value = handle ? python.PyObject_GetAttr(handle, name) : nullptr;
    if (!value)
        python.PyErr_Clear();
    if (value != python.None)
        return value;
    python.Py_DecRef(value);
    return nullptr;
}

}  // namespace

// Connection: one that is known is there.
extern "C" CAROM_EXPORT PyObject* carom_is_connected(const double* in, const Call* call) {
    return python.PyLong_FromLong(1);
}

// Connection.
extern "C" CAROM_EXPORT PyObject* carom_body_count(const double* in, const Call* call) {
    return python.PyLong_FromLong(static_cast<long>(python.PyDict_Size(call->client->world_bodies)));
}

// Place among the bodies, connection.
extern "C" CAROM_EXPORT PyObject* carom_body_at(const double* in, const Call* call) {
    PyObject *bodies = call->client->world_bodies, *number, *handle;
    intptr_t at = 0;
    if (in[0] < 0.0)
        return nullptr;
    for (double place = in[0]; python.PyDict_Next(bodies, &at, &number, &handle); --place)
        if (place == 0.0) {
            python.Py_IncRef(number);
            return number;
        }
    return nullptr;
}

// Body, connection.
extern "C" CAROM_EXPORT PyObject* carom_joint_count(const double* in, const Call* call) {
    return attribute(*call->client, in[0], call->client->joint_count_name);
}

// Body, connection.
extern "C" CAROM_EXPORT PyObject* carom_body_names(const double* in, const Call* call) {
    return attribute(*call->client, in[0], call->client->encoded_names_name);
}
