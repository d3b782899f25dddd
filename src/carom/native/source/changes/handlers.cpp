// Handlers of signals: what Python is given in place of those of the user.

#include "handlers.h"

#include "export.h"

extern "C" CAROM_EXPORT Waiting carom_waiting = {};

namespace {

// What `carom.native.handlers` has: a dictionary of the signals that have arrived, and the function that delivers them.
PyObject *arrived, *deliver;

PyObject* called(PyObject* handler, PyObject* const* arguments, intptr_t count) {
    PyObject* given = python.PyTuple_New(count);
    if (!given)
        return nullptr;
    for (intptr_t i = 0; i < count; ++i) {
        python.Py_IncRef(arguments[i]);
        python.PyTuple_SetItem(given, i, arguments[i]);
    }
    PyObject* result = python.PyObject_CallObject(handler, given);
    python.Py_DecRef(given);
    return result;
}

}  // namespace

bool call_handlers() {
    PutAside error;
    PyObject* done = python.PyObject_CallObject(deliver, nullptr);
    if (!done) {
        error.drop();
        return false;
    }
    python.Py_DecRef(done);
    return true;
}

extern "C" CAROM_EXPORT void carom_meet_handlers(PyObject* signals_arrived, PyObject* function) {
    python.Py_IncRef(signals_arrived);
    python.Py_IncRef(function);
    arrived = signals_arrived;
    deliver = function;
}

// The C code of a builtin that Python calls for a signal, with its number and the frame in which it came. `handler`, its
// `self`, is that of the user.
extern "C" CAROM_EXPORT PyObject* carom_handle_signal(PyObject* handler, PyObject* const* arguments, intptr_t count) {
    if (count != 2 || !(carom_waiting.calls || carom_waiting.in_section))
        return called(handler, arguments, count);
    if (python.PyDict_SetItem(arrived, arguments[0], arguments[1]))
        return nullptr;
    carom_waiting.arrived = 1;
    python.Py_IncRef(python.None);
    return python.None;
}
