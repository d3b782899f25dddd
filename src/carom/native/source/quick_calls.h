// Quick calls, which take a fraction of a microsecond: arguments and results of their kernels.
//
// `carom.native.quick_calls` has the same structs.
#pragma once

#include <stdint.h>

#include "gate.h"
#include "perform.h"
#include "python.h"

struct KernelCall {
    void (*function)(void* bounds, void* arguments);
    void* bounds;
    void* arguments;
};

struct Launch : KernelCall {
    int32_t* tree;  // among the arguments
};

// The kernel that lists contacts, its query, and the arrays of its results.
struct ContactReport : KernelCall {
    int32_t *count, *body_a, *link_a, *body_b, *link_b;
    double* time_step;
    const int32_t* there;  // number of contacts in the world
    int64_t room;          // number of contacts that fit into the results
    const int32_t *found, *bodies_a, *bodies_b, *links_a, *links_b;
    const double *points_a, *points_b, *normals, *distances, *forces, *forces1, *forces2, *directions1, *directions2;
};

// Collision detection at the current coordinates of all bodies.
struct Detection {
    Run* run;  // null if the other fields are not filled
    KernelCall find_poses;
    double *poses, *poses_before;  // of all links; they are restored afterwards
    int64_t pose_count;
    const int32_t* status;  // not 0 if nothing was done, because arrays are too short
};

// The shapes of all links, and the kernels that place them at the current coordinates.
struct Placement {
    KernelCall place;  // null if the other fields are not filled
    KernelCall find_poses;
    const double* positions;  // of all bodies
    double* placed_at;        // these positions when shapes were placed last
    int64_t position_count;
    double* poses;            // of all links; they are restored afterwards
    double* poses_before;
    int64_t pose_count;
    const int32_t* readiness;  // less than 1 if shapes have been placed elsewhere since
    PyObject *shapes, *changes_name;  // an object and its attribute that counts changes of shapes
    int64_t changes;                  // this count when shapes were placed last; -1 if they have not been
    const double *lower, *upper;      // bounds of each shape
    const int32_t *kind, *link;
    int64_t shape_count;
    const int32_t *first_shape, *link_shapes;  // by row of link: its first shape, and the number of its shapes
    const int32_t *place_body, *place_link;    // by row of link
    int64_t has_bare_links;                    // there are links without shapes
};

// The struct of this name in `carom.layouts.contacts`: shape b is the second of a pair.
struct Candidate {
    double point[3], normal[3], distance;
    int32_t on_face;
};

// The kernel that finds nearest points, its query, and the arrays of its results.
struct PairSearch {
    KernelCall search;
    int32_t* count;
    double* max_distance;
    int32_t *first, *second;
    int64_t room;
    const int32_t *found, *pairs;
    const Candidate* points;
};

// A step of the world with one substep.
struct Step {
    Run* run;             // null if Python has to perform steps
    const int32_t* status;
    const double* duration;
    double* time;         // of the world
    PyObject* observers;  // the list of objects that Python tells of steps
    const int32_t* contact_count;  // in a world of few links; null in others
};

// Data derived from the bodies and arrays of a world; functions are null if their data are missing.
struct Scene {
    Launch find_poses;
    Launch find_twists;
    int32_t* contact_count;
    double* contact_warm_starts;  // impulses at which the solver starts, one for each contact
    int64_t contact_room;      // number of contacts that fit
    int32_t* tree_resets;      // by row of tree, see `note_reset`
    double* surface[6];  // by row of link: friction, restitution, softness; see `dynamics.cpp`
    PyObject* surface_names[6];
    double* damping[2];  // by row of tree
    double *mass, *inertia;  // by row of link: one number for the mass, three for the inertia
    PyObject *mass_name, *inertia_name, *fixed_base_name;
    ContactReport report;
    Detection detection;
    Placement placement;
    PairSearch nearest;
    Step step;
};

struct Link {
    double inertial_frame[7];       // in the link frame
    double from_inertial_frame[7];  // the link frame in the inertial frame
    int64_t is_turned;              // the two frames have different axes
};

// Moments of inertia of a link's shapes as a function of the mass: for each axis two terms, mass / divisor * factors.
struct Moments {
    struct {
        double divisor, factors[3];
    } terms[3][2];
    int64_t is_known;
};

// The box around the shapes of a link, in its inertial frame.
struct Box {
    double center[3], half[3];
    int64_t is_moved;   // it moves with the link
    int64_t is_turned;  // it rotates with the link
};

struct Joint {
    int32_t position, velocity;  // indices of the first coordinates among those of the body
    int32_t dof_count;
    int32_t has_sensor;
    double lower, upper;  // bounds of target positions
};

// Joints of a body that were commanded together, and the kernel for their commands.
struct MotorGroup {
    KernelCall command;
    int32_t *mode, *given;
    double* time_step;
    const int32_t* refused;  // not 0 if the last command did nothing because numbers were not finite
    // One number for each joint, as in `MotorCommands`.
    double *positions, *velocities, *forces, *kps, *kds;
    const int32_t* indices;
    int64_t count;
};

