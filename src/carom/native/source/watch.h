// Signals that come in a long step, which is broken off for their handlers.
#pragma once

#include <stdint.h>

// Looks for signals while a step runs without the GIL.
struct Watch {
    // What Python calls the thread.
    void* thread;
    // When the step began, and when to look next [ns].
    int64_t begun, next;
    // A handler waits, or Ctrl-C has raised an error.
    bool has_come;
};

// Begins to watch, unless handlers could not be called anyway if the step were broken off: in other threads than the main
// one, in sections, and in more than so many calls. The GIL is held; it is to be released at once, for `thread`.
bool begin_to_watch(Watch& watch, int64_t calls);

// Whether a signal has come; looks only from time to time.
bool signal_has_come(Watch& watch);
