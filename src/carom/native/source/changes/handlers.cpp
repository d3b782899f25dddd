// The handlers of signals, asked of Python in a fraction of the time that Python takes.

#include "export.h"
#include "python.h"

constexpr int ONE_ARGUMENT = 0x08;

// Whether signals still have the handlers that they had: a tuple of their numbers, and a list of as many handlers. This is
// the C code of a builtin, whose `self` is `signal.getsignal`. False also if that is other code than expected.
extern "C" CAROM_EXPORT PyObject* carom_same_handlers(PyObject* getsignal, PyObject* const* arguments, intptr_t) {
    PyObject *numbers = arguments[0], *handlers = arguments[1];
    const intptr_t count = python.PyTuple_Size(numbers);
    bool same = python.PyCFunction_GetFlags(getsignal) == ONE_ARGUMENT && python.PyList_Size(handlers) == count;
    const PyFunction get = python.PyCFunction_GetFunction(getsignal);
    PyObject* module = python.PyCFunction_GetSelf(getsignal);
    for (intptr_t i = 0; same && i < count; ++i) {
        PyObject* handler = get(module, python.PyTuple_GetItem(numbers, i));
        same = handler == python.PyList_GetItem(handlers, i);
        if (handler)
            python.Py_DecRef(handler);
    }
    python.PyErr_Clear();
    PyObject* answer = same ? python.True : python.False;
    python.Py_IncRef(answer);
    return answer;
}
