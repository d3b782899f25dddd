"""Time and steps of a world."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import addressof, c_double, sizeof

from carom.engine.quick_steps import show_steps
from carom.errors import SimulationError
from carom.layouts.status import STATUS, WELL
from carom.native.change import Change, packed_block
from carom.native.gates import alone
from carom.native.uninterrupted import uninterrupted
from carom.scene.core.poses import PoseUpdates
from carom.scene.core.world_data import STRUCTURE
from carom.scene.faults import cause_in
from carom.scene.observers import SubstepObserver


class Stepping(PoseUpdates):
    """Time of a world, and its steps: prepared once, performed many times, watched by observers."""

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._clock.value

    @time.setter
    def time(self, value: float) -> None:
        self._clock.value = value

    def note_time(self, change: Change, time: float) -> None:
        """Set the simulated time [s] with a change."""
        value = c_double(time)
        block = packed_block(addressof(value), addressof(self._clock), sizeof(value))
        change.copy_blocks(block, value)

    def step(self, count: int = 1) -> None:
        """Advance the world by `count` time steps.

        Raises:
            ValueError: `count` is negative.
            carom.errors.SimulationError: A velocity became NaN or infinite; the whole state is as it was
                before that step, except that applied forces and torques are cleared.
        """
        if count < 0:
            raise ValueError(f"count must be at least 0, not {count}: steps cannot be undone")
        try:
            for _ in range(count):
                self._step()
        except BaseException:
            # Ctrl-C may come after arrays have grown and before the launches are updated.
            self.scene_changed()
            raise

    def _step(self) -> None:
        if self.observers:
            for observer in self.observers:
                observer.before_step()
        with self.lock:
            (self._derived.step or self._prepare_step())()
            if self._status[STATUS]:
                self._look_into_status()
            if self._substep_observers:
                self._tell_of_substep()
            self._clock.value += self.parameters.time_step
            if self.observers:
                for observer in self.observers.copy():
                    observer.after_step()

    @alone("lock")
    def watch_substeps(self, observer: SubstepObserver) -> None:
        """Call an observer at every substep from now on."""
        self._substep_observers.append(observer)
        self.scene_changed()

    @alone("lock")
    def unwatch_substeps(self, observer: SubstepObserver) -> None:
        """Stop calling an observer at every substep."""
        if observer in self._substep_observers:
            self._substep_observers.remove(observer)
            self.scene_changed()

    @alone("lock")
    def profile(self, count: int = 100) -> dict[str, float]:
        """Advance the world by `count` time steps, as `step` does, and return the time of each stage.

        The step is split into more launches than usual, so the sum is a little more than the time of a usual
        step.

        Returns:
            Seconds per step by stage: "link poses", "broad phase" (pairs of shapes whose bounds meet),
            "narrow phase" (their contacts), "islands" (groups of bodies that touch or are tied
            together), "free motion" (kinematics, mass matrices, velocities without constraints),
            "constraints" (rows of motors, limits, constraints and contacts, and their solution) and
            "integration"; where there are any, "soft bodies" as well.

        Raises:
            carom.errors.SimulationError: As from `step`.
        """
        from carom.scene.core.profile import Profile

        self.prepare()
        try:
            with Profile(self.engine) as profile:
                self._derived.step = self._step_staged
                self.step(count)
        finally:
            self.scene_changed()
        return {stage: seconds / count for stage, seconds in profile.seconds.items()}

    def _step_staged(self) -> None:
        self.engine.step([self._substeps_due()])

    def _look_into_status(self) -> None:
        """Repeat the step if arrays were too short; raise an error if a velocity is not finite."""
        with self.lock, uninterrupted:
            self.engine.recover()
            self._renew_after_growth()
        if self._status[STATUS]:
            self._raise_fault()

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

    @alone("lock")
    def prepare(self) -> None:
        """Update the arrays of the engine for the present bodies, constraints and parameters.

        Steps do this themselves; it is needed before the arrays are copied.
        """
        if self._derived.step is None:
            self._prepare_step()

    def _prepare_step(self) -> Callable[[], None]:
        """Write constraints and settings to the arrays; return the function that performs a step."""
        with self.lock, uninterrupted:
            return self._prepared_step()

    def _prepared_step(self) -> Callable[[], None]:
        self.constraints.write(
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
        if in_substeps:
            step = self._step_in_substeps
        else:
            self.unspent_time = 0.0
            step = self.engine.run_prepared
            if not self._substep_observers:
                show_steps(self.engine, self.quick, self._clock, self.observers, self.parameters)
        self._derived.step = step
        return step

    def _step_in_substeps(self) -> None:
        """Perform one step; call observers after each substep but the last (`_step` does that one)."""
        due = self._substeps_due()
        if not self._substep_observers:
            self.engine.step([due])
            return
        rounds = max(1, due)
        substep = 0
        while substep < rounds and self._status[STATUS] <= WELL:
            if self.engine.substep(due, substep):
                substep += 1
                if substep < rounds and self._status[STATUS] == WELL:
                    self._tell_of_substep()
                continue
            # Observers must read the new arrays.
            self._renew_after_growth()
            self._prepare_step()
            for observer in self._substep_observers:
                observer.step_repeated()
            substep = 0

    def _tell_of_substep(self) -> None:
        for observer in self._substep_observers:
            observer.after_substep()

    def _substeps_due(self) -> int:
        """Substeps of the next step."""
        due, self.unspent_time = self.parameters.substeps_due(self.unspent_time)
        return due

    @alone("lock")
    def detect_collisions(self) -> None:
        """Find all contacts for the present coordinates, without a step."""
        self.prepare()
        if self.engine.can_collide:
            self.engine.detect()
            self._renew_after_growth()
