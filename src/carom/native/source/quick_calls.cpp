// Builtins of Python that handle the usual case themselves and leave everything else to a Python function.
//
// A quick call has a kernel, which takes numbers and returns numbers, and a description of its arguments and results.
// If the arguments are plain numbers and sequences of them, the kernel is called. If they are anything else, or if the
// kernel declines, the Python function behind the builtin is called with the very same arguments, and does the work or
// raises the error. No Python code runs before that, so that nothing can change while this code runs.

#include "quick_calls.h"

#include "export.h"
#include "rows.h"

Python python;

extern "C" CAROM_EXPORT int32_t carom_quick_calls_paused;

namespace {

enum { RECORDS = 0x1C };  // PyBUF_RECORDS_RO

// What follows from the parameters of a call, found once.
struct Arrangement {
    double missing[MAX_NUMBERS];  // the numbers of a call without arguments
    int32_t number_count;
    uint32_t required;  // a bit for each parameter
    int32_t first_number[MAX_PARAMETERS], sequence[MAX_PARAMETERS];
    int32_t body, connection;  // indices of these numbers, -1 if there is no such parameter
};

QuickCall calls[MAX_CALLS];
Guard guards[MAX_CALLS];
Arrangement arrangements[MAX_CALLS];
const Client* clients[MAX_CLIENTS];

}  // namespace

bool read_number(PyObject* value, double* number) {
    if (value->type == python.float_type || value->type == python.float64_type) {
        *number = python.PyFloat_AsDouble(value);
    } else if (value->type == python.int_type) {
        *number = python.PyLong_AsDouble(value);
        if (*number == -1.0 && python.PyErr_Occurred()) {
            python.PyErr_Clear();
            return false;
        }
    } else {
        return false;
    }
    return __builtin_fabs(*number) <= magnitudes::MAX_MAGNITUDE;
}

bool read_buffer(PyObject* value, int count, double* numbers) {
    PyBuffer buffer;
    if (python.PyObject_GetBuffer(value, &buffer, RECORDS)) {
        python.PyErr_Clear();
        return false;
    }
    const char* format = buffer.format;
    const bool is_double = format && format[0] == 'd' && !format[1];
    const bool is_single = format && format[0] == 'f' && !format[1];
    bool well = buffer.axes == 1 && buffer.shape[0] == count && (is_double || is_single);
    for (int i = 0; well && i < count; ++i) {
        const char* item = static_cast<char*>(buffer.memory) + i * buffer.strides[0];
        if (is_double)
            __builtin_memcpy(&numbers[i], item, sizeof(double));
        else {
            float single;
            __builtin_memcpy(&single, item, sizeof single);
            numbers[i] = single;
        }
        well = __builtin_fabs(numbers[i]) <= magnitudes::MAX_MAGNITUDE;
    }
    python.PyBuffer_Release(&buffer);
    return well;
}

