// A change that Python has prepared, made by one call: attributes, items of dictionaries and lists, rows of tables,
// memory. No code of Python runs in the middle, so that nobody sees half of it. If memory is short, nothing is changed.
//
// The old values are kept until the end, where Python drops them: no finalizer runs in the middle.

#include "perform.h"
#include "python.h"
#include "table_rows.h"

// Those functions of Python that this file uses, in a table that `carom.native.change` fills. It is no part of the
// table `python`, which waits for the first connection.
#define CAROM_CHANGE_FUNCTIONS(F)                                     \
    F(PyObject*, PyObject_GenericGetAttr, (PyObject*, PyObject*))     \
    F(int, PyObject_GenericSetAttr, (PyObject*, PyObject*, PyObject*)) \
    F(PyObject*, PyTuple_GetItem, (PyObject*, intptr_t))              \
    F(intptr_t, PyList_Size, (PyObject*))                             \
    F(PyObject*, PyList_GetItem, (PyObject*, intptr_t))               \
    F(int, PyList_SetItem, (PyObject*, intptr_t, PyObject*))          \
    F(int, PyList_SetSlice, (PyObject*, intptr_t, intptr_t, PyObject*)) \
    F(PyObject*, PyDict_GetItemWithError, (PyObject*, PyObject*))     \
    F(int, PyDict_SetItem, (PyObject*, PyObject*, PyObject*))         \
    F(int, PyDict_DelItem, (PyObject*, PyObject*))                    \
    F(void, PyDict_Clear, (PyObject*))                                \
    F(int, PyDict_Update, (PyObject*, PyObject*))                     \
    F(PyObject*, PyErr_Occurred, ())                                  \
    F(void, PyErr_Clear, ())                                          \
    F(void, PyErr_Fetch, (PyObject**, PyObject**, PyObject**))        \
    F(void, PyErr_Restore, (PyObject*, PyObject*, PyObject*))         \
    F(void, Py_IncRef, (PyObject*))

namespace {

struct ChangeFunctions {
#define F(result, name, arguments) result(*name) arguments;
    CAROM_CHANGE_FUNCTIONS(F)
#undef F
};

// Prepared changes of objects; there is a list of tuples of each kind.
enum Kind { ATTRIBUTES, ITEMS, CONTENTS, MORE, KIND_COUNT };

struct Committer {
    const ChangeFunctions& python;
    PyObject* missing;  // stands for no value
    PyObject* before;   // a list with room for the old values

    // Keeps an old value, of which this takes the reference.
    void keep(intptr_t place, PyObject* value) {
        if (value)
            python.PyList_SetItem(before, place, value);
        else
            python.PyErr_Clear();
    }

    PyObject* old(intptr_t place) { return python.PyList_GetItem(before, place); }

    int put(PyObject* dictionary, PyObject* key, PyObject* value) {
        if (value != missing)
            return python.PyDict_SetItem(dictionary, key, value);
        if (!python.PyDict_GetItemWithError(dictionary, key))
            return python.PyErr_Occurred() ? -1 : 0;
        return python.PyDict_DelItem(dictionary, key);
    }

    int refill(PyObject* dictionary, PyObject* content) {
        python.PyDict_Clear(dictionary);
        return python.PyDict_Update(dictionary, content);
    }

    // Makes a change and keeps what was there before at a place; -1 if it failed.
    int make(Kind kind, PyObject* change, intptr_t place) {
        PyObject* target = python.PyTuple_GetItem(change, 0);
        PyObject* second = python.PyTuple_GetItem(change, 1);
        switch (kind) {
        case ATTRIBUTES:
            keep(place, python.PyObject_GenericGetAttr(target, second));
            return python.PyObject_GenericSetAttr(target, second, python.PyTuple_GetItem(change, 2));
        case ITEMS: {
            PyObject* value = python.PyDict_GetItemWithError(target, second);
            if (value)
                python.Py_IncRef(value);
            keep(place, value);
            return put(target, second, python.PyTuple_GetItem(change, 2));
        }
        case CONTENTS:
            return refill(target, second);
        default: {
            const intptr_t length = python.PyList_Size(target);
            return python.PyList_SetSlice(target, length, length, second);
        }
        }
    }

