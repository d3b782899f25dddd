// Python tuples that are filled item by item.
#pragma once

#include "quick_calls.h"
#include "turns.h"

// A tuple that is filled item by item; it becomes null if memory is short.
struct Row {
    explicit Row(int length) : tuple(python.PyTuple_New(length)) {}

    void add(PyObject* item) {
        if (tuple && item) {
            python.PyTuple_SetItem(tuple, place++, item);
            return;
        }
        if (item)
            python.Py_DecRef(item);
        if (tuple)
            python.Py_DecRef(tuple);
        tuple = nullptr;
    }

    void add(long number) { add(python.PyLong_FromLong(number)); }
    void add(double number) { add(python.PyFloat_FromDouble(number)); }
    void add(Vector v) { add(::tuple_of(&v.x, 3)); }

    PyObject* tuple;
    int place = 0;
};
