"""The tables of any number of worlds, and the launches that perform their steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import le
from typing import Any

import numpy as np

from carom.description.pose import Vector3
from carom.engine.can_collide import can_collide, can_sleep, has_adhesion, has_late_links
from carom.engine.contact_arrays import ContactArrays
from carom.engine.integrators import Laws
from carom.engine.interpreter import ALL_SUBSTEPS, Interpreter, Stepper
from carom.engine.lane_work import can_move_together
from carom.engine.parameters import COMPLIANT, CONVERGED, DISCRETE, EngineParameters
from carom.engine.presence import any_absent
from carom.engine.program import Plan, Program, detection_program, step_program
from carom.engine.quick_scene import QuickScene
from carom.engine.runner import ProgramRunner, move_in_lanes
from carom.engine.settings import EngineSettings
from carom.engine.shared_steps import SharedSteps
from carom.engine.task import Task
from carom.engine.workspace import Workspace
from carom.engine.world_parameters import WorldParameters
from carom.layouts.status import CONTACTS_WANTED, OVERFLOW, PAIRS_WANTED, STATUS, STEPS_DONE, WELL
from carom.model.builder import WorldArrays
from carom.native.change import Change
from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import ArrayTable

ProgramMaker = Callable[[KernelStructs, Plan], Program]

MAX_STEPS = 64
"""Maximum number of steps in one call."""
# Shapes of a scene in which collisions are detected with the GIL held.
_MAX_QUICK_SHAPES = 64
_NONE = np.zeros(0, dtype=np.int64)
# Contacts take memory in each of many worlds: factor by which their arrays grow.
_GROWTH_OF_MANY = 1.25


class Engine(WorldParameters):
    """Performs steps.

    A step of a world is a function of its model, state, parameters and a workspace, and no Python code runs
    between the launches of a step. Arrays have a fixed length while worlds are stepped. If they are too
    short, the missing rows are counted per world, and the counts are read once at the end: these worlds are
    restored to the start of the step that failed, all arrays grow, and the worlds are stepped again.

    Attributes:
        arrays: Model and state of all bodies.
        contact_arrays: Shapes, contacts, user constraints.
        status: Result of the last step of each world, (worlds, columns); see `carom.layouts.status`.
        due: Number of substeps of each step of a call.
        changes: Number of times that launches were renewed.
        growths: Number of times that arrays were replaced by longer ones.

    Args:
        arrays: Model and state.
        contact_arrays: Shapes, contacts and user constraints.
        threads: Number of threads, which take worlds.
        island_threads: Number of those that share the islands of the only world.
    """

    # The programs of steps and of collision detection.
    step_program: ProgramMaker = staticmethod(step_program)
    detection_program: Callable[[KernelStructs], Program] = staticmethod(detection_program)
    # Whether bodies can be absent in some worlds.
    allows_absence = True
    # Whether it takes steps of several worlds at once where these have robots.
    moves_together = True
    # Whether steps let times go on, see `keep_times`.
    keeps_times = True
    # Whether workspaces depend on lengths of arrays and numbers of rows only.
    keeps_structs = True

    def __init__(
        self,
        arrays: WorldArrays,
        contact_arrays: ContactArrays,
        threads: int = 1,
        island_threads: int = 1,
    ) -> None:
        self.arrays = arrays
        self.contact_arrays = contact_arrays
        self.status: np.ndarray = self._make_status()
        self._first_status = memoryview(self.status[0])
        self._faults = self.status[:, STATUS]
        self._status_address = self.status.ctypes.data
        self._settings = EngineSettings()
        self._workspaces = self._make_workspaces(threads)
        self._shared = SharedSteps(island_threads) if island_threads > 1 else None
        self._runner = ProgramRunner(arrays.world_count, threads)
        self.due = np.ones(MAX_STEPS, dtype=np.int32)
        self._interpreters: list[Stepper] = self._make_interpreters(self.due)
        # With no substep due, contacts are detected and nothing moves.
        self._detectors: list[Stepper] = self._make_interpreters(np.zeros(1, dtype=np.int32))
        self._steppers = self._interpreters
        self._make_program: ProgramMaker = self.step_program
        # Unspent times after each step of a call.
        self._unspent_after = np.zeros(MAX_STEPS)
        self._has_unspent = False
        self._duration = 0.0
        self._times: Any = None
        self._plan: Plan | None = None
        # The previous plan, if only constraints have changed since.
        self._plan_before: Plan | None = None
        # The numbers of constraints that the launches of steps suit.
        self._prepared_for: tuple[int, int] | None = None
        # Plan and structs of the present launches of steps.
        self._loaded_for: tuple[Any, ...] | None = None
        self._tables = self._all_tables()
        # Structs and counts of rows of the last binding.
        self._bound: tuple[list[Any], tuple[int, ...]] = [], ()
        # The worlds whose arrays were too short.
        self._short = _NONE
        self._watched = False
        self._laws = Laws()
        self.growths = 0
        self.changes = 0
        self._detection_ready = False

    @property
    def workspace(self) -> Workspace:
        """The workspace of the first thread, which queries use as well."""
        return self._workspaces[0]

    @property
    def can_collide(self) -> bool:
        """Whether two shapes could ever touch."""
        return can_collide(self.arrays, self.contact_arrays) if self._plan is None else self._plan.touching

    def changed(self) -> None:
        """Renew the launches before the next step: arrays have moved, or other parts of a step are needed."""
        change = Change()
        self.note_change(change)
        change.commit()

    def note_change(self, change: Change) -> None:
        """The same with a change."""
        change.set_all(
            self,
            _plan=None,
            _plan_before=None,
            _loaded_for=None,
            _prepared_for=None,
            _detection_ready=False,
            changes=self.changes + 1,
        )

    def note_constraints(self, change: Change) -> None:
        """Check the launches before the next step: a change is one of constraints, and of nothing else."""
        if self._plan is not None:
            change.set_all(self, _plan=None, _plan_before=self._plan)

    @property
    def is_as_before(self) -> bool:
        """Whether constraints have changed, and the launches of before need no other numbers of them."""
        return (
            self._plan is None
            and self._plan_before is not None
            and self._loaded_for is not None
            and self.keeps_structs
            and self._constraint_counts() == self._prepared_for
            and self._settings.has_counts(self.arrays, self.contact_arrays)
        )

    def note_as_before(self, change: Change) -> None:
        """Use the launches of before with a change: constraints are as they were, too."""
        change.set(self, "_plan", self._plan_before)

    def note_parameters(self, change: Change) -> None:
        """Update the settings of kernels before the next step, after a change of parameters."""
        self._settings.note_change(change)

    def note_gravity(self, change: Change, gravity: Vector3) -> None:
        """Set gravity [m/s²] with a change; the launches of a step stay as they are."""
        self._settings.note_gravity(change, self.arrays, gravity)

    @property
    def is_planned(self) -> bool:
        """Whether the launches of a step are those for the present bodies and constraints."""
        return self._plan is not None

    # Structs

    def structs(self) -> KernelStructs:
        """Structs over the current arrays, by the names of kernel arguments, for one thread."""
        return self._bind()[0]

    def update_settings(self, parameters: EngineParameters) -> None:
        """Update the settings of kernels, also in existing launches."""
        if self._laws.ask(parameters):
            self.changed()
        self._settings.update(parameters, self.arrays, self.contact_arrays, self._tell_settings)
        if parameters.time_step != self._duration:
            self._duration = parameters.time_step
            for stepper in self._interpreters:
                stepper.ask(duration=self._duration)

    def keep_times(self, times: int, unspent_times: int, kept: object) -> None:
        """Let the times of worlds go on with each step, by the same native call.

        Args:
            times: Address of the simulated time of each world [s].
            unspent_times: Address of the part of it that is not covered by a substep yet [s], of each world.
            kept: The memory that they are in.
        """
        self._times = kept
        for stepper in self._interpreters:
            stepper.ask(times=times, unspent_times=unspent_times)

    def resume(self, parameters: EngineParameters) -> bool:
        """Use the launches of before constraints changed, if they still perform the right step.

        Args:
            parameters: Parameters of the world.

        Returns:
            False if `prepare` has to be called.
        """
        if self._plan_before is None or self._loaded_for is None or not self.keeps_structs:
            return False
        counts = self._constraint_counts()
        if counts == self._prepared_for:
            self._plan = self._plan_before
        # No array is replaced while all of them are long enough.
        elif not self._is_long_enough() or self._find_plan() != self._loaded_for[0]:
            return False
        self._prepared_for = counts
        if not self._settings.has_counts(self.arrays, self.contact_arrays):
            self.update_settings(parameters)
        return True

    def _tell_settings(self) -> None:
        """Launches have copies of the settings: update them."""
        for workspace in self._workspaces:
            workspace.structs.changed("settings")
        if self._shared is not None:
            self._shared.settings_changed()
        for stepper in self._interpreters:
            if isinstance(stepper, Interpreter) and stepper.lane_work:
                stepper.lane_work.settings_changed()

    def _bind(self) -> list[KernelStructs]:
        """Structs over the current arrays for each thread; the arrays are made longer if necessary."""
        if self.keeps_structs and self._is_bound():
            return [workspace.structs for workspace in self._workspaces]
        self.contact_arrays.reserve()
        for workspace in self._workspaces:
            workspace.fit(self.arrays, self.contact_arrays)
            workspace.fit_laws(self.arrays, *self._laws.needs)
        shared: dict[str, Any] = {
            "settings": self._settings.struct,
            **self.arrays.structs(),
            **self.contact_arrays.structs(),
        }
        bound = [workspace.bind(shared) for workspace in self._workspaces]
        self._bound = [table.struct() for table in self._tables], self._row_counts()
        return bound

    def _is_bound(self) -> bool:
        """Whether no array has been replaced since `_bind`, and all are long enough."""
        return [table.struct() for table in self._tables] == self._bound[0] and self._is_long_enough()

    def _is_long_enough(self) -> bool:
        """Whether there are no more rows than at `_bind`."""
        return all(map(le, self._row_counts(), self._bound[1]))

    def _constraint_counts(self) -> tuple[int, int]:
        return self.arrays.used["constraint"], self.contact_arrays.user_count

    def _row_counts(self) -> tuple[int, ...]:
        contact_arrays = self.contact_arrays
        return (
            *self.arrays.used.values(),
            contact_arrays.user_count,
            contact_arrays.shapes.shape_count,
            len(contact_arrays.soft.bodies),
            *self._laws.needs,
        )

    # Steps

    def prepare(self, *, watched: bool = False) -> None:
        """Make the launches of a step for the current bodies and constraints.

        Args:
            watched: Whether a function is called after every substep.
        """
        self._watched = watched
        self._prepared_for = None
        plan = self._find_plan()
        bound = self._bind()
        loading_for = plan, *self._bound[0]
        # Structs are the same objects until arrays are replaced.
        if self._loaded_for != loading_for:
            self._loaded_for = None
            self._load_steps(bound, plan)
            self._loaded_for = loading_for
        self._divide(plan)
        self._prepared_for = self._constraint_counts()

    def _load_steps(self, bound: list[KernelStructs], plan: Plan) -> None:
        self._load(self._steppers, bound, lambda structs: self._make_program(structs, plan))

    def _divide(self, plan: Plan) -> None:
        """Let several worlds move at once, or threads share a lone one, if they can.

        Also after rows have moved within the same arrays.
        """
        is_usual = self._make_program is self.step_program
        move_in_lanes(self._steppers, self._workspaces, self.arrays, plan, is_usual)
        if is_usual and self._shared is not None:
            self._shared.fit(self._steppers[0], self.workspace, self.status, plan, self._loaded_for)

    @property
    def steps_in_lanes(self) -> int:
        """How many steps of several worlds have begun together so far."""
        return sum(one.steps_in_lanes for one in self._steppers if isinstance(one, Interpreter))

    def step_addresses(self) -> tuple[int, int]:
        """Addresses of the arguments of a step, 0 if there are none, and of the first status.

        They are valid until the next call of `prepare`.
        """
        return self._steppers[0].address, self._status_address

    def step_by(self, make_program: ProgramMaker, steppers: list[Stepper] | None = None) -> None:
        """Use other programs and steppers from now on."""
        self._make_program = make_program
        self._steppers = self._interpreters if steppers is None else steppers
        self.changed()

    def _find_plan(self) -> Plan:
        """Find out which parts of a step are needed now."""
        if self._plan_before is not None:
            touching, sleeping = self._plan_before.touching, self._plan_before.sleeping
            absent = self._plan_before.absent
        else:
            touching, sleeping = can_collide(self.arrays, self.contact_arrays), can_sleep(self.arrays)
            absent = any_absent(self.arrays)
        if not touching:
            self.contact_arrays.forget_contacts()
        soft = bool(self.contact_arrays.soft.bodies)
        laws, late, adhesive = self._laws, has_late_links(self.arrays), has_adhesion(self.arrays)
        laws.settle(self.arrays, self.contact_arrays, touching=touching)
        converged = laws.contact in CONVERGED
        coupled = touching or sleeping or absent or soft or converged or late or adhesive
        coupled = coupled or laws.integrator != DISCRETE
        coupled = coupled or self._watched or self.contact_arrays.user_count > 0
        coupled = coupled or (self.moves_together and can_move_together(self.arrays))
        compliant = laws.contact == COMPLIANT
        noslip = laws.noslip if compliant else 0
        self._plan = Plan(
            touching, sleeping, coupled, soft, absent, converged, compliant, noslip, late,
            laws.integrator, adhesive,
        )  # fmt: skip
        return self._plan

    def step(
        self,
        due: Sequence[int],
        worlds: np.ndarray | None = None,
        unspent_after: Sequence[float] | None = None,
    ) -> None:
        """Perform steps of some worlds.

        Args:
            due: Number of substeps of each step; at most `MAX_STEPS` steps.
            worlds: Numbers of the worlds, shape (n,); None for all.
            unspent_after: The time that remains after each step [s]; None if that does not change.
        """
        if self._plan is None:
            self.prepare(watched=self._watched)
        try:
            self._ask_for(due, unspent_after)
            self._runner.run(self._steppers, worlds, step_count=len(due))
            while self.make_room():
                self._runner.run(self._steppers, self._short, resumed=1, step_count=len(due))
        finally:
            self._ask_as_usual(len(due))

    def step_all(self) -> bool:
        """Perform a step of one substep of all worlds; whether it went well in all of them."""
        if self._plan is None:
            self.prepare(watched=self._watched)
        self._runner.run(self._steppers)
        if not np.count_nonzero(self._faults):
            return True
        while self.make_room():
            self._runner.run(self._steppers, self._short, resumed=1)
        return not np.count_nonzero(self._faults)

    def attempt(
        self, due: int, unspent_after: float, first_substep: int = 0, end_substep: int = ALL_SUBSTEPS
    ) -> bool:
        """Perform a step of the only world, or some of its substeps; the first begins it, the last ends it.

        Returns:
            False if it has failed: the world is back at the start of the step.
        """
        substeps = {"first_substep": first_substep, "end_substep": end_substep}
        try:
            self._ask_for([due], [unspent_after])
            self._runner.run(self._steppers, self._runner.all_worlds, **substeps)
        finally:
            self._ask_as_usual(1)
        return self._first_status[STATUS] == WELL

    def _ask_for(self, due: Sequence[int], unspent_after: Sequence[float] | None) -> None:
        self.due[: len(due)] = due
        if unspent_after is not None:
            self._unspent_after[: len(due)] = unspent_after
            self._has_unspent = True
            for stepper in self._interpreters:
                stepper.ask(unspent_after=self._unspent_after.ctypes.data)

    def _ask_as_usual(self, count: int) -> None:
        """Also after Ctrl-C, or the next steps would have as many substeps."""
        self.due[:count] = 1
        if self._has_unspent:
            for stepper in self._interpreters:
                stepper.ask(unspent_after=None)
            self._has_unspent = False

    def abandon(self) -> None:
        """Return the only world to the start of a step, of which some substeps have been performed."""
        self._first_status[STATUS] = OVERFLOW
        for launch in self._steppers[0].program.abandon:
            launch()
        self._first_status[STATUS] = WELL

    def make_room(self) -> bool:
        """Make arrays longer for the worlds whose arrays were too short; whether there are any."""
        self._short = self._short_of_room()
        if not len(self._short):
            return False
        self._grow(self._short)
        self.prepare(watched=self._watched)
        return True

    def detect(self, worlds: np.ndarray | None = None) -> None:
        """Find all contacts at the current coordinates of some worlds, None for all, without a step."""
        self._detect(worlds)
        while len(short := self._short_of_room()):
            self._grow(short)
            self._detect(short)

    def show_detection(self, quick: QuickScene) -> None:
        """Let the native library detect collisions by itself, until the scene changes.

        In a large scene Python does it, which lets other threads run meanwhile.
        """
        detector = self._detectors[0]
        is_small = self.contact_arrays.shapes.shape_count <= _MAX_QUICK_SHAPES
        if is_small and self._detection_ready and self._plan and isinstance(detector, Interpreter):
            find_poses = self.workspace.structs.launch(link_poses_kernel, first_world=0)
            poses = self.arrays.state.bytes_of("link_pose")
            quick.set_detection_addresses(detector, find_poses, poses, self.status)

    def _detect(self, worlds: np.ndarray | None = None) -> None:
        if not self._detection_ready:
            self.load(self._detectors, self.detection_program)
            self._detection_ready = True
        self.run(self._detectors, worlds)

    def _short_of_room(self) -> np.ndarray:
        """The worlds whose arrays were too short."""
        if len(self.status) == 1 and self._first_status[STATUS] >= WELL:
            return _NONE
        return np.flatnonzero(self.status[:, STATUS] == OVERFLOW)

    def _grow(self, short: np.ndarray) -> None:
        """Make arrays longer as needed by some worlds."""
        pairs, contacts = self.status[short, PAIRS_WANTED], self.status[short, CONTACTS_WANTED]
        growth = 2.0 if self.arrays.world_count == 1 else _GROWTH_OF_MANY
        room = {"contact": int(contacts.max()), "overlap": int(pairs.max())}
        self.contact_arrays.contacts.reserve(room, growth)
        for workspace in self._workspaces:
            workspace.grow(int(pairs.max()), rows=bool(((pairs == 0) & (contacts == 0)).any()))
        self.growths += 1
        self.changed()

    def forget_neighbours(self) -> None:
        """Make new lists."""
        for it in self._workspaces:
            it.forget_neighbours()

    # For devices

    def take(self, value: Any) -> Any:
        """Convert a user's values for the engine; values on the device of the worlds stay there."""
        return value

    def table(self, struct: Any) -> ArrayTable:
        """A table that kernels can use together with those of the worlds."""
        return ArrayTable(struct)

    def _all_tables(self) -> list[ArrayTable]:
        """The tables whose structs kernels are given."""
        of_contacts = self.contact_arrays
        tables = [self.arrays.model, self.arrays.state, of_contacts.shapes.table, of_contacts.contacts]
        tables += [of_contacts.users, of_contacts.soft.table]
        for workspace in self._workspaces:
            tables += workspace.tables
        return tables

    def _make_status(self) -> np.ndarray:
        return self.arrays.state.numpy["status_entry"]

    def _make_workspaces(self, threads: int) -> list[Workspace]:
        return [Workspace() for _ in range(threads)]

    def _make_interpreters(self, due: np.ndarray) -> list[Stepper]:
        return self._runner.interpreters(self.status, due)

    def _make_task_interpreters(self) -> list[Stepper]:
        status, due = np.zeros_like(self.status), np.zeros(1, dtype=np.int32)
        return self._runner.interpreters(status, due)

    # Other tasks in all worlds

    def task(
        self, make_launches: Callable[[KernelStructs], list[Launch]], worlds_per_thread: int = 1
    ) -> Task:
        """A task that runs in all worlds when it is called.

        Args:
            make_launches: Makes its launches over a thread's structs; it is called again after arrays have
                moved. Each launch has an argument `first_world`.
            worlds_per_thread: Each further thread has to have so many worlds.
        """
        return Task(self, make_launches, self._make_task_interpreters(), worlds_per_thread)

    def steps_done(self, worlds: np.ndarray) -> np.ndarray:
        """Number of steps that some worlds have completed in the last call."""
        return self.status[worlds, STEPS_DONE]

    def activity_changed(self) -> None:
        """Include sleep and absence in steps if bodies are asleep or absent now, as in a restored world."""
        plan = self._plan or self._plan_before
        if plan is None:
            return
        sleeping = not plan.sleeping and can_sleep(self.arrays)
        if sleeping or (not plan.absent and any_absent(self.arrays)):
            self.changed()

    def load(self, interpreters: list[Stepper], program: Callable[[KernelStructs], Program]) -> None:
        """Give a program to the interpreter of each thread, over the structs of that thread."""
        self._load(interpreters, self._bind(), program)

    def _load(
        self,
        interpreters: list[Stepper],
        bound: list[KernelStructs],
        program: Callable[[KernelStructs], Program],
    ) -> None:
        self.contact_arrays.forget_order()
        self.forget_neighbours()
        for interpreter, structs in zip(interpreters, bound, strict=True):
            interpreter.load(program(structs))

    def run(self, interpreters: list[Stepper], worlds: np.ndarray | None = None, **scalars: int) -> None:
        """Run programs on some worlds, None for all; then restore the settings of a step of all."""
        self._runner.run(interpreters, worlds, **scalars)
