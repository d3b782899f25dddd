// Quick calls, which take a fraction of a microsecond: arguments and results of their kernels.
#pragma once

#include "gate.h"
#include "perform.h"

PyObject* tuple_of(const double* numbers, int count);

// Reads a number; false if it is none.
bool read_number(PyObject* value, double* number);

// The length of a list or tuple; that of an array is not known before it is read. -1 for anything else.
intptr_t length_of_list(PyObject* value);

// An item of a list or tuple, as a borrowed reference.
PyObject* item_of_list(PyObject* value, intptr_t place);

// Reads a list, a tuple or an array of `count` numbers; false if it is none of these, or of another length.
bool read_numbers(PyObject* value, int count, double* numbers);

// Reads an object with a buffer of `count` numbers, as an array or a memoryview; false if it has none such.
bool read_buffer(PyObject* value, int count, double* numbers);

// A connection by its number; null if Python has to handle its calls, as while another thread is in one of them.
const Client* find_client(double number);

// A body by its number; null if there is none, or it has no record yet.
const Body* find_body(const Client& client, double number);

// Whether a body has a link of this index; -1 is the base.
inline bool has_link(const Body& body, double index) { return -1.0 <= index && index < body.link_count; }

// Whether a body has a joint of this index. It is also the index of a link, the one that the joint moves.
inline bool has_joint(const Body& body, double index) { return 0.0 <= index && has_link(body, index); }

inline bool is_spherical(const Joint& joint) { return joint.position_count > joint.dof_count; }

// Reads a Python integer that fits into 32 bits; false if it is none.
bool read_integer(PyObject* value, double* number);

// The length of a sequence; -1 if it is too long to be said.
intptr_t length_of(PyObject* sequence);

// Reads an integer of a sequence; false if it is none.
bool read_item(PyObject* sequence, intptr_t place, double* number);

// Reads a sequence of at most `most` integers from 0 to `end` - 1; returns their number, or -1 if it is none.
intptr_t read_indices(PyObject* sequence, int64_t end, intptr_t most, int64_t* indices);

// Notes that a body was reset, which moved it or not, for the order of contacts; see `carom.kernels.contact.resets`.
inline void note_reset(const Scene& scene, int64_t tree, bool moved) {
    int32_t& resets = scene.contact_count[contacts::RESETS];
    int32_t& number = scene.tree_resets[tree];
    const int32_t present = number < 0 ? -number : number;
    if (!moved && present > scene.contact_count[contacts::RESETS_SEEN])
        return;
    if (resets < INT32_MAX)
        ++resets;
    number = moved ? -resets : resets;
}

// Runs a kernel for one tree.
void run(const TreeCall& call, int64_t tree);

// Lets the contacts of a scene start cold in the next step, because a body was moved.
extern "C" CAROM_EXPORT void carom_start_cold(void* its_scene, void*);

// Releases an object; if it is missing because of an error, clears the error.
inline void release(PyObject* object) {
    if (object)
        python.Py_DecRef(object);
    else
        python.PyErr_Clear();
}

// Replaces a value and restores it on destruction: the host relies on the arguments that it set last.
template <typename T>
struct TemporaryValue {
    TemporaryValue(T* at, T value) : at(at), before(*at) { *at = value; }
    ~TemporaryValue() { *at = before; }
    T* at;
    T before;
};

// Takes the lock of a world if it is free, and releases it on destruction. Where there is none, Python holds its own.
struct Lock {
    explicit Lock(const Client& client) : gate(client.gate), is_held(!gate || enter_at_once(*gate) == ENTERED) {}
    ~Lock() {
        if (gate && is_held)
            leave(*gate);
    }
    Gate* gate;
    const bool is_held;
};
