// Performs programs of kernel launches, world after world, without Python in between.
//
// A launch is a C function with the addresses of its bounds and of its arguments. Each thread takes chunks of
// worlds from a list that all threads share, which balances their load, and takes each world through all of its
// steps while it is in the processor's caches.

#include "perform.h"

namespace {

// The parts of a program.
enum { BEGINNING, DETECTION, MOTION, END, ABANDONED };

bool perform(const Program& program, int64_t from, int64_t to, int world, int substeps, const int32_t* status) {
    for (int64_t i = from; i < to; ++i) {
        const WorldCall& launch = program.launches[i];
        *launch.first_world = world;
        if (launch.substeps)
            *launch.substeps = substeps;
        run(launch.call);
        if (status && status[status::STATUS])
            return false;
    }
    return true;
}

void take_through_steps(const Run& run, int world) {
    const Program& program = *run.program;
    const int64_t* ends = program.part_ends;
    int32_t* status = reinterpret_cast<int32_t*>(program.status + world * program.status_stride);
    if (!run.resumed)
        status[status::STEPS_DONE] = 0;
    for (int step = status[status::STEPS_DONE]; step < run.step_count; ++step) {
        const int substeps = run.due[step], rounds = substeps > 0 ? substeps : 1;
        const int64_t round_end = substeps > 0 ? ends[MOTION] : ends[DETECTION];
        bool well = run.first_substep > 0 || perform(program, 0, ends[BEGINNING], world, substeps, status);
        for (int k = run.first_substep; well && k < run.end_substep && k < rounds; ++k)
            well = perform(program, ends[BEGINNING], round_end, world, substeps, status);
        if (well && run.end_substep >= rounds)
            well = perform(program, ends[MOTION], ends[END], world, substeps, status);
        if (!well) {
            if (run.repeatable)
                status[status::STATUS] = status::OVERFLOW;
            perform(program, ends[END], ends[ABANDONED], world, substeps, nullptr);
            return;
        }
        status[status::STEPS_DONE] = step + 1;
    }
}

}  // namespace

void carom_perform(const Run* run) {
    int next = 0;
    for (;;) {
        const int from = run->counter ? __atomic_fetch_add(run->counter, run->chunk, __ATOMIC_RELAXED) : next;
        next = from + run->chunk;
        for (int i = from; i < next && i < run->world_count; ++i)
            take_through_steps(*run, run->worlds[i]);
        if (next >= run->world_count)
            return;
    }
}
