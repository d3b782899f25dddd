"""Questions to the kernels of derivatives, momenta and motions of links, about a body of a lone world."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.algorithms.mechanism import Mechanism, mechanism_of
from carom.algorithms.nodes import End, body_nodes
from carom.algorithms.not_finite import not_finite
from carom.checks import vector
from carom.description.transform import rotation_matrix
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import MechanismBatch, SweepTable
from carom.model.body_spec import BASE
from carom.native.kernel_builtins import Asked, Asker, asker
from carom.native.kernels import Kernel
from carom.native.launch import Launch
from carom.native.products import dots, product
from carom.native.tables import ArrayTable, put_zeros

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray
Views = Callable[[np.ndarray, "Sweeps"], Sequence[np.ndarray]]
"""Arrays of which copies are returned: views of an answer."""


def sweep_table(body: BodyCore, mechanism: Mechanism, ends: Sequence[End]) -> Any:
    """The workspace of a mechanism of a body, whose links are `ends`, with frames of its links."""
    table = ArrayTable(SweepTable)
    nodes = mechanism.structs[0].nodes
    dofs = mechanism.dofs
    table.reserve({"subtree": nodes, "dof": dofs, "link": len(ends), "matrix": dofs * dofs})
    arrays, of_nodes = table.numpy, mechanism.arrays
    # The last dof of each node, or of its nearest ancestor with one.
    last = [-1] * nodes
    for node in range(nodes):
        parent, count = int(of_nodes["node_parent"][node]), int(of_nodes["node_dof_count"][node])
        before = last[parent] if node > 0 else -1
        first = int(of_nodes["node_first_dof"][node])
        for dof in range(first, first + count):
            arrays["dof_parent"][dof] = before
            before = dof
        last[node] = before
    for index, end in enumerate(ends):
        frame = body.link_inertial_frame(index - 1)
        turn = product(end.rotation, np.array(rotation_matrix(frame.orientation)).T)
        arrays["link_node"][index] = end.node
        arrays["link_turn"][index] = turn
        # The origin of the base's end is its centre of mass, that of other ends the link frame's.
        to_origin = dots(turn, np.array(frame.position)) if index == 0 else np.zeros(3)
        arrays["link_origin"][index] = end.origin - to_origin
    return table.struct()


class _Launched(NamedTuple):
    """The memory of a question and of its answer, the kernel, and how to run it."""

    question: np.ndarray
    answer: np.ndarray
    launch: Launch
    run: Callable[[], None]


class Sweeps:
    """Memory for questions about a body, and the launches of the kernels that answer them.

    Attributes:
        dofs: Number of velocity coordinates, those of a free base included.
        links: Number of links, the base included.
        structs: The structs of the mechanism, that of sweeps last.
    """

    def __init__(self, body: BodyCore) -> None:
        self._body = body
        self._mechanism = mechanism_of(body)
        self._ends = body_nodes(body)[1]
        self.dofs: int = self._mechanism.dofs
        self.links: int = len(self._ends)
        self._given: int = self._mechanism.coordinates + (BASE_POSITIONS if self._mechanism.free else 0)
        self._table: Any = sweep_table(body, self._mechanism, self._ends)
        self.structs: list[Any] = [*self._mechanism.structs, self._table]
        self._length = 3 + BASE_POSITIONS + self._mechanism.coordinates + 2 * self.dofs
        self._launches: dict[Any, _Launched] = {}

    def ask(
        self,
        kernel: Kernel,
        size: int,
        *numbers: int,
        positions: Numbers,
        velocities: Numbers | None = None,
        changes: Numbers | None = None,
    ) -> np.ndarray:
        """The answer of a kernel, (size,), a new array.

        Args:
            kernel: The kernel.
            size: Length of the answer.
            numbers: The kernel's numbers between its structs and `first_world`.
            positions: Joint positions, for a free body after position and quaternion of the base.
            velocities: Velocities (dofs,); 0 by default.
            changes: Accelerations or forces (dofs,); 0 by default.

        Raises:
            ValueError: A length is wrong, a number is not finite, the base's quaternion is 0, or the answer
                is not finite.
        """
        body = self._body
        first = body.first_position
        placed = vector(positions, self._given, "positions")
        if self._mechanism.free:
            if not placed[3:BASE_POSITIONS].any():
                raise ValueError("the quaternion of the base is 0")
        else:
            placed = np.concatenate([body.world.position[first : first + BASE_POSITIONS], placed])
        none = np.zeros(self.dofs)
        rates = none if velocities is None else vector(velocities, self.dofs, "velocities")
        changed = none if changes is None else vector(changes, self.dofs, "accelerations or forces")
        if size == 0:
            return np.zeros(0)
        question, answer, _, run = self._launched(kernel, size, numbers)
        np.concatenate([body.world.parameters.gravity, placed, rates, changed], out=question)
        # Kernels do not write entries that are always 0.
        answer.fill(0.0)
        run()
        if answer[0] != answer[0]:
            raise not_finite(body, placed[0 if self._mechanism.free else BASE_POSITIONS :], rates, changed)
        return answer.copy()

    def answers(self, kernel: Kernel, size: int, *numbers: int, questions: np.ndarray) -> np.ndarray:
        """The answers (k, size) of a kernel to questions (k, numbers) as it reads them, a new array.

        Args:
            kernel: The kernel.
            size: Length of an answer.
            numbers: As in `ask`.
            questions: Gravity, pose of the base, joint positions, velocities, accelerations or forces.

        Raises:
            ValueError: An answer is not finite.
        """
        count = len(questions)
        question, answer, _, run = self._launched(kernel, size, numbers, count)
        question[:] = questions.ravel()
        answer.fill(0.0)
        run()
        found = answer.reshape(count, size).copy()
        if size and np.isnan(found[:, 0]).any():
            raise ValueError("the answer is not finite")
        return found

    def asker(self, kernel: Kernel, size: int, *numbers: int, views: Views) -> Asker:
        """The function that asks a kernel natively, if it can; see `carom.native.kernel_builtins`.

        Its arguments are gravity, pose of the base if that is fixed, and the last three of `ask`, which has
        the others.
        """
        question, answer, launch, _ = self._launched(kernel, size, numbers)
        free = self._mechanism.free
        ends = np.cumsum([3, 0 if free else int(BASE_POSITIONS), self._given, self.dofs])
        gravity, held, *stated = np.split(question, ends)
        parts = [Asked(gravity), Asked(held, is_required=not free)]
        parts += [Asked(part, is_required=place == 0) for place, part in enumerate(stated)]
        turn = question[6:10] if free else None
        return asker(self._body.world.call_lock, launch, parts, answer, views(answer, self), turn)

    def pose_asker(self, kernel: Kernel, size: int, shape: tuple[int, ...]) -> Asker:
        """The same for a kernel about positions, with the number of links: for pose and joint positions."""
        question, answer, launch, _ = self._launched(kernel, size, (self.links,))
        _, pose, joints, _ = np.split(question, np.cumsum([3, BASE_POSITIONS, self._mechanism.coordinates]))
        lock, view = self._body.world.call_lock, answer.reshape(shape)
        return asker(lock, launch, [Asked(pose), Asked(joints)], answer, [view], pose[3:])

    def _launched(self, kernel: Kernel, size: int, numbers: tuple[int, ...], count: int = 1) -> _Launched:
        known = self._launches.get((kernel, numbers, count))
        if known is None:
            batch: Any = MechanismBatch()
            question = put_zeros(batch, "question", count * self._length)
            answer = put_zeros(batch, "answer", count * size)
            for name in ("mass", "moment", "inertia", "armature"):
                put_zeros(batch, name, 0)
            launch = Launch(kernel, count, [*self.structs, batch, *numbers, 0])
            known = _Launched(question, answer, launch, launch.brief_function)
            self._launches[kernel, numbers, count] = known
        return known


def sweeps_of(body: BodyCore) -> Sweeps:
    """Questions about a body as it is now; cached until masses, inertias or the base's fixation change."""
    sweeps = body.derived.get(Sweeps)
    if sweeps is None:
        sweeps = body.derived[Sweeps] = Sweeps(body)
    return sweeps


def link_numbers(body: BodyCore, links: Sequence[int] | None) -> list[int]:
    """Indices of links; all but the base by default. Raises `IndexError` if there is no such link."""
    chosen = list(range(body.joint_count)) if links is None else list(links)
    for link in chosen:
        if not BASE <= link < body.joint_count:
            raise IndexError(
                f"there is no link {link}: {body.name!r} has links {BASE} to {body.joint_count - 1}"
            )
    return chosen
