// The state of a body that a setter of the modern API changes. Python has worked the numbers out. Here they are read, which
// may still run code of Python; then their places are looked up and written to without any, because the rows of a body
// may be others after each line of Python.

#include "export.h"
#include "quick_calls.h"

namespace {

// Names of attributes that classes of Python have as plain ones, so that reading them runs no code of Python.
enum Name { LOCK, BODIES, QUICK, PLACE, ROWS, TREE, FIRST_POSITION, FIRST_VELOCITY, POSITION_INDEX, VELOCITY_INDEX };
const char* const NAMES[] = {
    "lock", "bodies",         "quick",          "place",          "rows",
    "tree", "first_position", "first_velocity", "position_index", "velocity_index",
};
PyObject* names[sizeof NAMES / sizeof *NAMES];

void know_names() {
    for (int i = sizeof NAMES / sizeof *NAMES; i-- && !names[i];)
        names[i] = python.PyUnicode_InternFromString(NAMES[i]);
}

// An object of Python, for as long as this is there; null after an error.
struct Held {
    explicit Held(PyObject* object) : object(object) {}
    Held(const Held&) = delete;
    ~Held() {
        if (object)
            python.Py_DecRef(object);
    }
    // An attribute of it.
    Held operator[](Name name) const { return of(object, name); }
    static Held of(PyObject* owner, Name name) {
        return Held(owner ? python.PyObject_GetAttr(owner, names[name]) : nullptr);
    }
    // -1 after an error.
    int64_t number() const { return object ? python.PyLong_AsLongLong(object) : -1; }
    PyObject* const object;
};

// The numbers of a list or tuple that nobody else has, at most those of a pose; none for None.
struct Numbers {
    double numbers[POSE_NUMBERS];
    intptr_t count = 0;

    // False after an error.
    bool read(PyObject* given) {
        count = given == python.None ? 0 : length_of_list(given);
        for (intptr_t i = 0; i < count; ++i) {
            numbers[i] = python.PyFloat_AsDouble(item_of_list(given, i));
            if (numbers[i] == -1.0 && python.PyErr_Occurred())
                return false;
        }
        return true;
    }

    void write(double* memory, int64_t first) const {
        for (intptr_t i = 0; i < count; ++i)
            memory[first + i] = numbers[i];
    }
};

// A joint of a body, or no joint, but its base.
struct Part {
    PyObject* body;
    bool is_base;
    intptr_t joint;

    // The first row of numbers, 0 if there are none; -1 after an error.
    int64_t first_row(const Numbers& numbers, Name of_base, Name of_joints) const {
        if (!numbers.count)
            return 0;
        const Held found = Held::of(body, is_base ? of_base : of_joints);
        if (is_base || !found.object)
            return found.number();
        return Held(python.PySequence_GetItem(found.object, joint)).number();
    }
};

// False if Python has to do it, or after an error; then nothing has been done.
bool write(PyObject* world, PyObject* id, const Part& part, const Numbers& position, const Numbers& velocity) {
    const Held bodies = Held::of(world, BODIES);
    if (!bodies.object || python.PyDict_GetItemWithError(bodies.object, id) != part.body)
        return false;
    const Held place = Held::of(world, QUICK)[PLACE];
    const bool moves_links = position.count || !part.is_base;
    const int64_t tree = moves_links ? Held::of(part.body, ROWS)[TREE].number() : 0;
    const int64_t first = part.first_row(position, FIRST_POSITION, POSITION_INDEX);
    const int64_t first_rate = part.first_row(velocity, FIRST_VELOCITY, VELOCITY_INDEX);
    Scene* scene = place.object ? &record_at<Scene>(place.object) : nullptr;
    if (!scene || !scene->find_poses.call.function || tree < 0 || first < 0 || first_rate < 0)
        return false;
    ++carom_changes_made;
    position.write(scene->position, first);
    velocity.write(scene->velocity, first_rate);
    if (part.is_base && position.count)
        carom_start_cold(scene, nullptr);
    if (moves_links)
        run(scene->find_poses, tree);
    return true;
}

}  // namespace

// Writes coordinates and velocities of a body: of a joint, or with None of its base. This is the C code of a builtin;
// `self` is a function of Python that does the same, where something is missing here. The arguments are the body, its world
// and its number there, the joint, and numbers that fit, or None, twice.
extern "C" CAROM_EXPORT PyObject* carom_write_state(PyObject* in_python, PyObject* const* arguments, intptr_t count) {
    know_names();
    Part part = {arguments[0], arguments[3] == python.None, 0};
    Numbers position, velocity;
    if (!part.is_base)
        part.joint = python.PyNumber_AsSsize_t(arguments[3], nullptr);
    if ((part.joint == -1 && python.PyErr_Occurred()) || !position.read(arguments[4]) || !velocity.read(arguments[5]))
        return nullptr;
    const Held lock = Held::of(arguments[1], LOCK);
    if (!lock.object)
        return nullptr;
    {
        const Inside inside(record_at<Gate>(lock.object));
        if (inside.outcome != ENTERED)
            return nullptr;
        if (write(arguments[1], arguments[2], part, position, velocity)) {
            python.Py_IncRef(python.None);
            return python.None;
        }
    }
    const Held given(python.PyErr_Occurred() ? nullptr : python.PyTuple_New(count));
    for (intptr_t i = 0; given.object && i < count; ++i) {
        python.Py_IncRef(arguments[i]);
        python.PyTuple_SetItem(given.object, i, arguments[i]);
    }
    return given.object ? python.PyObject_CallObject(in_python, given.object) : nullptr;
}