namespace {

int width_of(int kind) {
    return kind == '-' || kind == 's' || kind == 'v' ? 0 : kind == '3' ? 3 : kind == '4' || kind == 'q' ? 4 : 1;
}

bool is_sequence(int kind) { return kind == 's' || kind == 'v'; }

Arrangement arranged(const QuickCall& made) {
    Arrangement arrangement = {};
    arrangement.body = arrangement.connection = -1;
    int sequence_count = 0;
    for (int i = 0; i < made.parameter_count; ++i) {
        const Parameter& parameter = made.parameters[i];
        const int first = arrangement.number_count;
        arrangement.first_number[i] = first;
        for (int k = 0; k < width_of(parameter.kind); ++k)
            arrangement.missing[arrangement.number_count++] = parameter.missing;
        if (is_sequence(parameter.kind))
            arrangement.sequence[i] = sequence_count++;
        if (parameter.is_required)
            arrangement.required |= 1u << i;
        if (parameter.kind == 'b')
            arrangement.body = first;
        if (parameter.kind == 'c')
            arrangement.connection = first;
    }
    return arrangement;
}

// Reads an argument; false if it is not of this kind.
bool read(int kind, PyObject* value, double* numbers, PyObject** sequence) {
    switch (kind) {
    case '-':  // not used
        return true;
    case 'r':  // a number
        return read_number(value, numbers);
    case 'i':  // an integer
        return read_integer(value, numbers);
    case '3':  // three numbers
        return read_numbers(value, 3, numbers);
    case '4':
        return read_numbers(value, 4, numbers);
    case 'q': {  // a quaternion whose length is not zero
        if (!read_numbers(value, 4, numbers))
            return false;
        const double x = numbers[0], y = numbers[1], z = numbers[2], w = numbers[3];
        const double squared = x * x + y * y + z * z + w * w;
        return magnitudes::MIN_SQUARE < squared && squared < magnitudes::MAX_SQUARE;
    }
    case 'v':  // numbers, or None
        *sequence = value;
        return true;
    case 's':  // a sequence of integers
        *sequence = value;
        return value->type == python.list_type || value->type == python.tuple_type || value->type == python.range_type;
    case 'b':  // the number of a body
    case 'c':  // the number of a connection
        return read_integer(value, numbers);
    }
    return false;
}

// Finds the connection and the body that the arguments name; false if Python has to handle the call.
bool find(const Arrangement& arrangement, const double* numbers, Call* call) {
    if (arrangement.connection >= 0) {
        call->client = find_client(numbers[arrangement.connection]);
        if (!call->client)
            return false;
    }
    if (arrangement.body >= 0) {
        call->body = call->client ? find_body(*call->client, numbers[arrangement.body]) : nullptr;
        return call->body;
    }
    return true;
}

// Reads the argument for a parameter; false if Python has to handle the call. None stands for an optional one that is
// left out.
bool take(
    const QuickCall& made, const Arrangement& arrangement, int place, PyObject* value, double* numbers, Call* call
) {
    const Parameter& parameter = made.parameters[place];
    if (value == python.None && parameter.missing != parameter.missing && !parameter.is_required)
        return true;
    const int sequence = arrangement.sequence[place];
    return read(parameter.kind, value, numbers + arrangement.first_number[place], &call->sequences[sequence]);
}

// Reads all arguments of a call; false if Python has to handle the call.
bool read_all(
    const QuickCall& made,
    const Arrangement& arrangement,
    PyObject* const* arguments,
    intptr_t count,
    PyObject* names,
    double* numbers,
    Call* call
) {
    if (count > made.parameter_count)
        return false;
    __builtin_memcpy(numbers, arrangement.missing, arrangement.number_count * sizeof(double));
    uint32_t given = 0;
    for (int i = 0; i < count; ++i) {
        if (!take(made, arrangement, i, arguments[i], numbers, call))
            return false;
        given |= 1u << i;
    }
    const intptr_t named = names ? python.PyTuple_Size(names) : 0;
    for (intptr_t k = 0; k < named; ++k) {
        PyObject* name = python.PyTuple_GetItem(names, k);
        int place = static_cast<int>(count);
        while (place < made.parameter_count && made.parameters[place].name != name)
            ++place;
        // A name that is not found is misspelt, or given twice.
        if (place == made.parameter_count || !take(made, arrangement, place, arguments[count + k], numbers, call))
            return false;
        given |= 1u << place;
    }
    return !(arrangement.required & ~given);
}

PyObject* group_of(const double* numbers, int length) {
    return length ? tuple_of(numbers, length) : python.PyFloat_FromDouble(*numbers);
}

PyObject* result_of(const QuickCall& made, const double* numbers, int count) {
    if (made.groups[0] < 0) {
        python.Py_IncRef(python.None);
        return python.None;
    }
    if (made.is_flat)
        return group_of(numbers, made.groups[0]);
    Row row(count);
    for (int i = 0; row.tuple && i < count; ++i) {
        row.add(group_of(numbers, made.groups[i]));
        numbers += made.groups[i] ? made.groups[i] : 1;
    }
    return row.tuple;
}

// The result of a quick call. If it is null and no error is set, Python has to handle the call.
PyObject* quick_answer(int place, PyObject* const* arguments, intptr_t count, PyObject* names) {
    const QuickCall& made = calls[place];
    const Arrangement& arrangement = arrangements[place];
    double numbers[MAX_NUMBERS], results[MAX_RESULTS];
    Call call = {};
    if (!read_all(made, arrangement, arguments, count, names, numbers, &call) || !find(arrangement, numbers, &call))
        return nullptr;
    if (made.maker)
        return made.maker(numbers, &call);
    const int groups = made.kernel(numbers, results, &call);
    return groups ? result_of(made, results, groups) : nullptr;
}

PyObject* answer(int place, PyObject* function, PyObject* const* arguments, intptr_t count, PyObject* names) {
    if (calls[place].kernel || calls[place].maker) {
        PyObject* result = quick_answer(place, arguments, count, names);
        if (result || python.PyErr_Occurred())
            return result;
    }
    return call_alone(guards[place], function, arguments, count, names);
}

// A C function for each quick call. CPython passes the Python function, which does not identify the call; so each quick
// call needs a function of its own.
typedef PyObject* (*Entry)(PyObject*, PyObject* const*, intptr_t, PyObject*);

template <int place>
PyObject* entry(PyObject* function, PyObject* const* arguments, intptr_t count, PyObject* names) {
    return answer(place, function, arguments, count, names);
}

template <int count>
struct Entries {
    static Entry at(int place) { return place == count - 1 ? entry<count - 1> : Entries<count - 1>::at(place); }
};

template <>
struct Entries<0> {
    static Entry at(int) { return nullptr; }
};

}  // namespace

