// Steps of a world: a quick call.

#include "export.h"
#include "quick_calls.h"

namespace {

// Keeps an object alive, together with all that it owns.
struct Kept {
    explicit Kept(PyObject* object) : object(object) { python.Py_IncRef(object); }
    ~Kept() { python.Py_DecRef(object); }
    PyObject* object;
};

// Performs a step. Other threads run meanwhile, unless the step ends before they could begin.
void perform(const Step& step) {
    if (step.contact_count && !*step.contact_count) {
        carom_perform(step.run);
        return;
    }
    void* thread = python.PyEval_SaveThread();
    carom_perform(step.run);
    python.PyEval_RestoreThread(thread);
}

}  // namespace

// Arguments: connection. Python performs a step again if it fails: it grows arrays, or raises the error.
extern "C" CAROM_EXPORT PyObject* carom_step(const double* in, const Call* call) {
    const Client& client = *call->client;
    // Another thread may disconnect during the step.
    const Kept connection(client.connection);
    const Lock lock(client);
    const Step& step = client.scene->step;
    if (!lock.is_held || !step.run || python.PyList_Size(step.observers) || client.reports_analytics)
        return nullptr;
    const TemporaryValue<int32_t> repeatable(&step.run->repeatable, 1);
    perform(step);
    if (*step.status)
        return nullptr;
    *step.time += *step.duration;
    return python.PyTuple_New(0);
}
