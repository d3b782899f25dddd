// A change that Python has prepared, made by one call: attributes, items of dictionaries and lists, rows of tables,
// memory. No code of Python runs in the middle, so that nobody sees half of it. If memory is short, nothing is changed.
//
// New values are exchanged for the old ones, which the change keeps until Python drops it: no finalizer runs in the
// middle, and the same exchange takes a part of the change back.

#include "quick_calls.h"
#include "table_rows.h"

extern "C" CAROM_EXPORT int64_t carom_changes_made;
int64_t carom_changes_made = 0;

namespace {

// What a change consists of: a dictionary of attributes, lists, and records in byte strings.
enum Part { ATTRIBUTES, ITEMS, CONTENTS, MORE, WRITES, CUTS, BLOCKS, RUNS, BEGUN };

// Flags of buffers: any strides, or none at all; permission to write.
constexpr int STRIDED = 0x18, CONTIGUOUS = 0x38, WRITABLE = 0x01;

// Exchanges parts of a change that are Python's objects. `missing` stands for no value. Functions return false if memory
// is short, with an error of Python; then they have done nothing.
struct Exchange {
    PyObject* missing;

    bool attribute(PyObject* owner, PyObject* values, PyObject* name, PyObject* value) {
        PyObject* old = python.PyObject_GenericGetAttr(owner, name);
        if (!old) {
            python.PyErr_Clear();
            python.Py_IncRef(old = missing);
        }
        python.Py_IncRef(value);
        const bool made = !python.PyObject_GenericSetAttr(owner, name, value == missing ? nullptr : value);
        // The key is there, so that this takes no memory.
        if (made)
            python.PyDict_SetItem(values, name, old);
        python.Py_DecRef(value);
        python.Py_DecRef(old);
        return made;
    }

    // At most `count` attributes, which becomes the number of those that were exchanged.
    bool attributes(PyObject* owners, intptr_t& count) {
        intptr_t place = 0, made = 0;
        PyObject *number, *entry, *name, *value;
        while (made < count && python.PyDict_Next(owners, &place, &number, &entry)) {
            PyObject *owner = python.PyTuple_GetItem(entry, 0), *values = python.PyTuple_GetItem(entry, 1);
            for (intptr_t within = 0; made < count && python.PyDict_Next(values, &within, &name, &value); ++made) {
                if (!attribute(owner, values, name, value)) {
                    count = made;
                    return false;
                }
            }
        }
        count = made;
        return true;
    }

    // An item, at a place in a list of dictionaries, keys and values.
    bool item(PyObject* list, intptr_t place) {
        PyObject *dictionary = python.PyList_GetItem(list, place), *key = python.PyList_GetItem(list, place + 1);
        PyObject *value = python.PyList_GetItem(list, place + 2),
                 *old = python.PyDict_GetItemWithError(dictionary, key);
        if (!old && python.PyErr_Occurred())
            return false;
        const bool is_new = !old;
        if (is_new)
            old = missing;
        python.Py_IncRef(old);
        python.Py_IncRef(value);
        const bool made = value != missing ? !python.PyDict_SetItem(dictionary, key, value)
                                           : is_new || !python.PyDict_DelItem(dictionary, key);
        if (made)
            python.PyList_SetItem(list, place + 2, old);
        else
            python.Py_DecRef(old);
        python.Py_DecRef(value);
        return made;
    }

    // All items of a dictionary, at a place in a list of dictionaries, contents and copies of their present contents.
    bool content(PyObject* list, intptr_t place) {
        PyObject* dictionary = python.PyList_GetItem(list, place);
        PyObject *next = python.PyList_GetItem(list, place + 1), *now = python.PyList_GetItem(list, place + 2);
        python.PyDict_Clear(dictionary);
        if (python.PyDict_Update(dictionary, next)) {
            PyObject *type, *value, *traceback;
            python.PyErr_Fetch(&type, &value, &traceback);
            python.PyDict_Clear(dictionary);
            python.PyDict_Update(dictionary, now);
            python.PyErr_Restore(type, value, traceback);
            return false;
        }
        python.Py_IncRef(next);
        python.Py_IncRef(now);
        python.PyList_SetItem(list, place + 1, now);
        python.PyList_SetItem(list, place + 2, next);
        return true;
    }

    // Items for the end of a list, at a place in a list of such pairs.
    bool extend(PyObject* list, intptr_t place) {
        PyObject *extended = python.PyList_GetItem(list, place), *more = python.PyList_GetItem(list, place + 1);
        const intptr_t length = python.PyList_Size(extended);
        return length >= 0 && !python.PyList_SetSlice(extended, length, length, more);
    }

    void shorten(PyObject* list, intptr_t place) {
        PyObject *extended = python.PyList_GetItem(list, place), *more = python.PyList_GetItem(list, place + 1);
        const intptr_t length = python.PyList_Size(extended);
        python.PyList_SetSlice(extended, length - python.PyList_Size(more), length, nullptr);
    }

