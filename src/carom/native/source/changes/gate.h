// The lock of a world, which one thread has from the arguments of a call to its results.
//
// All of it happens under the GIL, and no Python code runs in between, so neither a signal nor another thread can see
// the lock half taken.
#pragma once

#include "export.h"
#include "layouts.h"

// How many changes have been made so far, and steps of worlds; see `change.cpp`.
extern "C" CAROM_EXPORT int64_t carom_changes_made;

enum Outcome { FAILED = -1, TAKEN_BY_OTHERS, ENTERED };

// Takes the lock if no other thread has it.
Outcome enter_at_once(Gate& gate);

// Takes the lock. `arguments` are those of `Gate.wait`, null to wait as long as it takes. If they limit the time, others
// may still have it afterwards. It has failed if a signal handler, which runs meanwhile, raised an error.
Outcome enter(Gate& gate, PyObject* arguments);

// Gives the lock back. An error that is set stays set.
void leave(Gate& gate);

// Has the lock until it is destroyed, unless it could not be taken.
struct Inside {
    explicit Inside(Gate& gate) : gate(gate), outcome(enter(gate, nullptr)) {}
    ~Inside() {
        if (outcome == ENTERED)
            leave(gate);
    }
    Gate& gate;
    const Outcome outcome;
};

// The record at an address that is a float of Python, as a lock is: the address of its gate.
template <typename Record>
Record& record_at(PyObject* address) {
    return *reinterpret_cast<Record*>(static_cast<uintptr_t>(python.PyFloat_AsDouble(address)));
}

// Whether another thread is in a call.
inline bool is_closed(const Gate& gate) { return gate.owner && gate.owner != python.PyThread_get_thread_ident(); }

// An error of Python, put aside while others may occur.
struct PutAside {
    PutAside() { python.PyErr_Fetch(&kind, &error, &traceback); }
    ~PutAside() {
        if (kind)
            python.PyErr_Restore(kind, error, traceback);
    }
    // Forgets the error.
    void drop();
    PyObject *kind = nullptr, *error = nullptr, *traceback = nullptr;
};

// Calls a Python function, alone in the world that it names.
PyObject* call_alone(Guard& guard, PyObject* function, PyObject* const* arguments, intptr_t count, PyObject* names);
