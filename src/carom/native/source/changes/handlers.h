// Handlers of signals, which wait while the main thread is in a call; see `carom.native.handlers`.
#pragma once

#include "gate.h"

extern "C" CAROM_EXPORT Waiting carom_waiting;

// Begins a call, in which handlers wait. `thread` is the present one.
inline void begin_call(uint64_t thread) {
    if (thread == carom_waiting.main_thread)
        ++carom_waiting.calls;
}

// Ends a call; handlers that have waited are still to be called.
inline void end_call(uint64_t thread) {
    if (thread == carom_waiting.main_thread && carom_waiting.calls)
        --carom_waiting.calls;
}

// Whether there are handlers to be called now. Only the main thread has any.
inline bool is_handler_due() {
    return carom_waiting.arrived && !carom_waiting.calls && !carom_waiting.in_section &&
           python.PyThread_get_thread_ident() == carom_waiting.main_thread;
}

// Calls them. False with an error if one of them raised it, in place of one that is set before.
bool call_handlers();