struct Body {
    double* position;  // of the base: 3 numbers, then 4 of its orientation
    double* velocity;  // angular, then linear
    double* pose;      // of all links, the base first, seven numbers for each
    double* twist;     // linear and angular velocity of each link
    double* wrench;    // force and torque on each link in the next step
    double *motor, *pd;  // the motor and the PD drive of each dof, eight numbers for each
    double* torque;      // on each dof in the next step
    const double* motor_impulse;  // of the last step, on each dof
    const double* reaction;       // force and torque that sensors measure, for each link
    Link* links;       // all except the base; null until they are first needed
    const Joint* joints;
    const MotorGroup* motors;  // the group commanded last; null if there is none
    int64_t link_count;
    int64_t tree;
    int64_t first_link;
    PyObject* dynamics;  // a list of the `LinkDynamics` of the links, the base first
    PyObject* handle;    // the Python object of the body; an attribute of it is whether the base is fixed
    PyObject* derived;   // a dictionary of data that are derived from masses
    const Moments* moments;  // of the links, the base first; null until a mass is first changed
    const Box* boxes;        // of the links, the base first; null until they are first needed
};

struct Client {
    Scene* scene;
    Body** bodies;
    int64_t body_count;
    Gate* gate;
    // An object, and the name of its attribute with the duration of a step.
    PyObject *connection, *time_step_name;
    int64_t reports_analytics;  // 1 if steps return statistics of the solver, which Python makes
    // A dictionary with the Python objects of the bodies, by number, and names of attributes of these.
    PyObject *world_bodies, *joint_count_name, *encoded_names_name;
};

struct Call {
    const Client* client;
    const Body* body;
    // Arguments of any length (lists, tuples, ranges and arrays); null for those left out.
    PyObject* sequences[6];
};

// Performs a call. Numbers are the arguments in order; those left out are NaN if they have no default.
// Returns the number of groups of results; or 0 if Python has to handle the call, and nothing has been done.
typedef int (*Kernel)(const double* numbers, double* results, const Call* call);

// The same for results that are not a fixed number of numbers. Returns null if Python has to handle the call; then no
// error is set, unless memory is short. It reads all it needs of the world before it makes the first object, because
// making an object can start garbage collection, which may run any code.
typedef PyObject* (*Maker)(const double* numbers, const Call* call);

PyObject* tuple_of(const double* numbers, int count);

// Reads a list, a tuple or an array of `count` numbers; false if it is none of these, or of another length.
bool read_numbers(PyObject* value, int count, double* numbers);

// The duration of a step [s]; false if it is not known.
bool read_time_step(const Client& client, double* seconds);

// A connection by its number; null if Python has to handle its calls, as while another thread is in one of them.
const Client* find_client(double number);

// A body by its number; null if there is none, or it has no record yet.
const Body* find_body(const Client& client, double number);

// Whether a body has a link of this index; -1 is the base.
inline bool has_link(const Body& body, double index) { return -1.0 <= index && index < body.link_count; }

// Whether a body has a joint of this index. It is also the index of a link, the one that the joint moves.
inline bool has_joint(const Body& body, double index) { return 0.0 <= index && has_link(body, index); }

// Reads a Python integer that fits into 32 bits; false if it is none.
bool read_integer(PyObject* value, double* number);

// The length of a sequence; -1 if it is too long to be said.
intptr_t length_of(PyObject* sequence);

// Reads an integer of a sequence; false if it is none.
bool read_item(PyObject* sequence, intptr_t place, double* number);

// Reads a sequence of at most `most` integers from 0 to `end` - 1; returns their number, or -1 if it is none.
intptr_t read_indices(PyObject* sequence, int64_t end, intptr_t most, int64_t* indices);

// Notes that a body was reset, which moved it or not, for the order of contacts; see `carom.kernels.contact.resets`.
inline void note_reset(const Scene& scene, int64_t tree, bool moved) {
    // Columns of `contact_count`: the number of resets, and those before the last substep.
    enum { RESETS = 4, RESETS_SEEN = 5 };
    int32_t& resets = scene.contact_count[RESETS];
    int32_t& number = scene.tree_resets[tree];
    const int32_t present = number < 0 ? -number : number;
    if (!moved && present > scene.contact_count[RESETS_SEEN])
        return;
    if (resets < INT32_MAX)
        ++resets;
    number = moved ? -resets : resets;
}

inline void run(const KernelCall& call) { call.function(call.bounds, call.arguments); }

// Runs a kernel for one tree.
void run(const Launch& launch, int64_t tree);

// Releases an object; if it is missing because of an error, clears the error.
inline void release(PyObject* object) {
    if (object)
        python.Py_DecRef(object);
    else
        python.PyErr_Clear();
}

// Replaces a value and restores it on destruction: the host relies on the arguments that it set last.
template <typename T>
struct Instead {
    Instead(T* at, T value) : at(at), before(*at) { *at = value; }
    ~Instead() { *at = before; }
    T* at;
    T before;
};

// Takes the lock of a world if it is free, and releases it on destruction.
struct Lock {
    explicit Lock(const Client& client) : gate(*client.gate), is_held(enter_at_once(gate) == ENTERED) {}
    ~Lock() {
        if (is_held)
            leave(gate);
    }
    Gate& gate;
    const bool is_held;
};
