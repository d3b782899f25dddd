// Performs programs of kernel launches, world after world, without Python in between.
//
// A launch is a C function with the addresses of its bounds and of its arguments. Each thread takes chunks of
// worlds from a list that all threads share, which balances their load, and takes each world through all of its
// steps while it is in the processor's caches.

#include "perform.h"

#include "lane_motion.h"
#include "lane_sweeps.h"

namespace {

// The parts of a program.
enum { BEGINNING, DETECTION, MOTION, END, ABANDONED };

void perform(const WorldCall& launch, int world, int substeps) {
    *launch.first_world = world;
    if (launch.substeps)
        *launch.substeps = substeps;
    run(launch.call);
}

bool perform(const Program& program, int64_t from, int64_t to, int world, int substeps, const int32_t* status) {
    for (int64_t i = from; i < to; ++i) {
        perform(program.launches[i], world, substeps);
        if (status && status[status::STATUS])
            return false;
    }
    return true;
}

int32_t* status_of(const Run& run, int world) {
    return reinterpret_cast<int32_t*>(run.program->status + world * run.program->status_stride);
}

// Lets the time of a world go on, after its step.
void advance(const Run& run, int world, int step) {
    if (!run.times)
        return;
    run.times[world] += run.duration;
    if (run.unspent_after)
        run.unspent_times[world] = run.unspent_after[step];
}

// Ends a step, unless some of its substeps are left: returns whether it went well; if it did not, it is undone.
bool end_step(const Run& run, const Program& program, int world, int step, int substeps, bool well) {
    int32_t* status = status_of(run, world);
    if (well) {
        status[status::STEPS_DONE] = step + 1;
        if (run.end_substep >= substeps)
            advance(run, world, step);
        return true;
    }
    if (run.repeatable)
        status[status::STATUS] = status::OVERFLOW;
    perform(program, program.part_ends[END], program.part_ends[ABANDONED], world, substeps, nullptr);
    return false;
}

bool take_step(const Run& run, int world, int step) {
    const Program& program = *run.program;
    const int64_t* ends = program.part_ends;
    int32_t* status = status_of(run, world);
    const int substeps = run.due[step], rounds = substeps > 0 ? substeps : 1;
    const int64_t round_end = substeps > 0 ? ends[MOTION] : ends[DETECTION];
    bool well = run.first_substep > 0 || perform(program, 0, ends[BEGINNING], world, substeps, status);
    for (int k = run.first_substep; well && k < run.end_substep && k < rounds; ++k)
        well = perform(program, ends[BEGINNING], round_end, world, substeps, status);
    if (well && run.end_substep >= rounds)
        well = perform(program, ends[MOTION], ends[END], world, substeps, status);
    return end_step(run, program, world, step, substeps, well);
}

void take_through_steps(const Run& run, int world) {
    int32_t* status = status_of(run, world);
    if (!run.resumed)
        status[status::STEPS_DONE] = 0;
    for (int step = status[status::STEPS_DONE]; step < run.step_count && take_step(run, world, step); ++step) {
    }
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

// Takes the rest of a step of one substep, from the rows on: `solve` solves them, or keeps what they were solved to.
bool finish_step(const Run& run, const LaneWorld& lane, const WorldCall& solve, int world, int step) {
    const int32_t* status = status_of(run, world);
    perform(solve, world, 1);
    const bool well = !status[status::STATUS] &&
                      perform(lane.program, run.lanes->solving, lane.program.part_ends[END], world, 1, status);
    return end_step(run, lane.program, world, step, 1, well);
}

// After this many steps in a row with rows that could not be relaxed together, lanes share a workspace, which stays in the
// processor's caches; every so often they try it again.
constexpr int64_t PATIENCE = 16, PAUSE = 64;

// Takes a step of one substep of the worlds from `first` on that are going. Those whose rows can be relaxed together
// wait for each other, unless one of them cannot.
void take_step_together(const Run& run, int first, int step, bool (&is_going)[LANES]) {
    const LaneMotion& lanes = *run.lanes;
    const bool is_shared = *lanes.steps_apart >= PATIENCE && *lanes.steps_apart % PAUSE != 0;
    bool is_waiting[LANES], all_wait = !is_shared;
    for (int i = 0; i < LANES; ++i) {
        is_waiting[i] = false;
        if (is_going[i]) {
            const int own = is_shared ? 0 : i;
            const LaneWorld& lane = lanes.worlds[own];
            hand_over_motion(lanes, i, own);
            if (!perform(lane.program, 0, lanes.solving, first + i, 1, status_of(run, first + i)))
                is_going[i] = end_step(run, lane.program, first + i, step, 1, false);
            else if (all_wait && lane.waiting[WAITING_ROOT] >= 0)
                is_waiting[i] = true;
            else
                is_going[i] = finish_step(run, lane, lane.solve, first + i, step);
        }
        all_wait &= is_waiting[i];
    }
    const bool together = all_wait && relax_together(lanes);
    *lanes.steps_apart = together ? 0 : *lanes.steps_apart + 1;
    for (int i = 0; i < LANES; ++i) {
        const LaneWorld& lane = lanes.worlds[i];
        if (is_waiting[i])
            is_going[i] = finish_step(run, lane, together ? lane.keep : lane.solve, first + i, step);
    }
}

// Takes worlds through their steps together; steps of several substeps one world at a time.
void take_through_steps_together(const Run& run, int first) {
    bool is_going[LANES];
    for (int lane = 0; lane < LANES; ++lane) {
        is_going[lane] = true;
        status_of(run, first + lane)[status::STEPS_DONE] = 0;
    }
    for (int step = 0; step < run.step_count; ++step) {
        if (run.due[step] == 1 && prepare_motion(*run.lanes, first)) {
            take_step_together(run, first, step, is_going);
            continue;
        }
        for (int lane = 0; lane < LANES; ++lane)
            is_going[lane] = is_going[lane] && take_step(run, first + lane, step);
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
