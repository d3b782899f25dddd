"""Launches of the kernels that linearise a step, for a body after the other, then for all rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.sweeps import sweeps_of
from carom.engine.parameters import COMPLIANT, RIGID
from carom.engine.world_calls import WorldCalls
from carom.layouts.codes import BASE_POSITIONS, ConstraintKind, UserConstraintKind
from carom.layouts.linearization import (
    ALL_STAGES,
    COMPLIANT_LAW,
    EQUATIONS_STAGE,
    MIN_ROWS,
    RESUMED,
    RIGID_LAW,
    ROWS_OF_CONTACT,
    ROWS_STAGE,
    SWEPT_LAW,
)
from carom.layouts.mechanism import MechanismBatch
from carom.layouts.newton import JOINT_REGULAR
from carom.linearization.step_memory import StepMemory, places_for, step_space
from carom.native.kernels import motion_of_step_kernel, solution_of_step_kernel
from carom.native.launch import Launch
from carom.native.tables import put_array, put_zeros

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.body_core import BodyCore

_MAX_USER_ROWS = 6
_LAWS = {RIGID: RIGID_LAW, COMPLIANT: COMPLIANT_LAW}
_SINGLE_ROWS = (UserConstraintKind.GEAR, UserConstraintKind.COUPLING)
_GRAVITY = 3
_PARAMETERS = ("mass", "moment", "inertia", "armature")
# The structs of the mechanism of a body on each thread, and parameters that differ between worlds, or None.
Mechanisms = Callable[["BodyCore"], tuple[list[list[Any]], Any]]


def lone_mechanisms(body: BodyCore) -> tuple[list[list[Any]], Any]:
    """The mechanism of a body of a lone world."""
    return [sweeps_of(body).structs], None


class StepKernels:
    """Launches for the worlds of `copies`.

    Attributes:
        memory: What the kernels read and write.
    """

    def __init__(
        self,
        space: TangentSpace,
        inputs: Sequence[Input],
        copies: Copies,
        mechanisms: Mechanisms,
        threads: int,
    ) -> None:
        self._space, self._inputs, self._copies = space, inputs, copies
        self._mechanisms = mechanisms
        self._threads = threads
        self._calls = WorldCalls(threads) if threads > 1 or copies.count > 1 else None
        engine = copies.engine
        self._struct = step_space(space, inputs, {name: engine.arrays.used[name] for name in _COUNTED})
        users = engine.contact_arrays.user_count
        self._struct.users = users
        kinds = engine.contact_arrays.users.numpy["user_kind"][:users]
        singles = int(np.isin(kinds, _SINGLE_ROWS).sum())
        fixed_rows = _rows_of_joints(copies) + singles + _MAX_USER_ROWS * (users - singles)
        self._struct.most_of_joints = fixed_rows
        self._fixed_rows = max(fixed_rows, MIN_ROWS)
        self._contacts = 0
        self._made_for: list[Any] = []
        self._settings: Any = None
        self._known_settings = b""
        self._known: tuple[float, str] | None = None
        # Launches of each thread: of all bodies, and of the rows.
        self._motion: list[list[Launch]] = []
        self._solution: list[Launch] = []
        self.memory: StepMemory | None = None

    def suit(self, space: TangentSpace, inputs: Sequence[Input], copies: Copies) -> bool:
        """Whether they are for these."""
        return self._space is space and self._copies is copies and self._inputs == inputs

    def prepare(self, worlds: int, contacts: int, smoothing: float, law: str) -> StepMemory:
        """Make launches for at most so many worlds at a time and contacts in one, under a law of contacts.

        Returns:
            The memory, whose places may be fewer.
        """
        if self.memory is None or contacts > self._contacts:
            self._contacts = 2 * contacts
            self._struct.most_contacts = self._contacts
            self._struct.most_rows = self._fixed_rows + ROWS_OF_CONTACT * self._contacts
            self.memory = None
        self._struct.smoothing = smoothing
        self._struct.law = _LAWS.get(law, SWEPT_LAW)
        self._struct.regular = 0.0 if self._struct.law == SWEPT_LAW else JOINT_REGULAR
        places = places_for(self._struct, worlds)
        if self.memory is None or self.memory.places < places:
            self.memory = StepMemory(self._struct, places)
            self._made_for = []
        self._renew(self.memory)
        if (smoothing, law) != self._known:
            self._known = smoothing, law
            self._replace("space", self._struct)
        settings = bytes(self._settings)
        if settings != self._known_settings:
            self._known_settings = settings
            self._replace("settings", self._settings)
        return self.memory

    def _replace(self, name: str, struct: Any) -> None:
        for launch in (*self._solution, *(it for own in self._motion for it in own)):
            launch.replace(launch.kernel.indices[name], struct)

    def _renew(self, memory: StepMemory) -> None:
        """Make the launches if arrays have moved, or parameters of bodies have changed."""
        engine = self._copies.engine
        bodies = [self._mechanisms(body) for body in self._space.bodies]
        tables = (
            *(engine.arrays.state, engine.arrays.model),
            *(engine.contact_arrays.users, engine.contact_arrays.shapes.table),
            *(engine.contact_arrays.contacts, engine.workspace.scratch, engine.workspace.pair_rows),
        )
        now: list[Any] = [engine.changes, *(table.replacements for table in tables)]
        for structs, varied in bodies:
            now += [struct for own in structs for struct in own]
            now.append(varied)
        if now == self._made_for:
            return
        self._made_for = now
        shared = engine.structs()
        given = [shared[name] for name in ("settings", "model", "state", "scratch")]
        of_memory = [self._struct, memory.batch]
        self._settings = shared["settings"]
        self._known_settings = bytes(self._settings)
        self._motion = [[] for _ in range(self._threads)]
        for body, (first, size), (structs, varied) in zip(
            self._space.bodies, self._space.places, bodies, strict=True
        ):
            batch = _batch(body, size, memory.places, varied)
            numbers = [first, body.first_position, int(varied is not None), 0]
            for launches, own in zip(self._motion, structs, strict=True):
                launches.append(Launch(motion_of_step_kernel, 1, [*own, batch, *given, *of_memory, *numbers]))
        touching = [shared[name] for name in ("users", "shapes", "contacts", "pair_rows")]
        self._solution = [
            Launch(solution_of_step_kernel, 1, [*given, *touching, *of_memory, ALL_STAGES, 0])
            for _ in range(self._threads)
        ]

    def make_motions(self, count: int) -> None:
        """Make room for the measured motions of so many contacts."""
        assert self.memory is not None
        if self.memory.make_motions(count):
            self._replace("steps", self.memory.batch)

    def find_motion(self, count: int) -> None:
        """Linearise the motion of the bodies in the first `count` places."""
        self._run(count, self._motion)

    def add_rows(self, count: int) -> None:
        """Add the rows of contacts, joints and ties."""
        self._solve(count, ROWS_STAGE)

    def add_given_rows(self, count: int) -> None:
        """As `add_rows`, with impulses of contacts as they are in `row_asked`."""
        self._struct.is_given = 1
        self._replace("space", self._struct)
        try:
            self._solve(count, ROWS_STAGE)
        finally:
            self._struct.is_given = 0
            self._replace("space", self._struct)

    def finish(self, count: int) -> None:
        """Find the derivatives; all rows are there."""
        self._solve(count, EQUATIONS_STAGE)

    def solve(self, count: int) -> None:
        """Both."""
        self._solve(count, ALL_STAGES)

    def find(self, count: int) -> None:
        """Linearise the motion of the bodies in the first `count` places, and solve."""
        self._run(count, [[*motion, it] for motion, it in zip(self._motion, self._solution, strict=True)])

    def resume(self, place: int) -> None:
        """Find the derivatives of a place whose equations have been solved."""
        launch, indices = self._solution[0], solution_of_step_kernel.indices
        for name, number in (("stage", RESUMED), ("first_world", place)):
            launch.replace(indices[name], number)
        launch()
        for name in ("stage", "first_world"):
            launch.replace(indices[name], 0)

    def _solve(self, count: int, stage: int) -> None:
        index = solution_of_step_kernel.indices["stage"]
        for launch in self._solution:
            launch.replace(index, stage)
        self._run(count, [[it] for it in self._solution])
        for launch in self._solution:
            launch.replace(index, ALL_STAGES)

    def _run(self, count: int, launches: list[list[Launch]]) -> None:
        if self._calls is not None:
            self._calls.run(count, launches)
            return
        for launch in launches[0]:
            launch()


_COUNTED = ("constraint", "actuator", "link")


def _rows_of_joints(copies: Copies) -> int:
    """At most so many rows are those of joints, motors of spherical joints included."""
    arrays = copies.engine.arrays
    model, count = arrays.model.numpy, arrays.used["constraint"]
    kinds, links = model["constraint_kind"][:count], model["constraint_link"][:count]
    return int(model["link_dof_count"][links[kinds != ConstraintKind.USER]].sum())


def _batch(body: BodyCore, dofs: int, places: int, varied: Any) -> Any:
    """Questions and answers about a body in so many places, two in each."""
    batch: Any = MechanismBatch()
    length = _GRAVITY + BASE_POSITIONS + sum(body.position_count) + 2 * dofs
    put_zeros(batch, "question", 2 * places * length)
    put_zeros(batch, "answer", 6 * places * dofs * dofs)
    for name in _PARAMETERS:
        if varied is None:
            put_zeros(batch, name, 0)
        else:
            put_array(batch, name, getattr(varied, name))
    return batch
