"""Time and steps of a world."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from carom.errors import SimulationError
from carom.layouts.status import STATUS, STEPS_DONE, WELL
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.core.poses import PoseUpdates
from carom.scene.core.world_data import STRUCTURE
from carom.scene.faults import cause_in
from carom.scene.observers import SubstepObserver

# Without contacts, a step of so few links ends within some microseconds.
_FEW_LINKS, _FEW_SWEEPS = 32, 100
# So many sweeps, times links, take a tenth of a millisecond or more.
_MUCH_WORK = 5000


class Stepping(PoseUpdates):
    """Time of a world, and its steps: prepared once, performed many times, watched by observers."""

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._clock.time

    @time.setter
    def time(self, value: float) -> None:
        self._clock.time = value

    @property
    def unspent_time(self) -> float:
        """The part of the simulated time that no substep has covered yet [s]."""
        return self._clock.unspent_time

    @unspent_time.setter
    def unspent_time(self, value: float) -> None:
        self._clock.unspent_time = value

    def step(self, count: int = 1) -> None:
        """Advance the world by `count` time steps.

        Raises:
            ValueError: `count` is negative.
            carom.errors.SimulationError: A velocity became NaN or infinite; the whole state is as it was
                before that step, except that applied forces and torques are cleared.
            carom.errors.StateError: An observer has called this in the middle of a step.
        """
        if count < 0:
            raise ValueError(f"count must be at least 0, not {count}: steps cannot be undone")
        self.refuse_in_step()
        try:
            for _ in range(count):
                self._step()
        except BaseException:
            self._is_in_step = False
            # Ctrl-C may come after arrays have grown and before the launches are updated.
            self.scene_changed()
            raise

    def _step(self) -> None:
        if self.observers:
            for observer in self.observers.copy():
                observer.before_step()
        while True:
            with self.call_lock:
                # The usual step is a builtin, which also lets the time go on.
                if not self.quick.take_step() and not self._step_otherwise():
                    continue
                if self.observers:
                    for observer in self.observers.copy():
                        observer.after_step()
                return

    def _step_otherwise(self) -> bool:
        """Perform a step that the builtin has not performed.

        Returns:
            False if it was broken off for handlers of signals, which run when the lock is given up.
        """
        while not self.quick.was_broken_off:
            if self._derived.step is None:
                self._prepare_step()
                if self.quick.take_step():
                    return True
                if self.quick.was_broken_off:
                    break
            if self._step_in_section():
                return True
        return False

    @gated("call_lock")
    def watch_substeps(self, observer: SubstepObserver) -> None:
        """Call an observer at every substep from now on.

        It may read the world, and set poses, joints, motors and forces, which the next substep starts from.
        What else would change the world raises `carom.errors.StateError`. An error of the observer is raised
        by `step`, and the world is as it was before that step; after the last substep, as after it.

        Raises:
            carom.errors.StateError: The world is in the middle of a step.
        """
        self.refuse_in_step()
        self._substep_observers.append(observer)
        self.scene_changed()

    @gated("call_lock")
    def unwatch_substeps(self, observer: SubstepObserver) -> None:
        """Stop calling an observer at every substep."""
        if observer in self._substep_observers:
            self.refuse_in_step()
            self._substep_observers.remove(observer)
            self.scene_changed()

    @gated("call_lock")
    def _profiled(self, count: int) -> dict[str, float]:
        """Take steps, and return the seconds of each stage; see `carom.profiling`."""
        from carom.scene.core.profile import Profile

        self.prepare()
        try:
            with Profile(self.engine) as profile:
                self.quick.forget_step()
                self._derived.step = type(self)._step_staged
                self.step(count)
        finally:
            self.scene_changed()
        return {stage: seconds / count for stage, seconds in profile.seconds.items()}

    def _step_staged(self) -> bool:
        due, left = self.parameters.substeps_due(self.unspent_time)
        self.engine.step([due])
        if self._status[STATUS]:
            return False
        self._clock.time, self._clock.unspent_time = self.time + self.parameters.time_step, left
        return True

    def _step_in_section(self) -> bool:
        """Perform a step that the native library does not perform by itself.

        Arrays were too short, a velocity is not finite, it is watched, or something has come in between.

        Returns:
            False if arrays were too short; they are longer now.
        """
        with self.call_lock, uninterrupted:
            step = self._derived.step or self._prepared_step()
            if not step(self):
                self._make_room()
                return False
            # It counts as a change.
            Change().commit()
            return True

    def _attempt(self) -> bool:
        due, left = self.parameters.substeps_due(self.unspent_time)
        return self.engine.attempt(due, left)

    def _make_room(self) -> None:
        """Make arrays longer after a step that has failed; raise an error if a velocity is not finite."""
        if self._status[STATUS] > WELL:
            self._raise_fault()
        # Also if it is broken off, everything is derived anew after arrays have grown.
        self.scene_changed()
        self.engine.make_room()
        self._growths = self.engine.growths
        for observer in self._substep_observers:
            observer.step_repeated()

    def _renew_after_growth(self) -> None:
        if self.engine.growths != self._growths:
            self._growths = self.engine.growths
            self.scene_changed()

    def _raise_fault(self) -> None:
        """Raise an error that names the body at fault."""
        tree = self._status[STATUS] - 1
        body = next(body for body in self.bodies.values() if body.rows.tree == tree)
        cause = cause_in(body)
        raise SimulationError(
            f'body {body.id} ("{body.name}") has a velocity that is not finite; '
            f"the world is as it was before the step{cause and f': {cause}'}"
        )

    @gated("call_lock")
    def prepare(self) -> None:
        """Update the arrays of the engine for the present bodies, constraints and parameters.

        Steps do this themselves; it is needed before the arrays are copied.
        """
        if self._derived.step is None:
            self._prepare_step()

    def _prepare_step(self) -> Callable[[Any], bool]:
        """Write constraints and settings to the arrays; return the function that performs a step."""
        with self.call_lock, uninterrupted:
            step = self._prepared_step()
            # Whoever is preparing a change of the scene relies on what was to be written.
            Change().commit()
            return step

    def _prepared_step(self) -> Callable[[Any], bool]:
        self.refuse_if_left()
        self._derived.removed = None
        self.joint_constraints.write(
            self.arrays, self.bodies, self.user_constraints.rows, self.parameters.minimum_island_size
        )
        self.user_constraints.write(self.contact_arrays, self.arrays.state)
        step = self._derived.step_before
        if step is not None and self.engine.resume(self.parameters):
            self.quick.resume_step()
            self._derived.step = step
            return step
        self.contact_arrays.soft.write_anchors()
        self.quick.forget_queries()
        self._derived.queries = None
        self._made_for = [getattr(self.parameters, name) for name in STRUCTURE]
        self.engine.update_settings(self.parameters)
        in_substeps = self.parameters.substeps > 1
        self.engine.prepare(watched=in_substeps and bool(self._substep_observers))
        if not in_substeps:
            self.unspent_time = 0.0
        step = type(self)._step_watched if self._substep_observers else type(self)._attempt
        if not self._substep_observers:
            self._show_steps()
        self._derived.step = step
        return step

    def _show_steps(self) -> None:
        """Let the native library perform steps by itself, until the scene changes."""
        engine, parameters = self.engine, self.parameters
        contacts, substeps = engine.contact_arrays.contacts.struct(), parameters.substep_count
        sweeps = parameters.solver_iterations * parameters.noncontact_inner_iterations * substeps
        is_small = engine.arrays.used["link"] <= _FEW_LINKS and not engine.contact_arrays.soft.bodies
        count = contacts.count_contacts.data if is_small and sweeps <= _FEW_SWEEPS else None
        is_long = bool(engine.contact_arrays.soft.bodies)
        is_long = is_long or engine.arrays.used["link"] * sweeps >= _MUCH_WORK
        kept = engine, contacts
        self.quick.set_step_addresses(
            engine.step_addresses(), self.observers, count, kept, substeps=substeps, long=is_long
        )

    def _step_watched(self) -> bool:
        """Perform a step, and call observers after each substep; an error of theirs undoes it."""
        due, left = self.parameters.substeps_due(self.unspent_time)
        last, time = max(1, due) - 1, self.time
        # The first substep sets it to 0, and the last one lets the time go on.
        self._status[STEPS_DONE] = -1
        self._is_in_step = True
        try:
            for substep in range(last):
                if not self.engine.attempt(due, left, substep, substep + 1):
                    return False
                self._tell_of_substep()
            if not self.engine.attempt(due, left, last, last + 1):
                return False
        except BaseException:
            if self._status[STATUS] == WELL and self._status[STEPS_DONE] >= 0 and self.time == time:
                self.engine.abandon()
            raise
        finally:
            self._is_in_step = False
        self._tell_of_substep()
        return True

    def _tell_of_substep(self) -> None:
        for observer in self._substep_observers.copy():
            observer.after_substep()

    @gated("call_lock")
    def detect_collisions(self) -> None:
        """Find all contacts for the present coordinates, without a step."""
        self.refuse_in_step()
        self.prepare()
        if self.engine.can_collide:
            self.engine.detect()
            self._renew_after_growth()
