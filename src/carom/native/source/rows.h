// Tuples of Python, item by item.
#pragma once

#include "quick_calls.h"
#include "turns.h"

// Fills a tuple item by item, as long as memory lasts.
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
