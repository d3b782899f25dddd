// Threads that perform shares of a launch of a lone world.
//
// They know nothing of Python, whose locks and threads they use only because this library is linked against no other that
// has some. They begin with the first launch that has shares, and end with their team. One that comes late finds no share
// left, and is not waited for; so the thread that takes the step needs none of them.

#include "team.h"

#include "export.h"
#include "perform.h"
#include "python.h"

// How many forks there have been between the first process and this one: a fork copies no thread but one.
extern "C" CAROM_EXPORT int32_t carom_forks = 0;

namespace {

const unsigned long NO_THREAD = static_cast<unsigned long>(-1);
// How often to look whether the others are done, before the thread sleeps: a few microseconds.
const int LOOKS = 2000;

int32_t get(const int32_t& number) { return __atomic_load_n(&number, __ATOMIC_SEQ_CST); }

void set(int32_t& number, int32_t value) { __atomic_store_n(&number, value, __ATOMIC_SEQ_CST); }

// Sets a number to 0; returns what it was.
int32_t take(int32_t& number) { return __atomic_exchange_n(&number, 0, __ATOMIC_SEQ_CST); }

void wait_for(void* lock) { python.PyThread_acquire_lock(lock, 1); }

// A lock that is taken; null if there is none.
void* taken_lock() {
    void* lock = python.PyThread_allocate_lock();
    if (lock)
        wait_for(lock);
    return lock;
}

void wake(Helper& helper) {
    if (take(helper.waits))
        python.PyThread_release_lock(helper.begin);
}

// Performs shares of the present launch, if a helper has not done so yet.
void take_part(Team& team, Helper& helper) {
    __atomic_add_fetch(&team.inside, 1, __ATOMIC_SEQ_CST);
    const int32_t part = get(team.open);
    if (part && part != helper.part) {
        run(team.calls[helper.number].call);
        helper.part = part;
    }
    if (__atomic_sub_fetch(&team.inside, 1, __ATOMIC_SEQ_CST) == 0 && take(team.waits))
        python.PyThread_release_lock(team.done);
}

// Waits until there is a launch that a helper has not seen, or its team is over.
void wait_for_launch(Team& team, Helper& helper) {
    set(helper.waits, 1);
    const int32_t part = get(team.open);
    const bool is_due = (part && part != helper.part) || get(team.over);
    // If somebody has seen that it waits, the lock will be free.
    if (!is_due || !take(helper.waits))
        wait_for(helper.begin);
}

void help(void* argument) {
    Helper& helper = *static_cast<Helper*>(argument);
    Team& team = *static_cast<Team*>(helper.team);
    while (!get(team.over)) {
        take_part(team, helper);
        wait_for_launch(team, helper);
    }
    // After this the team may be gone.
    python.PyThread_release_lock(helper.ended);
}

// Begins the helpers, as many as can be had, in this process.
void begin(Team& team) {
    team.process = carom_forks + 1;
    team.begun = team.over = team.waits = team.open = team.inside = 0;
    team.done = taken_lock();
    if (!team.done)
        return;
    for (int i = 0; i < team.helper_count; ++i) {
        Helper& helper = team.helpers[i];
        helper.waits = helper.part = 0;
        helper.begin = taken_lock();
        helper.ended = taken_lock();
        if (!helper.begin || !helper.ended || python.PyThread_start_new_thread(help, &helper) == NO_THREAD)
            return;
        ++team.begun;
    }
}

// Waits until no helper performs shares of the launch that was closed.
void wait_for_helpers(Team& team) {
    for (int i = 0; i < LOOKS; ++i) {
        if (!get(team.inside))
            return;
#if defined(__x86_64__) || defined(_M_X64)
        __builtin_ia32_pause();
#endif
    }
    set(team.waits, 1);
    // If the last one has seen that it waits, the lock will be free.
    if (get(team.inside) || !take(team.waits))
        wait_for(team.done);
}

}  // namespace

bool perform_shares(const Shares& shares, int world) {
    Team& team = *shares.team;
    if (*shares.amount < shares.fewest || !python.PyThread_start_new_thread)
        return false;
    if (team.process != carom_forks + 1)
        begin(team);
    if (!team.begun)
        return false;
    for (int i = 0; i <= team.begun; ++i) {
        *shares.calls[i].first_world = world;
        if (i > 0)
            *shares.calls[i].status = status::WELL;
    }
    *team.taken = 0;
    team.calls = shares.calls;
    if (++team.part == 0)
        ++team.part;
    set(team.open, team.part);
    for (int i = 0; i < team.begun; ++i)
        wake(team.helpers[i]);
    run(shares.calls[0].call);
    set(team.open, 0);
    wait_for_helpers(team);
    // As if one had performed all: too little room is the lowest status, and then comes the first tree at fault.
    int32_t& all = *shares.calls[0].status;
    for (int i = 1; i <= team.begun; ++i) {
        const int32_t own = *shares.calls[i].status;
        if (own && (!all || own < all))
            all = own;
    }
    return true;
}

// Ends the threads of a team, whose memory nothing needs after that.
extern "C" CAROM_EXPORT void carom_end_team(Team* team) {
    if (team->process != carom_forks + 1)
        return;
    set(team->over, 1);
    for (int i = 0; i < team->begun; ++i)
        wake(team->helpers[i]);
    for (int i = 0; i < team->begun; ++i) {
        Helper& helper = team->helpers[i];
        wait_for(helper.ended);
        python.PyThread_free_lock(helper.begin);
        python.PyThread_free_lock(helper.ended);
    }
    if (team->done)
        python.PyThread_free_lock(team->done);
    team->process = 0;
}
