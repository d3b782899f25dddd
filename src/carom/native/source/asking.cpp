// Questions about a body to a kernel: a builtin that takes lists of numbers and returns arrays.
//
// It answers if the arguments are plain numbers and the answer is finite. In all other cases it returns None: then
// Python checks the arguments and asks again, or raises the error. No Python code runs in between, so that nothing can
// change while this code runs; it does not take the lock, and returns None while another thread has it.

#include "export.h"
#include "quick_calls.h"
#include "rows.h"

namespace {

bool read(PyObject* value, const QuestionPart& part) {
    if (value == python.None) {
        for (int64_t i = 0; i < part.count; ++i)
            part.numbers[i] = 0.0;
        return !part.is_required;
    }
    const int count = static_cast<int>(part.count);
    return value->type == python.memoryview_type ? read_buffer(value, count, part.numbers)
                                                 : read_numbers(value, count, part.numbers);
}

bool read_all(const Question& question, PyObject* const* arguments, intptr_t count) {
    if (count > question.part_count)
        return false;
    for (intptr_t i = 0; i < question.part_count; ++i)
        if (!read(i < count ? arguments[i] : python.None, question.parts[i]))
            return false;
    const double* q = question.quaternion;
    return !q || q[0] != 0.0 || q[1] != 0.0 || q[2] != 0.0 || q[3] != 0.0;
}

// What the makers make: an object if there is one maker, a tuple for several.
PyObject* made(PyObject* makers) {
    const intptr_t count = python.PyTuple_Size(makers);
    if (count == 1)
        return python.PyObject_CallObject(python.PyTuple_GetItem(makers, 0), nullptr);
    Row row(static_cast<int>(count));
    for (intptr_t i = 0; row.tuple && i < count; ++i)
        row.add(python.PyObject_CallObject(python.PyTuple_GetItem(makers, i), nullptr));
    return row.tuple;
}

}  // namespace

// The C code of a builtin whose `self` is a float: the address of a `Question`. Its arguments are the parts in order; those
// that are left out, or None, are 0.
extern "C" CAROM_EXPORT PyObject* carom_ask(PyObject* self, PyObject* const* arguments, intptr_t count) {
    Question& question = record_at<Question>(self);
    Gate& gate = *question.gate;
    bool well = !is_closed(gate);
    if (well && gate.owner) {
        // This call runs in the middle of another, which may use the same memory.
        ++gate.calls;
    }
    well = well && read_all(question, arguments, count);
    if (well) {
        // Kernels do not write entries that are always 0.
        for (int64_t i = 0; i < question.answer_count; ++i)
            question.answer[i] = 0.0;
        run(question.call);
        well = question.answer[0] == question.answer[0];
    }
    if (well)
        return made(question.makers);
    python.Py_IncRef(python.None);
    return python.None;
}
