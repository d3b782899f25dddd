// Steps of a world: a quick call, and a builtin.

#include "export.h"
#include "handlers.h"
#include "quick_calls.h"

namespace {

// Keeps an object alive, together with all that it owns.
struct Kept {
    explicit Kept(PyObject* object) : object(object) { python.Py_IncRef(object); }
    ~Kept() { python.Py_DecRef(object); }
    PyObject* object;
};

// Performs what a run asks for. Other threads run meanwhile, unless the step ends before they could begin.
void perform(Step& step, int64_t calls) {
    if (step.contact_count && !*step.contact_count) {
        carom_perform(step.run);
        return;
    }
    Watch watch;
    if (!step.is_long || !begin_to_watch(watch, calls)) {
        void* thread = python.PyEval_SaveThread();
        carom_perform(step.run);
        python.PyEval_RestoreThread(thread);
        return;
    }
    // The step is undone if a signal comes.
    const TemporaryValue<void*> watched(&step.run->watch, &watch);
    watch.thread = python.PyEval_SaveThread();
    carom_perform(step.run);
    python.PyEval_RestoreThread(watch.thread);
    if (watch.has_come && *step.status) {
        step.was_broken_off = 1;
        *step.status = status::WELL;
    }
}

// Performs a step, and lets the time go on by it. If it fails it is undone completely, whatever the reason. The caller is
// in so many calls that it can leave, if it was broken off for handlers of signals.
bool take(Step& step, int64_t calls) {
    Run& run = *step.run;
    step.was_broken_off = 0;
    const TemporaryValue<int32_t> repeatable(&run.repeatable, 1);
    ++carom_changes_made;
    if (step.substeps <= 1) {
        perform(step, calls);
        return !*step.status && !step.was_broken_off;
    }
    // As `carom.engine.parameters.EngineParameters.substeps_due`.
    const double time = *run.unspent_times + run.duration, substep_time = run.duration / step.substeps;
    const double count = static_cast<double>(static_cast<int64_t>(time / substep_time));
    const int32_t due = static_cast<int32_t>(count < step.substeps ? count : step.substeps);
    const double left = time - count * substep_time;
    const TemporaryValue<const int32_t*> substeps(&run.due, &due);
    const TemporaryValue<const double*> unspent(&run.unspent_after, &left);
    perform(step, calls);
    return !*step.status && !step.was_broken_off;
}

}  // namespace

// Arguments: connection. Python performs a step again if it fails: it grows arrays, or raises the error. It also performs one
// that was broken off for handlers of signals, after they have been called; these may have changed anything.
extern "C" CAROM_EXPORT PyObject* carom_step(const double* in, const Call* call) {
    const Client& client = *call->client;
    // Another thread may disconnect during the step.
    const Kept connection(client.connection);
    {
        const Lock lock(client);
        Step& step = client.scene->step;
        if (!lock.is_held || !step.run || python.PyList_Size(step.observers) || client.reports_analytics)
            return nullptr;
        if (take(step, 0))
            return python.PyTuple_New(0);
        if (!step.was_broken_off)
            return nullptr;
    }
    if (is_handler_due())
        call_handlers();
    return nullptr;
}

// Performs a step for Python, which has the lock. This is the C code of a builtin, whose `self` is a float: the address of
// a `Step`. Returns whether the step has been performed; if not, nothing has happened.
extern "C" CAROM_EXPORT PyObject* carom_take_step(PyObject* self, PyObject* const*, intptr_t) {
    Step& step = *reinterpret_cast<Step*>(static_cast<uintptr_t>(python.PyFloat_AsDouble(self)));
    const Kept kept(self);
    step.was_broken_off = 0;
    const bool taken = step.run && take(step, 1);
    if (!taken && python.PyErr_Occurred())
        return nullptr;
    PyObject* answer = taken ? python.True : python.False;
    python.Py_IncRef(answer);
    return answer;
}
