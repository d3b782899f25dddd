// Performs programs of kernel launches, world after world, without Python in between.
//
// A launch is a C function with the addresses of its bounds and of its arguments. Each thread takes chunks of
// worlds from a list that all threads share, which balances their load, and takes each world through all of its
// steps while it is in the processor's caches.

#include "perform.h"

#include "lane_motion.h"

namespace {

// The parts of a program.
enum { BEGINNING, DETECTION, MOTION, END, ABANDONED };

// With `lanes`, free motion continues with the results that these handed over.
bool perform(const Program& program, int64_t from, int64_t to, int world, int substeps, const int32_t* status,
             const LaneMotion* lanes = nullptr) {
    for (int64_t i = from; i < to; ++i) {
        const bool is_continued = lanes && program.launches[i].call.function == lanes->free_motion;
        const WorldCall& launch = is_continued ? lanes->continued : program.launches[i];
        *launch.first_world = world;
        if (launch.substeps)
            *launch.substeps = substeps;
        run(launch.call);
        if (status && status[status::STATUS])
            return false;
    }
    return true;
}

int32_t* status_of(const Run& run, int world) {
    return reinterpret_cast<int32_t*>(run.program->status + world * run.program->status_stride);
}

bool take_step(const Run& run, int world, int step, const LaneMotion* lanes = nullptr) {
    const Program& program = *run.program;
    const int64_t* ends = program.part_ends;
    int32_t* status = status_of(run, world);
    const int substeps = run.due[step], rounds = substeps > 0 ? substeps : 1;
    const int64_t round_end = substeps > 0 ? ends[MOTION] : ends[DETECTION];
    bool well = run.first_substep > 0 || perform(program, 0, ends[BEGINNING], world, substeps, status);
    for (int k = run.first_substep; well && k < run.end_substep && k < rounds; ++k)
        well = perform(program, ends[BEGINNING], round_end, world, substeps, status, lanes);
    if (well && run.end_substep >= rounds)
        well = perform(program, ends[MOTION], ends[END], world, substeps, status);
    if (!well) {
        if (run.repeatable)
            status[status::STATUS] = status::OVERFLOW;
        perform(program, ends[END], ends[ABANDONED], world, substeps, nullptr);
        return false;
    }
    status[status::STEPS_DONE] = step + 1;
    return true;
}

void take_through_steps(const Run& run, int world) {
    int32_t* status = status_of(run, world);
    if (!run.resumed)
        status[status::STEPS_DONE] = 0;
    for (int step = status[status::STEPS_DONE]; step < run.step_count && take_step(run, world, step); ++step) { }
}

// Whether worlds from one of a list on follow each other, so many that they move at once, and begin their steps.
bool move_at_once(const Run& run, int from, int end) {
    if (!run.lanes || run.resumed || run.first_substep > 0 || from + LANES > end)
        return false;
    for (int lane = 1; lane < LANES; ++lane)
        if (run.worlds[from + lane] != run.worlds[from] + lane)
            return false;
    return true;
}

// Takes worlds through their steps together: for steps of a single substep, the free motion of all is computed first.
void take_through_steps_together(const Run& run, int first) {
    bool is_going[LANES];
    for (int lane = 0; lane < LANES; ++lane) {
        is_going[lane] = true;
        status_of(run, first + lane)[status::STEPS_DONE] = 0;
    }
    for (int step = 0; step < run.step_count; ++step) {
        const LaneMotion* lanes = run.due[step] == 1 && prepare_motion(*run.lanes, first) ? run.lanes : nullptr;
        for (int lane = 0; lane < LANES; ++lane) {
            if (!is_going[lane])
                continue;
            if (lanes)
                hand_over_motion(*lanes, lane);
            is_going[lane] = take_step(run, first + lane, step, lanes);
        }
    }
}

}  // namespace

void carom_perform(const Run* run) {
    int next = 0;
    for (;;) {
        const int from = run->counter ? __atomic_fetch_add(run->counter, run->chunk, __ATOMIC_RELAXED) : next;
        next = from + run->chunk;
        const int end = next < run->world_count ? next : run->world_count;
        for (int i = from; i < end; ++i)
            if (move_at_once(*run, i, end)) {
                take_through_steps_together(*run, run->worlds[i]);
                i += LANES - 1;
            } else {
                take_through_steps(*run, run->worlds[i]);
            }
        if (next >= run->world_count)
            return;
    }
}
