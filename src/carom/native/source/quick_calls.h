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

// What follows from bodies and arrays of a world; where it is not known, functions are null.
struct Scene {
    Launch find_poses;
    Launch find_twists;
    int32_t* contact_count;
    double* contact_impulses;  // four for each contact, the last of which is where the solver starts
    int64_t contact_room;      // for so many contacts
};

struct Link {
    double inertial_frame[7];       // in the link frame
    double from_inertial_frame[7];  // the link frame in the inertial frame
    int64_t is_turned;              // the axes of these differ
};

struct Body {
    double* position;  // of the base: 3, and 4 of its orientation
    double* velocity;  // angular, then linear
    double* pose;      // of links, the base's first, seven numbers for each
    double* twist;     // linear and angular velocity of each
    double* wrench;    // force and torque on each in the next step
    Link* links;       // but for the base; null where nobody has asked yet
    int64_t link_count;
    int64_t tree;
};

struct Client {
    Scene* scene;
    Body** bodies;
    int64_t body_count;
    // Of the lock that is held while the world changes, and arguments for the former.
    PyObject *acquire, *release, *without_waiting;
};

struct Call {
    const Client* client;
    const Body* body;
};

// Works out a call. Numbers are the arguments in their order, those left out NaN if they have no default.
// Returns 0 if Python has to see to the call, and nothing has been done; or else how many groups of results
// there are.
typedef int (*Kernel)(const double* numbers, double* results, const Call* call);

// Takes the lock of a client for as long as this lives, if nobody else has it.
struct Lock {
    explicit Lock(const Client& client);
    ~Lock();
    const Client& client;
    bool is_held;
};
