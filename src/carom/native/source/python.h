// The functions and objects of CPython that this library uses: a table that `carom.native.quick_calls` fills.
//
// The library is not linked against Python, because then it would fit only one version, and would not load without
// Python. All functions belong to the stable ABI of 3.10 to 3.14, except buffers in 3.10, which have the same layout.
#pragma once

#include <stdint.h>

struct PyTypeObject;

struct PyObject {
    intptr_t references;
    PyTypeObject* type;
};

struct PyBuffer {
    void* memory;
    PyObject* owner;
    intptr_t bytes, item_size;
    int is_read_only, axes;
    char* format;
    intptr_t *shape, *strides, *suboffsets;
    void* internal;
};

// What a thread does, with a pointer.
typedef void (*Work)(void*);

// Result, name and arguments of each function.
#define CAROM_PYTHON_FUNCTIONS(F)                                       \
    F(PyObject*, PyTuple_New, (intptr_t))                               \
    F(intptr_t, PyTuple_Size, (PyObject*))                              \
    F(PyObject*, PyTuple_GetItem, (PyObject*, intptr_t))                \
    F(int, PyTuple_SetItem, (PyObject*, intptr_t, PyObject*))           \
    F(intptr_t, PyList_Size, (PyObject*))                               \
    F(PyObject*, PyList_GetItem, (PyObject*, intptr_t))                 \
    F(int, PyList_SetItem, (PyObject*, intptr_t, PyObject*))            \
    F(int, PyList_SetSlice, (PyObject*, intptr_t, intptr_t, PyObject*)) \
    F(intptr_t, PyDict_Size, (PyObject*))                               \
    F(PyObject*, PyDict_GetItemWithError, (PyObject*, PyObject*))       \
    F(int, PyDict_Next, (PyObject*, intptr_t*, PyObject**, PyObject**)) \
    F(int, PyDict_SetItem, (PyObject*, PyObject*, PyObject*))           \
    F(int, PyDict_DelItem, (PyObject*, PyObject*))                      \
    F(void, PyDict_Clear, (PyObject*))                                  \
    F(int, PyDict_Update, (PyObject*, PyObject*))                       \
    F(int, PyBytes_AsStringAndSize, (PyObject*, char**, intptr_t*))     \
    F(intptr_t, PySequence_Size, (PyObject*))                           \
    F(PyObject*, PySequence_GetItem, (PyObject*, intptr_t))             \
    F(PyObject*, PyObject_GetAttr, (PyObject*, PyObject*))              \
    F(int, PyObject_SetAttr, (PyObject*, PyObject*, PyObject*))         \
    F(PyObject*, PyObject_GenericGetAttr, (PyObject*, PyObject*))       \
    F(int, PyObject_GenericSetAttr, (PyObject*, PyObject*, PyObject*))  \
    F(PyObject*, PyFloat_FromDouble, (double))                          \
    F(double, PyFloat_AsDouble, (PyObject*))                            \
    F(PyObject*, PyLong_FromLong, (long))                               \
    F(double, PyLong_AsDouble, (PyObject*))                             \
    F(long long, PyLong_AsLongLong, (PyObject*))                        \
    F(intptr_t, PyNumber_AsSsize_t, (PyObject*, PyObject*))             \
    F(int, PyUnicode_CompareWithASCIIString, (PyObject*, const char*))  \
    F(PyObject*, PyUnicode_InternFromString, (const char*))             \
    F(PyObject*, PyErr_Occurred, ())                                    \
    F(void, PyErr_SetString, (PyObject*, const char*))                  \
    F(PyObject*, PyErr_NoMemory, ())                                    \
    F(void, PyErr_Clear, ())                                            \
    F(void, PyErr_Fetch, (PyObject**, PyObject**, PyObject**))          \
    F(void, PyErr_Restore, (PyObject*, PyObject*, PyObject*))           \
    F(int, PyErr_CheckSignals, ())                                      \
    F(unsigned long, PyThread_get_thread_ident, ())                     \
    F(unsigned long, PyThread_start_new_thread, (Work, void*))          \
    F(void*, PyThread_allocate_lock, ())                                \
    F(void, PyThread_free_lock, (void*))                                \
    F(int, PyThread_acquire_lock, (void*, int))                         \
    F(void, PyThread_release_lock, (void*))                             \
    F(int, PyObject_GetBuffer, (PyObject*, PyBuffer*, int))             \
    F(void, PyBuffer_Release, (PyBuffer*))                              \
    F(void*, PyMem_Malloc, (uintptr_t))                                 \
    F(void, PyMem_Free, (void*))                                        \
    F(void, Py_IncRef, (PyObject*))                                     \
    F(void, Py_DecRef, (PyObject*))                                     \
    F(PyObject*, PyObject_CallObject, (PyObject*, PyObject*))           \
    F(void*, PyEval_SaveThread, ())                                     \
    F(void, PyEval_RestoreThread, (void*))                              \
    F(PyObject*, PyObject_Vectorcall, (PyObject*, PyObject* const*, intptr_t, PyObject*))

// Singletons, and a class.
#define CAROM_PYTHON_OBJECTS(F) F(None) F(True) F(False) F(ValueError)
// Types; instances of their subclasses are not accepted.
#define CAROM_PYTHON_TYPES(F) F(float) F(int) F(tuple) F(list) F(range) F(memoryview) F(ndarray) F(float64)

struct Python {
#define F(result, name, arguments) result(*name) arguments;
    CAROM_PYTHON_FUNCTIONS(F)
#undef F
#define F(name) PyObject* name;
    CAROM_PYTHON_OBJECTS(F)
#undef F
#define F(name) PyTypeObject* name##_type;
    CAROM_PYTHON_TYPES(F)
#undef F
};

extern Python python;
