// Calls of Python functions that have a world for themselves, and the lock that they take.

#include "gate.h"

#include "export.h"
#include "handlers.h"

namespace {

const char CLIENT[] = "physicsClientId";

Gate* gates[MAX_CLIENTS];

// Functions of the host. From the first to the second, no code of the user runs. The third says whether an error, given
// by its type, itself and its traceback, comes from our own code and not from code of the user that interrupted it.
PyObject *begin_section, *end_section, *is_our_own;

// The number of the connection that the arguments name; -1 if they name none. A function raises its own error for it.
intptr_t client_of(const Guard& guard, PyObject* const* arguments, intptr_t count, PyObject* names) {
    PyObject* given = nullptr;
    if (guard.client_place >= 0 && guard.client_place < count)
        given = arguments[guard.client_place];
    for (intptr_t i = names ? python.PyTuple_Size(names) - 1 : -1; !given && i >= 0; --i)
        if (!python.PyUnicode_CompareWithASCIIString(python.PyTuple_GetItem(names, i), CLIENT))
            given = arguments[count + i];
    if (!given)
        return 0;
    const intptr_t number = python.PyNumber_AsSsize_t(given, nullptr);
    if (number == -1)
        python.PyErr_Clear();
    return number;
}

Gate* gate_of(intptr_t number) { return number >= 0 && number < MAX_CLIENTS ? gates[number] : nullptr; }

constexpr int MAX_TURNS = 1000;

// The thread that was woken gets a chance to be first. It needs some time to wake: without several turns, one that
// steps in a loop would enter again before, each time.
void let_others_in(const Gate& gate) {
    for (int i = 0; i < MAX_TURNS && gate.waiting && gate.is_woken; ++i)
        python.PyEval_RestoreThread(python.PyEval_SaveThread());
}

typedef PyObject* const* Arguments;

// Puts an error of our own code aside for good; false if it has to be raised.
bool forget_error() {
    PutAside error;
    PyObject* three = python.PyTuple_New(3);
    if (!three)
        return false;
    PyObject* const parts[] = {error.kind, error.error, error.traceback};
    for (int i = 0; i < 3; ++i) {
        PyObject* part = parts[i] ? parts[i] : python.None;
        python.Py_IncRef(part);
        python.PyTuple_SetItem(three, i, part);
    }
    PyObject* answer = python.PyObject_CallObject(is_our_own, three);
    python.Py_DecRef(three);
    if (!answer)
        python.PyErr_Clear();
    else
        python.Py_DecRef(answer);
    if (answer != python.True)
        return false;
    error.drop();
    return true;
}

// False with an error if a handler raised one. Ctrl-C may come before the function has done anything, so it is called
// once more then.
bool end_of_section(PyObject* outside) {
    PyObject* arguments = python.PyTuple_New(1);
    if (!arguments) {
        python.Py_DecRef(outside);
        return false;
    }
    python.PyTuple_SetItem(arguments, 0, outside);
    PyObject* ended = python.PyObject_CallObject(end_section, arguments);
    if (!ended) {
        const PutAside error;
        PyObject* repeated = python.PyObject_CallObject(end_section, arguments);
        if (repeated)
            python.Py_DecRef(repeated);
        else
            python.PyErr_Clear();
    }
    python.Py_DecRef(arguments);
    if (ended)
        python.Py_DecRef(ended);
    return ended;
}

// Gives the lock back that a call has taken; handlers that have waited are still to be called.
void leave_call(Gate& gate) {
    end_call(gate.owner);
    leave(gate);
}

// Takes the lock for a call, in which handlers wait. They do not wait while this waits for other threads.
bool enter_call(Gate& gate) {
    if (enter(gate, nullptr) != ENTERED)
        return false;
    begin_call(gate.owner);
    return true;
}

// The result of a call, after handlers that have waited for its end; null with an error if one of them raised it.
PyObject* after_handlers(PyObject* result) {
    if (!is_handler_due() || call_handlers())
        return result;
    if (result)
        python.Py_DecRef(result);
    return nullptr;
}

// What interrupted the call happens at its end, after the lock has been given back.
PyObject* change(Gate& gate, PyObject* function, Arguments arguments, intptr_t count, PyObject* names) {
    if (!enter_call(gate))
        return nullptr;
    ++gate.calls;
    PyObject* result = nullptr;
    PyObject* outside = python.PyObject_CallObject(begin_section, nullptr);
    if (outside)
        result = python.PyObject_Vectorcall(function, arguments, count, names);
    leave_call(gate);
    if (!outside)
        return after_handlers(nullptr);
    PutAside error;
    if (end_of_section(outside))
        return result;
    error.drop();
    if (result)
        python.Py_DecRef(result);
    return nullptr;
}

// Another call that runs in the middle may change the world, or use the same memory for the results of a function that
// reads. Then the result is dropped, and the function called again where nothing can interrupt it. A function that makes
// one change has done nothing if others came before it (`carom_commit`); otherwise it has been the first.
PyObject* attempt(
    const Guard& guard, Gate& gate, PyObject* function, Arguments arguments, intptr_t count, PyObject* names
) {
    if (!enter_call(gate))
        return nullptr;
    const int64_t number = ++gate.calls, made = carom_changes_made;
    PyObject* result = python.PyObject_Vectorcall(function, arguments, count, names);
    const bool holds = guard.conduct == READS ? gate.calls == number : result || carom_changes_made == made;
    bool is_final = holds;
    if (!holds) {
        if (result)
            python.Py_DecRef(result);
        else
            is_final = !forget_error();
        result = is_final ? result : nullptr;
    }
    leave_call(gate);
    return is_final ? after_handlers(result) : change(gate, function, arguments, count, names);
}

PyObject* truth(bool value) {
    PyObject* object = value ? python.True : python.False;
    python.Py_IncRef(object);
    return object;
}

}  // namespace

