"""Locks of worlds, and how the functions of the public interface take them."""

from enum import IntEnum

from carom.layouts.records import Int32, Int64, Object, UInt64, c_record

MAX_CLIENTS = 1024


class Conduct(IntEnum):
    """What a function does to a world."""

    # Nothing that the lock protects, or it takes the lock itself.
    FREE = 0
    # It is called again if another call of the same thread ran in the middle of it. For its first call it
    # counts as one that changes, because modules are imported then.
    READS = 1
    # No signal handler, finalizer or trace function of the user runs in the middle of it.
    CHANGES = 2
    # It reads, and then makes one change, which does nothing if others have been made since the function was
    # called; then that is called again as one that changes.
    COMMITS = 3


@c_record()
class Gate:
    """The lock of a world.

    Attributes:
        owner: The thread that has the lock; 0 if none has.
        depth: How many times it has taken it.
        calls: Number of calls begun so far.
        waiting: Number of threads that wait.
        is_woken: One of them has been woken, and has not looked yet.
        wait: A method of a lock of Python, on which threads wait.
        wake: The method that wakes one of them.
    """

    owner: UInt64
    depth: Int64
    calls: Int64
    waiting: Int64
    is_woken: Int64
    wait: Object
    wake: Object


@c_record()
class Waiting:
    """Whether handlers of signals wait.

    Attributes:
        main_thread: The thread in which they run.
        calls: The number of calls, one within the other, in which it is.
        in_section: It is in a section, see `carom.native.uninterrupted`.
        arrived: Handlers have waited, and have not been called yet.
    """

    main_thread: UInt64
    calls: Int64
    in_section: Int64
    arrived: Int64


@c_record()
class Guard:
    """How a function of the public interface is called.

    Attributes:
        conduct: A `Conduct`.
        client_place: Index of the connection's number among positional arguments; -1 if it is none of them.
        is_known: It has returned once.
    """

    conduct: Int32
    client_place: Int32
    is_known: Int32
