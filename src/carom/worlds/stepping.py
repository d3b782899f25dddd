"""Steps of many worlds: the part of `Worlds` that lets time go on."""

from __future__ import annotations

import warnings
from time import perf_counter
from typing import Any, Protocol

import numpy as np

from carom.checks import Array
from carom.engine.engine import MAX_STEPS, Engine
from carom.errors import SimulationWarning
from carom.layouts.status import STATUS, STEPS_DONE, WELL
from carom.native.handlers import handler_waits
from carom.native.uninterrupted import uninterrupted
from carom.scene.bodies import Bodies
from carom.world.world import World
from carom.worlds.body import BodyBatch
from carom.worlds.chosen import Mask, Where, world_numbers
from carom.worlds.sensors import BatchSource

_PATIENCE = 0.05
"""How long steps may be taken before it is seen whether a signal has come [s]."""
_MAX_NAMED = 8
"""Maximum number of worlds named in a warning when several halt."""


class WorldsObserver(Protocol):
    """Interface of the objects in `Worlds.observers`."""

    @property
    def each_step(self) -> bool:
        """Whether it is called at each step, and not only once for each call of `Worlds.step`."""
        ...

    def before_steps(self) -> None:
        """Called before steps."""
        ...

    def after_steps(self) -> None:
        """Called after steps."""
        ...


class WorldsStepping:
    """Base class of `Worlds`: its steps, and the worlds that halt in one."""

    count: int
    time: Array
    halted: Mask
    observers: list[WorldsObserver]
    call_lock: Any
    _scene: World
    _engine: Engine
    _bodies: Bodies[BodyBatch]
    _sensors: BatchSource
    _unspent_times: Array
    _steps_at_once: int

    def step(self, count: int = 1, where: Where | None = None) -> None:
        """Advance the worlds that are not halted by `count` time steps.

        A world whose velocities become NaN or infinite is halted; a `SimulationWarning` names it. If a signal
        comes, its handler runs between two steps, without the lock; what it raises ends the call there.

        Args:
            count: Number of steps.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: The number of steps is negative.
        """
        if count < 0:
            raise ValueError(f"count must be at least 0, not {count}: steps cannot be undone")
        if not self.observers:
            self._advance(count, where)
            return
        while count > 0:
            observers = self.observers.copy()
            for observer in observers:
                observer.before_steps()
            steps = 1 if any(observer.each_step for observer in observers) else count
            self._advance(steps, where)
            for observer in observers:
                observer.after_steps()
            count -= steps

    def _advance(self, count: int, where: Where | None) -> None:
        chosen = None if where is None else np.unique(world_numbers(self._engine.take(where), self.count))
        in_turns = count > 1
        while count > 0:
            with self.call_lock:
                while True:
                    # Sensors with a memory measure after each step.
                    steps = 1 if self._sensors.remembered else min(count, self._steps_at_once)
                    start = perf_counter()
                    with uninterrupted:
                        if steps > 1 or chosen is not None or not self._step_all():
                            self._step(steps, chosen)
                    count -= steps
                    seconds = perf_counter() - start
                    if seconds > _PATIENCE:
                        self._steps_at_once = max(1, int(steps * _PATIENCE / seconds))
                    elif steps == self._steps_at_once < MAX_STEPS and seconds < _PATIENCE / 2.0:
                        self._steps_at_once = min(2 * steps, MAX_STEPS)
                    # Handlers run when the lock has been given up.
                    if not count or handler_waits():
                        break
                if in_turns:
                    # Else it would say how long they have taken.
                    self._engine.status[:, STEPS_DONE] = 1

    def _step_all(self) -> bool:
        """Perform the usual step, of all worlds and with one substep; false if that is not what is due."""
        if self._scene.parameters.substeps > 1 or self._sensors.remembered or not self._engine.keeps_times:
            return False
        if np.count_nonzero(self.halted):
            return False
        if not self._engine.step_all():
            self._halt(np.flatnonzero(self._engine.status[:, STATUS] > WELL), 1)
        return True

    def _step(self, steps: int, chosen: np.ndarray | None) -> None:
        running = np.flatnonzero(~self.halted) if chosen is None else chosen[~self.halted[chosen]]
        if not len(running):
            return
        parameters, watch = self._scene.parameters, self._sensors.watch()
        if parameters.substeps <= 1:
            self._engine.step([1] * steps, None if len(running) == self.count else running)
        else:
            # Worlds with different unspent times have their substeps in different steps.
            for unspent in np.unique(self._unspent_times[running]):
                worlds = running[self._unspent_times[running] == unspent]
                due, left = [], [float(unspent)]
                for _ in range(steps):
                    substeps, after = parameters.substeps_due(left[-1])
                    due.append(substeps)
                    left.append(after)
                self._engine.step(due, worlds, left[1:])
                if not self._engine.keeps_times:
                    self._unspent_times[worlds] = left[-1]
        if not self._engine.keeps_times:
            # Added one by one, as in a single world, for the same rounding.
            for _ in range(steps):
                self.time[running] += self._scene.parameters.time_step
        status = self._engine.status[running, STATUS]
        if status.any():
            self._halt(running[status > WELL], steps)
        if watch is not None:
            watch.finish(running[~self.halted[running]])

    def _halt(self, worlds: np.ndarray, steps: int) -> None:
        """Mark worlds whose step failed, and warn."""
        self.halted[worlds] = True
        if not self._engine.keeps_times:
            self.time[worlds] -= self._scene.parameters.time_step * (steps - self._engine.steps_done(worlds))
        names = {batch._body_rows.tree: batch.name for batch in self._bodies.values()}
        for world in worlds[:_MAX_NAMED].tolist():
            name = names[int(self._engine.status[world, STATUS]) - 1]
            warnings.warn(
                f"world {world} is halted: its body {name!r} has a velocity that is not finite",
                SimulationWarning,
                stacklevel=5,
            )
        if len(worlds) > _MAX_NAMED:
            warnings.warn(f"{len(worlds)} worlds are halted", SimulationWarning, stacklevel=5)