void PutAside::drop() {
    PyObject* const parts[] = {kind, error, traceback};
    kind = nullptr;
    for (PyObject* part : parts)
        if (part)
            python.Py_DecRef(part);
}

Outcome enter_at_once(Gate& gate) {
    if (is_closed(gate))
        return TAKEN_BY_OTHERS;
    gate.owner = python.PyThread_get_thread_ident();
    ++gate.depth;
    return ENTERED;
}

Outcome enter(Gate& gate, PyObject* arguments) {
    let_others_in(gate);
    while (enter_at_once(gate) != ENTERED) {
        ++gate.waiting;
        PyObject* taken = python.PyObject_CallObject(gate.wait, arguments);
        --gate.waiting;
        if (!taken)
            return FAILED;
        python.Py_DecRef(taken);
        if (taken != python.True)
            return TAKEN_BY_OTHERS;
        gate.is_woken = 0;
    }
    return ENTERED;
}

void leave(Gate& gate) {
    if (--gate.depth)
        return;
    gate.owner = 0;
    if (!gate.waiting || gate.is_woken)
        return;
    const PutAside error;
    gate.is_woken = 1;
    PyObject* done = python.PyObject_CallObject(gate.wake, nullptr);
    if (done)
        python.Py_DecRef(done);
    else
        python.PyErr_Clear();
}

PyObject* call_alone(Guard& guard, PyObject* function, Arguments arguments, intptr_t count, PyObject* names) {
    Gate* gate = guard.conduct == FREE ? nullptr : gate_of(client_of(guard, arguments, count, names));
    if (!gate)
        return python.PyObject_Vectorcall(function, arguments, count, names);
    if (guard.conduct == CHANGES || !guard.is_known) {
        PyObject* result = change(*gate, function, arguments, count, names);
        guard.is_known = guard.is_known || result;
        return result;
    }
    return attempt(guard, *gate, function, arguments, count, names);
}

// The table of gates by number of the connection, for the host.
extern "C" CAROM_EXPORT Gate** carom_gates() { return gates; }

extern "C" CAROM_EXPORT void carom_meet_host(PyObject* begin, PyObject* end, PyObject* is_own) {
    begin_section = begin;
    end_section = end;
    is_our_own = is_own;
}

// The methods of a lock: `acquire`, with the arguments of Python's locks, and `release`, which as `__exit__` takes any.
extern "C" CAROM_EXPORT PyObject* carom_gate_acquire(
    PyObject* self, Arguments arguments, intptr_t count, PyObject* names
) {
    Gate& gate = record_at<Gate>(self);
    const intptr_t named = names ? python.PyTuple_Size(names) : 0;
    if (!count && !named) {
        const Outcome outcome = enter(gate, nullptr);
        return outcome == FAILED ? nullptr : truth(outcome == ENTERED);
    }
    // Blocking or not, and the longest time to wait.
    PyObject* given[2] = {python.True, nullptr};
    for (intptr_t i = 0; i < count && i < 2; ++i)
        given[i] = arguments[i];
    for (intptr_t i = 0; i < named; ++i) {
        const bool is_time = !python.PyUnicode_CompareWithASCIIString(python.PyTuple_GetItem(names, i), "timeout");
        given[is_time] = arguments[count + i];
    }
    if (given[0] == python.False)
        return truth(enter_at_once(gate) == ENTERED);
    PyObject* limits = python.PyTuple_New(given[1] ? 2 : 1);
    if (!limits)
        return nullptr;
    for (int i = 0; i < (given[1] ? 2 : 1); ++i) {
        python.Py_IncRef(given[i]);
        python.PyTuple_SetItem(limits, i, given[i]);
    }
    const Outcome outcome = enter(gate, limits);
    python.Py_DecRef(limits);
    return outcome == FAILED ? nullptr : truth(outcome == ENTERED);
}

extern "C" CAROM_EXPORT PyObject* carom_gate_release(PyObject* self, Arguments, intptr_t, PyObject*) {
    leave(record_at<Gate>(self));
    python.Py_IncRef(python.None);
    return python.None;
}

// The methods of what calls take, `carom.native.gates.CallLock`: `__enter__`, and `__exit__`, which takes any arguments.
extern "C" CAROM_EXPORT PyObject* carom_gate_enter_call(PyObject* self, Arguments, intptr_t, PyObject*) {
    return enter_call(record_at<Gate>(self)) ? truth(true) : nullptr;
}

extern "C" CAROM_EXPORT PyObject* carom_gate_leave_call(PyObject* self, Arguments, intptr_t, PyObject*) {
    leave_call(record_at<Gate>(self));
    python.Py_IncRef(python.None);
    return after_handlers(python.None);
}
