// The bodies of a world and their constant properties: quick calls that return objects of the Python side. None of them
// can start garbage collection.

#include "export.h"
#include "quick_calls.h"

namespace {

// The Python object of a body, as a borrowed reference; null if there is no such body.
PyObject* handle_of(const Client& client, double body) {
    PyObject* number = python.PyLong_FromLong(static_cast<long>(body));
    PyObject* handle = number ? python.PyDict_GetItemWithError(client.world_bodies, number) : nullptr;
    if (number)
        python.Py_DecRef(number);
    if (!handle)
        python.PyErr_Clear();
    return handle;
}

// An attribute of the Python object of a body; null if it is None.
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

// Arguments: connection. A connection that is known exists.
extern "C" CAROM_EXPORT PyObject* carom_is_connected(const double* in, const Call* call) {
    return python.PyLong_FromLong(1);
}

// Arguments: connection.
extern "C" CAROM_EXPORT PyObject* carom_body_count(const double* in, const Call* call) {
    return python.PyLong_FromLong(static_cast<long>(python.PyDict_Size(call->client->world_bodies)));
}

// Arguments: index among the bodies, connection.
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

// Arguments: body, connection.
extern "C" CAROM_EXPORT PyObject* carom_joint_count(const double* in, const Call* call) {
    return attribute(*call->client, in[0], call->client->joint_count_name);
}

// Arguments: body, connection.
extern "C" CAROM_EXPORT PyObject* carom_body_names(const double* in, const Call* call) {
    return attribute(*call->client, in[0], call->client->encoded_names_name);
}
