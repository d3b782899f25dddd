// Looks for signals in long steps.

#include "watch.h"

#include "export.h"
#include "handlers.h"

// How long a step takes before it is broken off for the first time [ns]; tests change it.
extern "C" CAROM_EXPORT int64_t carom_patience = 500000000;

namespace {

const int64_t LOOK_EVERY = 50000000, SECOND = 1000000000;
// What has been done of a step is lost. So many times as long none is broken off: a tenth is lost at most, however many
// signals come.
const int64_t REST = 10;

struct TimeSpec {
    int64_t seconds, nanoseconds;
};

// The clock of the system, and which one it is; null where there is none.
int (*get_time)(int, TimeSpec*);
int clock_number;

// Until when no step is broken off [ns]; only the main thread asks.
int64_t rests_until;

int64_t now() {
    TimeSpec time;
    get_time(clock_number, &time);
    return time.seconds * SECOND + time.nanoseconds;
}

}  // namespace

// Tells the library of `clock_gettime`: it is linked against no C library.
extern "C" CAROM_EXPORT void carom_meet_clock(int (*function)(int, TimeSpec*), int number) {
    get_time = function;
    clock_number = number;
}

bool begin_to_watch(Watch& watch, int64_t calls) {
    if (!get_time || carom_waiting.in_section || carom_waiting.calls > calls ||
        python.PyThread_get_thread_ident() != carom_waiting.main_thread)
        return false;
    watch.begun = now();
    watch.next = watch.begun + carom_patience;
    if (watch.next < rests_until)
        watch.next = rests_until;
    watch.has_come = false;
    return true;
}

bool signal_has_come(Watch& watch) {
    const int64_t time = now();
    if (time < watch.next)
        return false;
    watch.next = time + LOOK_EVERY;
    python.PyEval_RestoreThread(watch.thread);
    // As in a call, in which they are noted.
    ++carom_waiting.calls;
    const bool failed = python.PyErr_CheckSignals();
    --carom_waiting.calls;
    watch.has_come = failed || carom_waiting.arrived;
    if (watch.has_come)
        rests_until = time + REST * (time - watch.begun);
    watch.thread = python.PyEval_SaveThread();
    return watch.has_come;
}
