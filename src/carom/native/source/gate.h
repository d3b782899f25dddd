// The lock of a world, which one thread has from the arguments of a call to its results.
//
// All of it happens under the GIL, and no Python code runs in between, so neither a signal nor another thread can see
// the lock half taken. `carom.native.gates` has the same struct.
#pragma once

#include <stdint.h>

#include "python.h"

enum { MOST_CLIENTS = 1024 };

struct Gate {
    uint64_t owner;         // the thread that has the lock; 0 if none has
    int64_t depth;          // how many times it has taken it
    int64_t calls;          // number of calls begun so far
    int64_t waiting;        // number of threads that wait
    int64_t is_woken;       // one of them has been woken, and has not looked yet
    PyObject *wait, *wake;  // two methods of a lock of Python, on which they wait
};

enum Outcome { FAILED = -1, TAKEN_BY_OTHERS, ENTERED };

// Takes the lock if no other thread has it.
Outcome enter_at_once(Gate& gate);

// Takes the lock. `arguments` are those of `Gate.wait`, null to wait as long as it takes. If they limit the time, others
// may still have it afterwards. It has failed if a signal handler, which runs meanwhile, raised an error.
Outcome enter(Gate& gate, PyObject* arguments);

// Gives the lock back. An error that is set stays set.
void leave(Gate& gate);

// Whether another thread is in a call.
inline bool is_closed(const Gate& gate) {
    return gate.owner && gate.owner != python.PyThread_get_thread_ident();
}

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

// What a function does to a world.
enum Conduct {
    FREE,     // nothing that the lock protects, or it takes the lock itself
    READS,    // it is called again if another call of the same thread ran in the middle of it; for its first call
              // it counts as one that changes, because modules are imported then
    CHANGES,  // no signal handler, finalizer or trace function of the user runs in the middle of it
};

// How a function of the public interface is called.
struct Guard {
    int32_t conduct;
    int32_t client_place;  // of the connection's number among positional arguments; -1 if it is none of them
    int32_t is_known;      // it has returned once
};

// Calls a Python function, alone in the world that it names.
PyObject* call_alone(
    Guard& guard, PyObject* function, PyObject* const* arguments, intptr_t count, PyObject* names
);