    // All of them, or none.
    bool all(PyObject* const* parts) {
        intptr_t attributes_made = INTPTR_MAX, items = 0, contents = 0, mores = 0;
        const intptr_t item_end = python.PyList_Size(parts[ITEMS]), content_end = python.PyList_Size(parts[CONTENTS]);
        const intptr_t more_end = python.PyList_Size(parts[MORE]);
        bool made = attributes(parts[ATTRIBUTES], attributes_made);
        for (; made && items < item_end; items += made ? 3 : 0)
            made = item(parts[ITEMS], items);
        for (; made && contents < content_end; contents += made ? 3 : 0)
            made = content(parts[CONTENTS], contents);
        for (; made && mores < more_end; mores += made ? 2 : 0)
            made = extend(parts[MORE], mores);
        if (made)
            return true;
        PyObject *type, *value, *traceback;
        python.PyErr_Fetch(&type, &value, &traceback);
        while ((mores -= 2) >= 0)
            shorten(parts[MORE], mores);
        while ((contents -= 3) >= 0)
            content(parts[CONTENTS], contents);
        while ((items -= 3) >= 0)
            item(parts[ITEMS], items);
        attributes(parts[ATTRIBUTES], attributes_made);
        python.PyErr_Restore(type, value, traceback);
        return false;
    }
};

// Copies contiguous memory to entries that need not be next to each other: those of the first axes of an array, each in
// one piece of `size` bytes. Returns where what is left of the memory begins.
const char* spread(const char* source, char* target, const PyBuffer& array, int axis, int axes, intptr_t size) {
    if (axis == axes) {
        __builtin_memcpy(target, source, size);
        return source + size;
    }
    for (intptr_t i = 0; i < array.shape[axis]; ++i, target += array.strides[axis])
        source = spread(source, target, array, axis + 1, axes, size);
    return source;
}

// The memory of arrays, by pairs of targets and contiguous sources.
struct Buffers {
    PyBuffer* buffers = nullptr;
    intptr_t count = 0;

    ~Buffers() {
        while (count)
            python.PyBuffer_Release(&buffers[--count]);
        python.PyMem_Free(buffers);
    }

    // False after an error: nothing is written unless each target gets exactly as many bytes as it has.
    bool get(PyObject* arrays) {
        const intptr_t wanted = python.PyList_Size(arrays);
        if (!wanted)
            return true;
        buffers = static_cast<PyBuffer*>(python.PyMem_Malloc(wanted * sizeof(PyBuffer)));
        if (!buffers) {
            python.PyErr_NoMemory();
            return false;
        }
        for (; count < wanted; ++count) {
            const int flags = count % 2 ? CONTIGUOUS : STRIDED | WRITABLE;
            if (python.PyObject_GetBuffer(python.PyList_GetItem(arrays, count), &buffers[count], flags))
                return false;
        }
        for (intptr_t i = 0; i < count; i += 2)
            if (buffers[i].bytes != buffers[i + 1].bytes) {
                python.PyErr_SetString(python.ValueError, "too few or too many numbers for what they are written to");
                return false;
            }
        return true;
    }

    void copy() const {
        for (intptr_t i = 0; i < count; i += 2) {
            const PyBuffer& target = buffers[i];
            intptr_t size = target.item_size;
            int axes = target.axes;
            for (; axes && target.strides[axes - 1] == size; --axes)
                size *= target.shape[axes - 1];
            spread(
                static_cast<const char*>(buffers[i + 1].memory), static_cast<char*>(target.memory), target, 0, axes,
                size
            );
        }
    }
};

// Calls a function with each record in a byte string.
template <typename Record, typename Function>
void each(PyObject* records, Function function) {
    char* bytes;
    intptr_t size;
    python.PyBytes_AsStringAndSize(records, &bytes, &size);
    const Record* record = reinterpret_cast<const Record*>(bytes);
    for (intptr_t left = size / intptr_t(sizeof(Record)); left; --left, ++record)
        function(*record);
}

}  // namespace

static void cut_rows(const RowCut& cut) { carom_take_rows(cut.table, cut.first, cut.count, cut.used); }

static void launch(const KernelRun& launched) { run(launched.call, launched.tree); }

// Makes a change, or nothing of it: then it returns null, and an error of Python is set. This is the C code of a builtin,
// whose `self` stands for no value; it returns that. `parts` are, by `Part`:
// - a dictionary of pairs of an object and its attributes, a dictionary;
// - lists of dictionaries, keys and values; of dictionaries, contents and copies of their present contents; of lists and
//   items for their ends; of arrays and what is written to them, each in turn;
// - byte strings of records: `RowCut`, `Block` and `KernelRun`;
// - the number of changes at which it was begun: if others have been made since, nothing is done, and this number is
//   returned. -1 if that is of no importance.
// Rows are taken out of tables before memory is written, and kernels run after that.
extern "C" CAROM_EXPORT PyObject* carom_commit(PyObject* missing, PyObject* const* parts, intptr_t) {
    Buffers writes;
    if (!writes.get(parts[WRITES]))
        return nullptr;
    const int64_t begun = python.PyLong_AsLongLong(parts[BEGUN]);
    if (begun >= 0 && begun != carom_changes_made) {
        python.Py_IncRef(parts[BEGUN]);
        return parts[BEGUN];
    }
    if (!Exchange{missing}.all(parts))
        return nullptr;
    ++carom_changes_made;
    each<RowCut>(parts[CUTS], cut_rows);
    writes.copy();
    each<Block>(parts[BLOCKS], [](const Block& block) { carom_copy_blocks(&block, 1); });
    each<KernelRun>(parts[RUNS], launch);
    python.Py_IncRef(missing);
    return missing;
}

// Where Python changes the objects and writes to memory, it does the rest by these, with records one after the other.
extern "C" CAROM_EXPORT void carom_cut_rows(const RowCut* cuts, int64_t count) {
    for (int64_t i = 0; i < count; ++i)
        cut_rows(cuts[i]);
}

extern "C" CAROM_EXPORT void carom_launch(const KernelRun* runs, int64_t count) {
    for (int64_t i = 0; i < count; ++i)
        launch(runs[i]);
}
