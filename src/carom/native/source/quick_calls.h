// Calls of Python that are over in a fraction of a microsecond: what kernels of such calls get and give.
//
// `carom.native.quick_calls` has the same structs.
#pragma once

#include <stdint.h>

#include "python.h"

struct Launch {
    void (*function)(void* bounds, void* arguments);
    void* bounds;
    void* arguments;
    int32_t* tree;  // among the arguments
};

// The kernel that lists contacts, what it is asked, and where it writes what it finds.
struct ContactReport {
    void (*function)(void* bounds, void* arguments);
    void* bounds;
    void* arguments;
    int32_t *count, *body_a, *link_a, *body_b, *link_b;
    double* time_step;
    const int32_t* there;  // contacts there are
    int64_t room;          // for so many
    const int32_t *found, *bodies_a, *bodies_b, *links_a, *links_b;
    const double *points_a, *points_b, *normals, *distances, *forces, *forces1, *forces2, *directions1, *directions2;
};

struct KernelCall {
    void (*function)(void* bounds, void* arguments);
    void* bounds;
    void* arguments;
};

// The shapes of all links, and what places them by the present coordinates, unless they are there already.
struct Placement {
    KernelCall place;  // null where nothing else is known
    KernelCall find_poses;
    const double* positions;  // of all bodies
    double* placed_at;        // what these were when shapes were placed last
    int64_t position_count;
    double* poses;            // of all links, which are put back afterwards
    double* poses_before;
    int64_t pose_count;
    const int32_t* readiness;  // less than 1 if shapes have been elsewhere since
    PyObject *shapes, *changes_name;  // whose attribute says how often shapes have changed
    int64_t changes;                  // what it was when they were placed last; -1 if they have not been
    const double *lower, *upper;      // bounds of each shape
    const int32_t *kind, *link;
    int64_t shape_count;
    const int32_t *first_shape, *link_shapes;  // by row of link: its run of shapes
    const int32_t *place_body, *place_link;    // by row of link
    int64_t has_bare_links;                    // there are links without shapes
};

// The kernel that finds nearest points, what it is asked, and where it writes what it finds.
struct PairSearch {
    KernelCall search;
    int32_t* count;
    double* max_distance;
    int32_t *first, *second;
    int64_t room;
    const int32_t *found, *pairs;
    const double* points;  // eight for each: point on the second shape, normal, distance, nothing
};

// What follows from bodies and arrays of a world; where it is not known, functions are null.
struct Scene {
    Launch find_poses;
    Launch find_twists;
    int32_t* contact_count;
    double* contact_warm_starts;  // where the solver starts, one for each contact
    int64_t contact_room;      // for so many contacts
    double* surface[6];  // by row of link: friction, restitution, softness; see `dynamics.cpp`
    PyObject* surface_names[6];
    double* damping[2];  // by row of tree
    double *mass, *inertia;  // by row of link: one number, three
    PyObject *mass_name, *inertia_name, *fixed_base_name;
    ContactReport report;
    Placement placement;
    PairSearch nearest;
};

struct Link {
    double inertial_frame[7];       // in the link frame
    double from_inertial_frame[7];  // the link frame in the inertial frame
    int64_t is_turned;              // the axes of these differ
};

// Moments of inertia that a link's shapes have at a mass: for each axis two terms, mass / divisor * factors.
struct Moments {
    struct {
        double divisor, factors[3];
    } terms[3][2];
    int64_t is_known;
};

// The box around the shapes of a link, in its inertial frame.
struct Box {
    double center[3], half[3];
    int64_t is_moved;   // with the link
    int64_t is_turned;  // likewise
};

struct Joint {
    int32_t position, velocity;  // places among those of the body; -1 for all but joints of one freedom
};

// Joints of a body that were commanded together, and the kernel that commands them.
struct MotorGroup {
    KernelCall command;
    int32_t *mode, *given;
    double* time_step;
    const int32_t* refused;  // not 0 after a command if numbers were not finite, and nothing has been done
    // A number for each joint, as `MotorCommands` has them.
    double *positions, *velocities, *forces, *kps, *kds;
    const int32_t* indices;
    int64_t count;
};

struct Body {
    double* position;  // of the base: 3, and 4 of its orientation
    double* velocity;  // angular, then linear
    double* pose;      // of links, the base's first, seven numbers for each
    double* twist;     // linear and angular velocity of each
    double* wrench;    // force and torque on each in the next step
    Link* links;       // but for the base; null where nobody has asked yet
    const Joint* joints;
    const MotorGroup* motors;  // those commanded last; null if none have been
    int64_t link_count;
    int64_t tree;
    int64_t first_link;
    PyObject* dynamics;  // a list with what the host keeps of the links, the base's first
    PyObject* handle;    // which says whether the base is held
    PyObject* derived;   // a dictionary with what follows from masses
    const Moments* moments;  // of the links, the base's first; null where nobody has changed a mass yet
    const Box* boxes;        // likewise; null where nobody has asked yet
};

struct Client {
    Scene* scene;
    Body** bodies;
    int64_t body_count;
    // Of the lock that is held while the world changes, and arguments for the former.
    PyObject *acquire, *release, *without_waiting;
    // What has the duration of a step as an attribute of a name.
    PyObject *connection, *time_step_name;
    // A dictionary with what the host keeps of the bodies, by number, and names of attributes of these.
    PyObject *world_bodies, *joint_count_name, *encoded_names_name;
};

struct Call {
    const Client* client;
    const Body* body;
    // Lists, tuples, ranges and arrays among the arguments that are of no certain length; null where left out.
    PyObject* sequences[6];
    int sequence_count;
};

// Works out a call. Numbers are the arguments in their order, those left out NaN if they have no default.
// Returns 0 if Python has to see to the call, and nothing has been done; or else how many groups of results
// there are.
typedef int (*Kernel)(const double* numbers, double* results, const Call* call);

// The same for results that are not so many numbers. Returns null where Python has to see to the call; then no error
// is set, unless memory is short. What it reads of the world it reads before it makes the first object: that lets
// Python collect garbage, which may do anything.
typedef PyObject* (*Maker)(const double* numbers, const Call* call);

PyObject* tuple_of(const double* numbers, int count);

// Reads so many numbers of a list, a tuple or an array; false if it is none of these, or has others.
bool read_numbers(PyObject* value, int count, double* numbers);

// The duration of a step [s]; false if it is not known.
bool read_time_step(const Client& client, double* seconds);

// A connection by its number; null if Python has to see to it.
const Client* find_client(double number);

// A body by its number; null if there is none, or it is not known.
const Body* find_body(const Client& client, double number);

// Reads an integer of 32 bits as Python has them; false if it is none.
bool read_integer(PyObject* value, double* number);

// Puts a value in the place of another for as long as this lives: the host keeps in mind what it asked last.
template <typename T>
struct Instead {
    Instead(T* at, T value) : at(at), before(*at) { *at = value; }
    ~Instead() { *at = before; }
    T* at;
    T before;
};

// Takes the lock of a client for as long as this lives, if nobody else has it.
struct Lock {
    explicit Lock(const Client& client);
    ~Lock();
    const Client& client;
    bool is_held;
};
