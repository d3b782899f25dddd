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

    void add(int32_t number) { add(python.PyLong_FromLong(number)); }
    void add(double number) { add(python.PyFloat_FromDouble(number)); }
    void add(Vector v) { add(::tuple_of(&v.x, 3)); }

    PyObject* tuple;
    int place = 0;
};

// A contact as the tuple that users get.
struct Contact {
    int32_t body_a, body_b, link_a, link_b;
    Vector point_a, point_b, normal, direction1, direction2;
    double distance, force, force1, force2;
};

inline PyObject* tuple_of(const Contact& contact) {
    Row row(14);
    row.add(0);
    row.add(contact.body_a);
    row.add(contact.body_b);
    row.add(contact.link_a);
    row.add(contact.link_b);
    row.add(contact.point_a);
    row.add(contact.point_b);
    row.add(contact.normal);
    row.add(contact.distance);
    row.add(contact.force);
    row.add(contact.force1);
    row.add(contact.direction1);
    row.add(contact.force2);
    row.add(contact.direction2);
    return row.tuple;
}
