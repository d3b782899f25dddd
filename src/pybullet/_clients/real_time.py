"""Real-time simulation, in the background."""

from __future__ import annotations

import atexit
from threading import Event, Thread
from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol
from weakref import WeakSet

from pybullet._calls.errors import logger

if TYPE_CHECKING:
    from carom.world.world import World
    from pybullet._window.window import Window

# Maximum delay of a world that cannot keep up, or of a process that was suspended [s].
_MAX_LAG = 0.1
# Interval between updates, unless the time step is longer [s].
_PERIOD = 1.0 / 240.0

_running: WeakSet[RealTimeClock] = WeakSet()


class Paced(Protocol):
    """What a clock needs of a connection; `Client` describes the attributes."""

    call_lock: Any
    world: World
    window: Window

    @property
    def time_step(self) -> float:
        """`fixedTimeStep` [s]."""
        ...


class Pace:
    """Counts the steps that a simulation is behind a clock. Counting from one start time avoids drift."""

    def __init__(self, now: float) -> None:
        """Starts at a time of the clock [s]."""
        self._simulated_until = now

    def steps_due(self, now: float, time_step: float) -> int:
        """Number of steps of `time_step` [s] due at a time of the clock [s]; they then count as done."""
        earliest = now - max(_MAX_LAG, time_step)
        if self._simulated_until < earliest:
            self._simulated_until = earliest
        count = int((now - self._simulated_until) / time_step)
        self._simulated_until += count * time_step
        return count


class RealTimeClock:
    """Steps the world of a client so that simulated time passes as fast as real time.

    The world is behind the clock by less than one time step if it can keep up; delays beyond a tenth of a
    second are dropped. The time step may change during the simulation.
    """

    def __init__(self, client: Paced) -> None:
        self._client = client
        self._stopping = Event()
        self._thread = Thread(target=self._run, name="pybullet real-time simulation", daemon=True)
        _running.add(self)
        self._thread.start()

    def stop(self) -> None:
        """Stops, and waits for the step in progress; there is none if the caller holds the client's lock."""
        self._stopping.set()
        _running.discard(self)
        # Waiting for the thread could block for ever: it may be waiting for the lock that the caller holds.
        # In a forked process the thread does not exist, and the lock may never be released.
        if self._thread.is_alive():
            with self._client.call_lock:
                return

    def _run(self) -> None:
        client, pace = self._client, Pace(monotonic())
        while not self._stopping.wait(max(_PERIOD, client.time_step)):
            for _ in range(pace.steps_due(monotonic(), client.time_step / (client.window.speed or 1.0))):
                if client.window.held and not client.window.has_turn():
                    break
                with client.call_lock:
                    if self._stopping.is_set():
                        return
                    try:
                        client.world.step()
                    except Exception:
                        logger.exception("Real-time simulation has stopped.")
                        return


@atexit.register
def _stop_all() -> None:
    # The interpreter would crash if a thread were inside compiled code while it shuts down.
    for clock in list(_running):
        clock.stop()