intptr_t length_of_list(PyObject* value) {
    if (value->type == python.tuple_type)
        return python.PyTuple_Size(value);
    return value->type == python.list_type ? python.PyList_Size(value) : -1;
}

PyObject* item_of_list(PyObject* value, intptr_t place) {
    const bool is_tuple = value->type == python.tuple_type;
    return is_tuple ? python.PyTuple_GetItem(value, place) : python.PyList_GetItem(value, place);
}

bool read_numbers(PyObject* value, int count, double* numbers) {
    const intptr_t length = length_of_list(value);
    if (length < 0)
        return python.ndarray_type && value->type == python.ndarray_type && read_buffer(value, count, numbers);
    if (length != count)
        return false;
    for (int i = 0; i < count; ++i)
        if (!read_number(item_of_list(value, i), &numbers[i]))
            return false;
    return true;
}

PyObject* tuple_of(const double* numbers, int count) {
    Row row(count);
    for (int i = 0; row.tuple && i < count; ++i)
        row.add(numbers[i]);
    return row.tuple;
}

const Client* find_client(double number) {
    const bool is_known = !carom_quick_calls_paused && number >= 0.0 && number < MAX_CLIENTS;
    const Client* client = is_known ? clients[static_cast<int>(number)] : nullptr;
    if (client && client->is_held)
        return nullptr;
    if (client && client->gate->owner) {
        if (is_closed(*client->gate))
            return nullptr;
        // This call runs in the middle of another.
        ++client->gate->calls;
    }
    return client;
}

const Body* find_body(const Client& client, double number) {
    return number >= 0.0 && number < client.body_count ? client.bodies[static_cast<int64_t>(number)] : nullptr;
}

bool read_integer(PyObject* value, double* number) {
    return value->type == python.int_type && read_number(value, number) && __builtin_fabs(*number) <= 0x7FFFFFFF;
}

intptr_t length_of(PyObject* sequence) {
    const intptr_t length = python.PySequence_Size(sequence);
    // A range can be longer than its type can say.
    if (length < 0)
        python.PyErr_Clear();
    return length;
}

bool read_item(PyObject* sequence, intptr_t place, double* number) {
    PyObject* item = python.PySequence_GetItem(sequence, place);
    if (!item) {
        python.PyErr_Clear();
        return false;
    }
    const bool well = read_integer(item, number);
    python.Py_DecRef(item);
    return well;
}

intptr_t read_indices(PyObject* sequence, int64_t end, intptr_t most, int64_t* indices) {
    const intptr_t count = length_of(sequence);
    if (count > most)
        return -1;
    for (intptr_t i = 0; i < count; ++i) {
        double index;
        if (!read_item(sequence, i, &index) || index < 0.0 || index >= end)
            return -1;
        indices[i] = static_cast<int64_t>(index);
    }
    return count;
}

void run(const TreeCall& call, int64_t tree) {
    // The host relies on the tree that it set last.
    const int32_t before = *call.tree;
    *call.tree = static_cast<int32_t>(tree);
    run(call.call);
    *call.tree = before;
}

// Names of the functions and objects that the host writes to the table `python`, in order.
#define F(result, name, arguments) #name " "
extern "C" CAROM_EXPORT const char carom_python_functions[] = CAROM_PYTHON_FUNCTIONS(F);
#undef F
#define F(name) #name " "
extern "C" CAROM_EXPORT const char carom_python_objects[] = CAROM_PYTHON_OBJECTS(F) CAROM_PYTHON_TYPES(F);
#undef F

// Not 0 while Python has to handle all calls that name a connection.
extern "C" CAROM_EXPORT int32_t carom_quick_calls_paused = 0;

// Gives the host the addresses of the tables of Python's functions, of quick calls, of guards and of clients. Returns 0 if another
// interpreter of the process already has them.
extern "C" CAROM_EXPORT int carom_claim_quick_calls(
    void** of_python, QuickCall** of_calls, Guard** of_guards, const Client*** of_clients
) {
    static bool is_claimed = false;
    if (is_claimed)
        return 0;
    is_claimed = true;
    *of_python = &python;
    *of_calls = calls;
    *of_guards = guards;
    *of_clients = clients;
    return 1;
}

// The C code of the builtin of a quick call, whose description is complete.
extern "C" CAROM_EXPORT Entry carom_quick_entry(int place) {
    arrangements[place] = arranged(calls[place]);
    return Entries<MAX_CALLS>::at(place);
}