    // Takes back a change that was made. Nothing new is allocated, except for the content of a dictionary.
    void unmake(Kind kind, PyObject* change, intptr_t place) {
        PyObject* target = python.PyTuple_GetItem(change, 0);
        PyObject* second = python.PyTuple_GetItem(change, 1);
        switch (kind) {
        case ATTRIBUTES:
            python.PyObject_GenericSetAttr(target, second, old(place) == missing ? nullptr : old(place));
            break;
        case ITEMS:
            put(target, second, old(place));
            break;
        case CONTENTS:
            refill(target, python.PyTuple_GetItem(change, 2));
            break;
        default: {
            const intptr_t length = python.PyList_Size(target);
            python.PyList_SetSlice(target, length - python.PyList_Size(second), length, nullptr);
        }
        }
    }
};

}  // namespace

// Takes rows out of tables, then writes to memory, and then runs kernels on it.
extern "C" CAROM_EXPORT void carom_write(
    const RowCut* cuts,
    int64_t cut_count,
    const Block* blocks,
    int64_t block_count,
    const KernelRun* runs,
    int64_t run_count
) {
    for (int64_t i = 0; i < cut_count; ++i)
        carom_take_rows(cuts[i].table, cuts[i].first, cuts[i].count, cuts[i].used);
    carom_copy_blocks(blocks, block_count);
    for (int64_t i = 0; i < run_count; ++i) {
        const TreeCall& call = runs[i].call;
        // The host relies on the tree that it set last.
        const int32_t before = *call.tree;
        *call.tree = static_cast<int32_t>(runs[i].tree);
        run(call.call);
        *call.tree = before;
    }
}

// Names of the functions that the host writes to a table, in order.
#define F(result, name, arguments) #name " "
extern "C" CAROM_EXPORT const char carom_change_functions[] = CAROM_CHANGE_FUNCTIONS(F);
#undef F

// Makes a change, or nothing of it: then it returns -1, and an error of Python is set. `changes` are lists by `Kind`, of
// tuples (object, name, value), (dictionary, key, value), (dictionary, content, old content) and (list, more items).
// `before` is a list of as many `missing` as there are changes, in which the old values are kept. The GIL is held.
extern "C" CAROM_EXPORT int carom_commit(
    const ChangeFunctions* functions,
    PyObject* attributes,
    PyObject* items,
    PyObject* contents,
    PyObject* more,
    PyObject* missing,
    PyObject* before,
    const RowCut* cuts,
    int64_t cut_count,
    const Block* blocks,
    int64_t block_count,
    const KernelRun* runs,
    int64_t run_count
) {
    Committer committer = {*functions, missing, before};
    PyObject* changes[KIND_COUNT] = {attributes, items, contents, more};
    intptr_t place = 0;
    for (int kind = 0; kind < KIND_COUNT; ++kind) {
        const intptr_t count = functions->PyList_Size(changes[kind]);
        for (intptr_t i = 0; i < count; ++i, ++place) {
            if (!committer.make(Kind(kind), functions->PyList_GetItem(changes[kind], i), place))
                continue;
            PyObject *type, *value, *traceback;
            functions->PyErr_Fetch(&type, &value, &traceback);
            // A dictionary may have been emptied.
            if (kind == CONTENTS)
                committer.unmake(CONTENTS, functions->PyList_GetItem(changes[kind], i), place);
            for (;;) {
                while (i > 0)
                    committer.unmake(Kind(kind), functions->PyList_GetItem(changes[kind], --i), --place);
                if (!kind)
                    break;
                i = functions->PyList_Size(changes[--kind]);
            }
            functions->PyErr_Restore(type, value, traceback);
            return -1;
        }
    }
    carom_write(cuts, cut_count, blocks, block_count, runs, run_count);
    return 0;
}
