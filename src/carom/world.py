"""A world: bodies, gravity and time, and the flat arrays that hold their state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import overload

import numpy as np

from carom.body import Body
from carom.checks import vector
from carom.constraints import JointConstraints
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.transform import compose
from carom.description_loading import DescriptionLoading
from carom.engine_settings import EngineSettings
from carom.errors import SimulationError
from carom.log import Log, Observer, SubstepObserver
from carom.model.body_spec import BodySpec
from carom.model.builder import WorldArrays
from carom.model.codes import UserConstraintKind
from carom.model.launch import KernelStructs, TreeLaunch
from carom.physics.kinematics import forward_kinematics_kernel, link_twist_kernel
from carom.physics.parameters import DEFAULT_TIME_STEP, EngineParameters
from carom.present_poses import PresentPoses
from carom.prospects import can_sleep, can_touch
from carom.queries import Queries
from carom.recordable import Recordable
from carom.snapshot import Layout, Snapshot, layout, put_back, take
from carom.solver_report import solver_report
from carom.state_views import VIEWS, StateViews
from carom.stepper import Stepper
from carom.touch_arrays import TouchArrays
from carom.user_constraints import UserConstraint, UserConstraints
from carom.user_data import UserData

_DEVICE = "cpu"


class World(DescriptionLoading, Recordable, StateViews):
    """Bodies that move under gravity, motors and limits.

    The arrays named in `docs/architecture.md` (`position`, `velocity`, `motor`...) are NumPy views
    of the state, and `position_memory` and so on the same memory as flat `memoryview` of doubles.
    They may be replaced when bodies are added or removed.

    Attributes:
        parameters: Parameters of the engine; call `apply_parameters` after a change.
        bodies: The bodies by their numbers, in the order they were added.
        time: Simulated time [s].
        user_data: Texts attached to bodies.
        observers: What is told of every step, such as logs.

    Args:
        time_step: Duration of one step [s].
    """

    def __init__(self, time_step: float = DEFAULT_TIME_STEP) -> None:
        self.parameters: EngineParameters = EngineParameters(time_step=time_step)
        self.bodies: dict[int, Body] = {}
        self.time: float = 0.0
        self.observers: list[Observer] = []
        self._substep_observers: list[SubstepObserver] = []
        self._stepper_type: Callable[..., Stepper] = Stepper
        self.unspent_time: float = 0.0
        self._start_empty()

    def _start_empty(self) -> None:
        self.bodies.clear()
        self.arrays: WorldArrays = WorldArrays()
        self._settings = EngineSettings()
        self._kernels = KernelStructs(settings=self._settings.struct)
        self.touch: TouchArrays = TouchArrays(self.arrays, _DEVICE)
        self.constraints: JointConstraints = JointConstraints()
        self.user_constraints: UserConstraints = UserConstraints()
        self.user_data: UserData = UserData()
        self.free_ids: list[int] = []
        self.next_id: int = 0
        self.unspent_time = 0.0
        self._step: Callable[[], None] | None = None
        self._made_for: tuple[int, int] | None = None
        # What the constraints in the arrays were grouped by; None if they are not those there are now.
        self._island_size: int | None = None
        self._layout: Layout | None = None
        self._link_places: list[tuple[int, int]] | None = None
        self._link_columns: tuple[list[int], list[int]] | None = None
        self._take_arrays()

    def __enter__(self) -> World:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._start_empty()

    # Bodies

    @overload
    def load(
        self, what: BodySpec, position: Sequence[float] = ..., orientation: Sequence[float] = ...
    ) -> Body: ...
    @overload
    def load(self, what: str | Path) -> list[Body]: ...
    def load(
        self,
        what: BodySpec | str | Path,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
    ) -> Body | list[Body]:
        """Add a body at rest, or all bodies of a world that was saved by `save`.

        A world without bodies becomes the one that was saved, parameters and time included, and goes on
        exactly as that one did. To any other the bodies are added as they were, with what ties them.

        Args:
            what: The body, or the file.
            position: Of the base's link frame [m]; bodies of a file are where they were.
            orientation: Of the base's link frame, quaternion (x, y, z, w).

        Returns:
            The body's handle, or those of the file's bodies. The number a body gets is that of the body
            removed last, if any.

        Raises:
            carom.errors.DescriptionError: The file, or that of a mesh, cannot be used; the world is as
                before.
        """
        if not isinstance(what, BodySpec):
            from carom.world_file import load_world

            return load_world(self, Path(what))
        return self._add(what, position, orientation)

    def save(self, path: str | Path) -> None:
        """Write everything there is to a file: bodies, meshes, constraints, parameters, looks, state.

        Raises:
            OSError: The file cannot be written; one that was there is as it was.
        """
        from carom.world_file import save_world

        save_world(self, Path(path))

    def _add(self, spec: BodySpec, position: Sequence[float], orientation: Sequence[float]) -> Body:
        """Add a body at rest."""
        px, py, pz = vector(position, 3, "position").tolist()
        qx, qy, qz, qw = vector(orientation, 4, "orientation").tolist()
        pose = compose(Pose((px, py, pz), (qx, qy, qz, qw)), spec.base.inertial_frame)
        rows, grown = self.arrays.append(spec, pose)
        body_id = self.free_ids.pop() if self.free_ids else self.next_id
        self.next_id = max(self.next_id, body_id + 1)
        body = Body(self, body_id, spec, rows)
        try:
            surfaces = [body.dynamics(link) for link in range(-1, body.joint_count)]
            self.touch.shapes.append(spec, rows, surfaces)
        except Exception:
            self.arrays.remove(rows, [])
            self.free_ids.append(body_id)
            if grown:
                self._take_arrays()
            raise
        self.bodies[body_id] = body
        self._layout = self._link_places = self._link_columns = None
        self.constraints.add_body(body)
        self.user_data.add_stated(body_id, spec)
        if grown:
            self._take_arrays()
        self.constraints_changed()
        body.update_link_poses()
        return body

    def remove(self, body_id: int) -> None:
        """Take a body out of the world.

        Raises:
            KeyError: There is no such body.
        """
        body = self.bodies.pop(body_id)
        self._layout = self._link_places = self._link_columns = None
        self.constraints.remove_body(body)
        self.user_constraints.remove_body(body)
        self.user_data.remove_body(body_id)
        self.touch.forget_contacts()
        self.touch.shapes.remove(body.rows)
        self.arrays.remove(body.rows, [other.rows for other in self.bodies.values()])
        for other in self.bodies.values():
            other.relocate()
        self.free_ids.append(body_id)
        self.constraints_changed()

    def reset(self) -> None:
        """Remove all bodies and set all parameters back, but for the time step and the substeps."""
        kept = self.parameters
        self.parameters = EngineParameters(time_step=kept.time_step, substeps=kept.substeps)
        self._start_empty()

    def tie(
        self,
        kind: UserConstraintKind,
        parent: Body,
        parent_link: int,
        child: Body | None,
        child_link: int,
        *,
        axis: Vector3 = (0.0, 0.0, 0.0),
        parent_frame: Pose = IDENTITY,
        child_frame: Pose = IDENTITY,
        hidden: bool = False,
    ) -> UserConstraint:
        """Tie a link to another, or to the world; see `UserConstraint` for the arguments.

        A hidden constraint is not among `user_constraints.all`.
        """
        constraint = self.user_constraints.add(
            kind, parent, parent_link, child, child_link, axis, parent_frame, child_frame, hidden=hidden
        )
        self.constraints.add_user(constraint)
        self.constraints_changed()
        return constraint

    def untie(self, constraint: UserConstraint) -> None:
        """Remove a constraint made by `tie`."""
        self.user_constraints.remove(constraint.id)
        self.constraints.remove_user(constraint)
        self.constraints_changed()

    def set_base_freedom(self, body: Body, *, free: bool) -> None:
        """Let the base of a body move, or hold it where it is."""
        self.arrays.set_base_freedom(body.rows, free=free)
        body.fixed_base = not free
        body.derived.clear()
        self.constraints.base_freedom_changed(body)
        self.constraints_changed()

    # State

    @property
    def link_places(self) -> list[tuple[int, int]]:
        """Body and link, -1 for the base, that each row of the link arrays stands for."""
        if self._link_places is None:
            bodies = sorted(self.bodies.values(), key=lambda body: body.first_link)
            self._link_places = [(body.id, link) for body in bodies for link in range(-1, body.joint_count)]
        return self._link_places

    @property
    def link_columns(self) -> tuple[list[int], list[int]]:
        """The bodies and the links of `link_places`, and -1 for row -1, which stands for none."""
        if self._link_columns is None:
            places = [*self.link_places, (-1, -1)]
            self._link_columns = [body for body, _ in places], [link for _, link in places]
        return self._link_columns

    def snapshot(self) -> Snapshot:
        """The present state, to come back to by `restore` as often as needed.

        It holds positions and velocities, motors, applied forces, contacts and time; not what bodies
        are made of, constraints, gravity and the other parameters.
        """
        if self._layout is None:
            self._layout = layout(self)
        return take(self, self._layout)

    def restore(self, state: Snapshot | str | Path) -> None:
        """Go back to a state. What follows is then the same, to the last bit, as it was the first time.

        Args:
            state: The state, or a file of `save`, of which only the state is read.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as it was.
            carom.errors.StateError: Bodies have come or gone, or one has other joints than it had; the
                world is as it was. A body that was removed and loaded again under its number is no
                hindrance, but contacts are then found anew.
        """
        if not isinstance(state, Snapshot):
            from carom.world_file import restore_world

            restore_world(self, Path(state))
            return
        if self._layout is None:
            self._layout = layout(self)
        put_back(self, self._layout, state)

    def log(self, *names: str, every: int = 1) -> Log:
        """Record state arrays after each step, until the log is stopped.

        Args:
            *names: Which ones: `position`, `velocity`, `link_pose`, `motor_impulse`... All rows of the
                world are recorded; those of a body start at its `first_position` and so on.
            every: Record every so many steps.

        Raises:
            ValueError: There is no such array, or `every` is less than 1.
        """
        unknown = [name for name in names if name not in VIEWS]
        if unknown or every < 1:
            raise ValueError(f"there is no array {unknown[0]!r}" if unknown else f"every is {every}")
        return Log(self, names, every)

    # Parameters

    @property
    def gravity(self) -> np.ndarray:
        """Gravity in world axes [m/s²], shape (3,)."""
        return np.array(self.parameters.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float]) -> None:
        x, y, z = vector(value, 3, "gravity").tolist()
        self.parameters.gravity = (x, y, z)
        self.apply_parameters()

    def apply_parameters(self) -> None:
        """Make changes of `parameters` take effect."""
        shapes, breaking = self.touch.shapes, self.parameters.contact_breaking_threshold
        if self._step is None or self._structure() != self._made_for or breaking != shapes.breaking_fraction:
            shapes.set_breaking_fraction(breaking)
            self._step = None
            self._queries = None
        else:
            self._update_settings()

    def constraints_changed(self) -> None:
        """Sort and number the constraints again before the next step."""
        self._island_size = None
        self._step = None
        self._queries = None
        self._present_poses = None

    # Time

    def step(self, count: int = 1) -> None:
        """Advance the world by `count` time steps.

        Raises:
            carom.errors.SimulationError: A velocity came out as NaN or infinite; all coordinates are as
                they were before that step. The forces applied for it, motor impulses, sensor readings
                and contacts are gone.
        """
        for _ in range(count):
            if self.observers:
                for observer in self.observers:
                    observer.before_step()
            (self._step or self._prepare_step())()
            if self._fault[0]:
                self._raise_fault()
            if self._substep_observers:
                self._tell_of_substep()
            self.time += self.parameters.time_step
            if self.observers:
                for observer in self.observers.copy():
                    observer.after_step()

    def watch_substeps(self, observer: SubstepObserver) -> None:
        """From now on tell an observer of every substep."""
        self._substep_observers.append(observer)
        self._step = None

    def unwatch_substeps(self, observer: SubstepObserver) -> None:
        """Tell an observer no more, if it is told of substeps."""
        if observer in self._substep_observers:
            self._substep_observers.remove(observer)
            self._step = None

    def profile(self, count: int = 100) -> dict[str, float]:
        """Advance the world by `count` time steps, as `step` does, and say where the time goes.

        The step is cut into more launches than usual for it, so the sum is a little more than a step
        takes otherwise. The first call compiles these.

        Returns:
            Seconds per step by stage: "link poses", "broad phase" (pairs of shapes whose bounds meet),
            "narrow phase" (their contacts), "islands" (groups of bodies that touch or are tied
            together), "free motion" (kinematics, mass matrices, velocities without constraints),
            "constraints" (rows of motors, limits, constraints and contacts, and their solution) and
            "integration".

        Raises:
            carom.errors.SimulationError: As from `step`.
        """
        from carom.profile import ProfiledStepper, StageClock

        clock = StageClock()
        self._stepper_type, self._step = partial(ProfiledStepper, clock=clock), None
        try:
            self.step(count)
        finally:
            self._stepper_type, self._step = Stepper, None
        return {stage: seconds / count for stage, seconds in clock.seconds.items()}

    def _raise_fault(self) -> None:
        """Throw away what the failed step left besides the coordinates, and say which body it was."""
        tree = self._fault[0] - 1
        body = next(body for body in self.bodies.values() if body.rows.tree == tree)
        self.joint_reaction[:] = 0.0
        self.motor_impulse[:] = 0.0
        self.touch.forget_contacts()
        for other in self.bodies.values():
            other.update_link_poses()
        raise SimulationError(
            f'body {body.id} ("{body.name}") came to a velocity that is not finite; '
            "the world is as it was before the step"
        )

    def _prepare_step(self) -> Callable[[], None]:
        """The function that performs one step with the bodies and parameters there are."""
        stepper = self._make_stepper()
        if self.parameters.substeps <= 1:
            self.unspent_time = 0.0
        self._step = stepper.single or self._step_with_care
        return self._step

    def _make_stepper(self) -> Stepper:
        """Write constraints and settings to the arrays and make the launches of a step."""
        island_size = self.parameters.minimum_island_size
        if island_size != self._island_size:
            if self.constraints.write(self.arrays, self.user_constraints.rows, island_size):
                self._take_arrays()
            self._island_size = island_size
        self.user_constraints.write(self.touch)
        self._queries = None
        self._made_for = self._structure()
        self._stepper = self._stepper_type(
            self._kernel_structs(),
            self.touch,
            self._fault,
            self.parameters.substeps,
            _DEVICE,
            touching=can_touch(self),
            sleeping=can_sleep(self),
            watched=bool(self._substep_observers) and self.parameters.substeps > 1,
        )
        return self._stepper

    def _step_with_care(self) -> None:
        """One step in substeps, and again with longer arrays as long as something does not fit."""
        substeps = self._substeps_due()
        between = self._tell_of_substep if self._substep_observers else None
        done = self._stepper.step(substeps, between=between)
        while done < max(1, substeps):
            if done == 0:
                for observer in self._substep_observers:
                    observer.step_repeated()
            done = self._make_stepper().step(substeps, done, between)

    def _tell_of_substep(self) -> None:
        for observer in self._substep_observers:
            observer.after_substep()

    def _substeps_due(self) -> int:
        """Substeps of the next step.

        Like Bullet's clock it counts as many as fit the time that has passed, which rounding can make
        one fewer, then one more, than asked for; never more.
        """
        if self.parameters.substeps <= 1:
            return 1
        part = self.parameters.substep_time
        self.unspent_time += self.parameters.time_step
        count = int(self.unspent_time / part)
        self.unspent_time -= count * part
        return min(count, self.parameters.substeps)

    def detect_collisions(self) -> None:
        """Find all contacts for the present coordinates, without a step."""
        if self._step is None:
            self._prepare_step()
        detection = self._stepper.detection
        while detection is not None and not detection.run():
            detection = self._make_stepper().detection

    def queries(self) -> Queries:
        """Rays, nearest points and overlaps for the present coordinates."""
        if self._queries is None:
            self._queries = Queries(
                self._kernel_structs(),
                self.position_memory,
                self.link_places,
                self.present_poses,
                self.touch,
                _DEVICE,
            )
        return self._queries

    def _structure(self) -> tuple[int, int]:
        """The parameters that decide which launches a step consists of."""
        return self.parameters.substeps, self.parameters.minimum_island_size

    def _update_settings(self) -> None:
        """Bring the settings that kernels get up to date, those of launches that are there as well."""
        if self._settings.update(self.parameters, self.arrays, self.touch):
            self._kernels.changed("settings")

    def _kernel_structs(self) -> KernelStructs:
        """Structs over the present arrays, by the name kernels give them."""
        model, state, scratch = self._structs
        self._kernels.update(model=model, state=state, scratch=scratch, **self.touch.structs())
        self._update_settings()
        return self._kernels

    def analytics(self) -> list[dict[str, float]]:
        """What the solver did in the last substep, for each group of bodies solved together.

        Returns:
            Dictionaries with `islandId`, `numBodies` (links), `numIterationsUsed` and
            `remainingResidual` (greatest squared change of a row's velocity in the last sweep).
        """
        return solver_report(self)

    # Memory

    def _take_arrays(self) -> None:
        """Make views and launches for the present arrays."""
        self._structs = self.arrays.structs(_DEVICE)
        self._step = None
        self._queries: Queries | None = None
        self._pose_launch: TreeLaunch | None = None
        self._present_poses: PresentPoses | None = None
        self._twist_launch: TreeLaunch | None = None
        self.view(self.arrays.state)
        self._fault = memoryview(self.arrays.state.numpy["fault_tree"][0])

    def present_poses(self) -> PresentPoses:
        """A context in which `link_pose` is up to date with the coordinates of all bodies."""
        if self._present_poses is None:
            poses = self.arrays.state.bytes_of("link_pose")
            self._present_poses = PresentPoses(poses, self._kernel_structs(), _DEVICE)
        return self._present_poses

    def update_link_poses(self, body: Body) -> None:
        """Bring `link_pose` up to date with the coordinates of a body."""
        if self._pose_launch is None:
            self._pose_launch = TreeLaunch(forward_kinematics_kernel, self._structs[:2], _DEVICE)
        self._pose_launch(body.rows.tree)

    def update_link_velocities(self, body: Body) -> None:
        """Fill `link_velocity` for the present coordinates of a body."""
        if self._twist_launch is None:
            self._twist_launch = TreeLaunch(link_twist_kernel, self._structs, _DEVICE)
        self._twist_launch(body.rows.tree)
