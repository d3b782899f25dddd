// Performs programs of kernel launches, world after world, without Python in between.
//
// A launch is a C function with the addresses of its bounds and of its arguments. Each thread has a share of a list
// of worlds, from which it takes chunks, then those that are left of other threads' shares, which balances their load.
// It takes each world through all of its steps while it is in the processor's caches.

#include "perform.h"

#include "lane_motion.h"
#include "lane_sweeps.h"
#include "team.h"

namespace {

// The parts of a program.
enum { BEGINNING, DETECTION, MOTION, END, ABANDONED };

void perform(const WorldCall& launch, int world, int substeps) {
    if (launch.shares && perform_shares(*launch.shares, world))
        return;
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

// The same, unless a signal comes: then it counts as a step that has failed, which is undone.
bool perform_watched(const Run& run, int64_t from, int64_t to, int world, int substeps, int32_t* status) {
    if (!run.watch)
        return perform(*run.program, from, to, world, substeps, status);
    for (int64_t i = from; i < to; ++i) {
        if (!perform(*run.program, i, i + 1, world, substeps, status))
            return false;
        if (signal_has_come(*static_cast<Watch*>(run.watch))) {
            status[status::STATUS] = status::OVERFLOW;
            return false;
        }
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
        well = perform_watched(run, ends[BEGINNING], round_end, world, substeps, status);
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

// Performs launches of a step of one substep in all lanes that go on: a launch in one lane after the other, before the next
// one, since the code of a whole step is larger than the processor's nearest cache.
void perform_in_lanes(const Run& run, int64_t from, int64_t to, int first, bool (&goes_on)[LANES]) {
    for (int64_t i = from; i < to; ++i)
        for (int lane = 0; lane < LANES; ++lane)
            if (goes_on[lane])
                goes_on[lane] =
                    perform(run.lanes->worlds[lane].program, i, i + 1, first + lane, 1, status_of(run, first + lane));
}

// Solves the rows of all lanes that go on: at once, unless those of one of them cannot be relaxed together.
void solve_in_lanes(const Run& run, int first, bool (&goes_on)[LANES]) {
    const LaneMotion& lanes = *run.lanes;
    bool together = true;
    for (int lane = 0; lane < LANES; ++lane)
        together &= goes_on[lane] && lanes.worlds[lane].waiting[WAITING_ROOT] >= 0;
    together = together && relax_together(lanes);
    for (int lane = 0; lane < LANES; ++lane)
        if (goes_on[lane]) {
            perform(together ? lanes.worlds[lane].keep : lanes.worlds[lane].solve, first + lane, 1);
            goes_on[lane] = !status_of(run, first + lane)[status::STATUS];
        }
}

// Takes a step of one substep of the worlds from `first` on that are going.
void take_step_together(const Run& run, int first, int step, bool (&is_going)[LANES]) {
    const LaneMotion& lanes = *run.lanes;
    bool goes_on[LANES];
    for (int lane = 0; lane < LANES; ++lane)
        goes_on[lane] = is_going[lane];
    hand_over_motion(lanes);
    perform_in_lanes(run, 0, lanes.solving, first, goes_on);
    solve_in_lanes(run, first, goes_on);
    perform_in_lanes(run, lanes.solving, lanes.worlds[0].program.part_ends[END], first, goes_on);
    for (int lane = 0; lane < LANES; ++lane)
        if (is_going[lane])
            is_going[lane] = end_step(run, lanes.worlds[lane].program, first + lane, step, 1, goes_on[lane]);
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

// Takes some worlds of the list through their steps.
void take_all(const Run& run, int from, int end) {
    for (int i = from; i < end; ++i)
        if (move_at_once(run, i, end)) {
            take_through_steps_together(run, run.worlds[i]);
            i += LANES - 1;
        } else {
            take_through_steps(run, run.worlds[i]);
        }
}

// Where the share of a thread begins in the list; the last one ends with it.
int begin_of_share(const Run& run, int thread) {
    if (thread == run.threads)
        return run.world_count;
    return static_cast<int>(int64_t{run.world_count / LANES} * thread / run.threads) * LANES;
}

}  // namespace

void carom_perform(const Run* run) {
    if (!run->counters)
        return take_all(*run, 0, run->world_count);
    // Its own share comes first: the same worlds as in the last call, which are in the caches of its core.
    for (int i = 0; i < run->threads; ++i) {
        const int share = (run->thread + i) % run->threads;
        const int begin = begin_of_share(*run, share), end = begin_of_share(*run, share + 1);
        int32_t* taken = run->counters + share * COUNTER_STRIDE;
        for (;;) {
            const int from = begin + __atomic_fetch_add(taken, run->chunk, __ATOMIC_RELAXED);
            if (from >= end)
                break;
            take_all(*run, from, from + run->chunk < end ? from + run->chunk : end);
        }
    }
}
