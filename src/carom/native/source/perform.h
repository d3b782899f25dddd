// Steps of worlds, as programs of kernel launches. `carom.engine.interpreter` has the same structs.
#pragma once

#include <stdint.h>

#include "export.h"

struct Program {
    struct Launch {
        void (*function)(void* bounds, void* arguments);
        void* bounds;
        void* arguments;
        int32_t* world;     // among the arguments
        int32_t* substeps;  // likewise, or null
    };

    char* status;           // of the first world
    int64_t status_stride;  // bytes from one world's status to the next
    // Ends of the five parts of the list of launches.
    int64_t begin_end, detection_end, motion_end, end_end, abandon_end;
    Launch launches[1];
};

struct Run {
    const Program* program;
    const int32_t* worlds;
    const int32_t* due;  // substeps of each step; if it is 0, contacts are found and nothing moves
    int32_t* counter;    // index in `worlds` of the next chunk, shared by all threads; or null
    int32_t world_count;
    int32_t step_count;
    int32_t chunk;
    int32_t resumed;  // 1: continue after the steps that each world has already done
    int32_t first_substep;
    int32_t end_substep;
    int32_t repeatable;  // 1: a step that fails is undone completely, whatever the reason, for another attempt
};

extern "C" CAROM_EXPORT void carom_perform(const Run* run);
