"""A body's equations of motion, prepared for many calls with different coordinates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate
from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.ask import Ask, asking
from carom.algorithms.joints import has_long_axis
from carom.algorithms.nodes import End, Node, body_nodes
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES, POSITION_COUNT
from carom.layouts.mechanism import BASE_MOTION, POSE, MechanismSizes, MechanismTable
from carom.native.kernel_builtins import Asked, Asker, asker
from carom.native.kernels import (
    Kernel,
    inverse_dynamics_kernel,
    jacobian_kernel,
    mass_matrix_kernel,
    motion_kernel,
)
from carom.native.launch import Launch
from carom.native.made_once import made_once
from carom.native.tables import NUMPY_REAL, ArrayTable, array_view, numbers_of, writer_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Rows = tuple[tuple[float, ...], ...]
Numbers = Sequence[float] | np.ndarray

_TYPE_CODE = np.dtype(NUMPY_REAL).char
_JACOBIAN_ROWS = 6


class Mechanism:
    """A mechanism of nodes, with memory for a query and its answer.

    All quantities are in the frame of the base. Items of sequences may be anything that `float` accepts;
    other items, or a sequence of the wrong length, raise `struct.error`.

    Attributes:
        free: The base moves.
        coordinates: Number of joint positions; a spherical joint has a quaternion.
        joint_dofs: Number of joint rates.
        dofs: Number of all rates: those of a free base, three angular and three linear, come first.
        structs: The arguments of kernels: sizes and arrays.
        arrays: The arrays by name.
    """

    def __init__(self, nodes: Sequence[Node], ends: Sequence[End] = (), *, free: bool) -> None:
        """Set up nodes, parents first, and links for Jacobians, both beginning with the base."""
        self.free = free
        self.joint_dofs: int = sum(len(node.axes) for node in nodes)
        self.dofs: int = self.joint_dofs + (BASE_VELOCITIES if free else 0)
        self.coordinates: int = sum(POSITION_COUNT[node.kind] for node in nodes)
        sizes: Any = MechanismSizes()
        sizes.nodes = len(nodes)
        sizes.coordinates = self.coordinates
        sizes.dofs = self.dofs
        sizes.base_dofs = self.dofs - self.joint_dofs
        sizes.has_armature = any(node.armature for node in nodes)
        first_position = int(BASE_MOTION)
        first_rate = first_position + self.coordinates
        table = ArrayTable(MechanismTable)
        table.reserve(
            {
                "node": len(nodes),
                "motion": len(nodes),
                "dof": self.dofs,
                "axis": self.dofs,
                "end": len(ends),
                "input": first_rate + 2 * self.joint_dofs,
                "output": _JACOBIAN_ROWS * self.dofs,
                "matrix": self.dofs * self.dofs,
            }
        )
        self.arrays: dict[str, Any] = table.numpy
        self._write_nodes(nodes, free=free)
        self._write_ends(ends)
        self.structs: tuple[Any, Any] = (sizes, table.struct())
        self._jacobians: dict[int, Callable[[], None]] = {}
        self._links = range(-1, len(ends) - 1)
        question = self.arrays["input"][: first_rate + 2 * self.joint_dofs]
        self._put_base = writer_of(question[:first_position])
        self._put_point = writer_of(question[:3])
        self._put_positions = writer_of(question[first_position:first_rate])
        self._put_motion = writer_of(question[first_position:])
        self._positions = question[first_position:first_rate]
        square = self.arrays["matrix"][: self.dofs * self.dofs]
        self._square = square.reshape(self.dofs, self.dofs)
        self._row = Struct(f"{self.dofs}{_TYPE_CODE}")
        used = {"output": _JACOBIAN_ROWS * self.dofs, "matrix": self.dofs * self.dofs}
        self._output, self._matrix = (
            self.arrays[name].data[:count].cast("B") for name, count in used.items()
        )

    def set_base_motion(self, *motion: float) -> None:
        """Set the angular velocity, its derivative, and acceleration minus gravity, of the base."""
        self._put_base(*motion)

    def forces(self, positions: Numbers, rates: Numbers, accelerations: Numbers) -> tuple[float, ...]:
        """Generalized forces, (`dofs`,), that cause a motion; those of a free base are torque, then force.

        Positions of joints are (`coordinates`,), their rates and accelerations (`joint_dofs`,).

        Raises:
            ValueError: A number is not finite, the forces overflow, or a length is wrong.
        """
        if not (
            len(positions) == self.coordinates
            and len(rates) == self.joint_dofs
            and len(accelerations) == self.joint_dofs
        ):
            raise ValueError("the arguments do not fit the mechanism")
        self._put_motion(*positions, *rates, *accelerations)
        self._find_forces()
        forces = self._row.unpack_from(self._output)
        if forces and forces[0] != forces[0]:
            raise ValueError("the forces are not finite")
        return forces

    def mass_matrix(self, positions: Numbers) -> Rows:
        """Rows of the symmetric mass matrix, (`dofs`, `dofs`), at joint positions as in `forces`.

        Raises:
            ValueError: The entries overflow.
        """
        self._put_positions(*positions)
        self._find_mass_matrix()
        return _finite(self._rows(self._matrix), "mass matrix")

    def mass_matrix_array(self, positions: Numbers) -> np.ndarray:
        """The mass matrix as a new array, (`dofs`, `dofs`); otherwise as `mass_matrix`."""
        if len(positions) != self.coordinates:
            raise ValueError(f"the mechanism takes {self.coordinates} positions, not {len(positions)}")
        self._positions[:] = positions
        self._find_mass_matrix()
        matrix = self._square.copy()
        if self.dofs and matrix[0, 0] != matrix[0, 0]:
            raise ValueError("the mass matrix is not finite")
        return matrix

    def jacobian(self, link: int, point: Numbers, positions: Numbers) -> tuple[Rows, Rows]:
        """Linear and angular Jacobian of a point on a link (-1 is the base), each (3, `dofs`).

        The point is an offset from the link frame's origin, for the base from its centre of mass, along the
        axes of the inertial frame [m]; joint positions are (`coordinates`,). Raises `ValueError` if there is
        no such link, or the entries overflow.
        """
        self._find_jacobian(link, point, positions)
        rows = _finite(self._rows(self._output), "Jacobian")
        return rows[:3], rows[3:]

    def jacobian_matrix(self, link: int, point: Numbers, positions: Numbers) -> np.ndarray:
        """Both Jacobians in one array, the linear one first, (6, `dofs`); as `jacobian`."""
        self._find_jacobian(link, point, positions)
        count = _JACOBIAN_ROWS * self.dofs
        matrix = self.arrays["output"][:count].reshape(_JACOBIAN_ROWS, self.dofs).copy()
        if self.dofs and matrix[0, 0] != matrix[0, 0]:
            raise ValueError("the Jacobian is not finite")
        return matrix

    def mass_matrix_asker(self, lock: float) -> Asker:
        """The function that asks for the mass matrix natively; see `carom.native.kernel_builtins`."""
        return self._asker(
            lock, [self._positions], self._square.reshape(-1), [self._square], mass_matrix_kernel
        )

    def jacobian_asker(self, lock: float, link: int) -> Asker:
        """That for both Jacobians of a point on a link; its arguments are the point and joint positions."""
        answer = self.arrays["output"][: _JACOBIAN_ROWS * self.dofs]
        rows = answer.reshape(_JACOBIAN_ROWS, self.dofs)
        asked = [self.arrays["input"][:3], self._positions]
        return self._asker(
            lock, asked, answer, [rows[:3], rows[3:]], jacobian_kernel, self._links.index(link)
        )

    def _asker(
        self,
        lock: float,
        asked: Sequence[np.ndarray],
        answer: np.ndarray,
        views: Sequence[np.ndarray],
        kernel: Kernel,
        *numbers: int,
    ) -> Asker:
        launch = Launch(kernel, 1, [*self.structs, *numbers])
        return asker(lock, launch, [Asked(part) for part in asked], answer, views)

    def _find_jacobian(self, link: int, point: Numbers, positions: Numbers) -> None:
        find = self._jacobians.get(link)
        if find is None:
            end = self._links.index(link)
            find = self._jacobians[link] = self._launch(jacobian_kernel, end)
        self._put_point(*point)
        self._put_positions(*positions)
        find()

    @made_once
    def forces_of_motion(self) -> Ask:
        """The function that computes the forces of a motion."""
        return forces_of_motion(self)

    @made_once
    def motion_question(self) -> MotionQuestion:
        """The memory of `forces_of_motion` for arrays."""
        return MotionQuestion(self)

    @made_once
    def forces_in_pybullet(self) -> Ask:
        """The same with PyBullet's coordinates, and PyBullet's direction of gravity."""
        return forces_of_motion(self, as_pybullet=True)

    @made_once
    def _find_forces(self) -> Callable[[], None]:
        return self._launch(inverse_dynamics_kernel)

    @made_once
    def _find_mass_matrix(self) -> Callable[[], None]:
        return self._launch(mass_matrix_kernel)

    def _launch(self, kernel: Kernel, *arguments: int) -> Callable[[], None]:
        return Launch(kernel, 1, [*self.structs, *arguments]).brief_function

    def _rows(self, memory: memoryview) -> Rows:
        return tuple(self._row.iter_unpack(memory)) if self.dofs else ()

    def _write_nodes(self, nodes: Sequence[Node], *, free: bool) -> None:
        arrays = self.arrays
        position = dof = 0
        for index, node in enumerate(nodes):
            axes = node.axes
            if index == 0 and free:
                axes = np.zeros((BASE_VELOCITIES, 2, 3))
                axes[:3, 0] = axes[3:, 1] = np.eye(3)
            after = dof + len(axes)
            arrays["node_parent"][index] = node.parent
            arrays["node_joint_type"][index] = node.kind
            arrays["node_first_position"][index] = position
            arrays["node_first_dof"][index] = dof
            arrays["node_dof_count"][index] = len(axes)
            arrays["node_turn"][index] = node.rotation
            arrays["node_origin"][index] = node.origin
            arrays["node_mass"][index] = node.mass
            arrays["node_moment"][index] = node.moment
            arrays["node_inertia"][index] = node.inertia
            arrays["dof_angular"][dof:after] = axes[:, 0]
            arrays["dof_linear"][dof:after] = axes[:, 1]
            arrays["dof_armature"][dof:after] = node.armature
            position += POSITION_COUNT[node.kind]
            dof = after

    def _write_ends(self, ends: Sequence[End]) -> None:
        for index, end in enumerate(ends):
            self.arrays["end_node"][index] = end.node
            self.arrays["end_turn"][index] = end.rotation
            self.arrays["end_origin"][index] = end.origin


def _finite(rows: Rows, name: str) -> Rows:
    """The rows of a matrix, whose first entry is NaN if any is not finite; raises `ValueError` then."""
    if rows and rows[0][0] != rows[0][0]:
        raise ValueError(f"the {name} is not finite")
    return rows


def mechanism_of(body: BodyCore) -> Mechanism:
    """The mechanism of a body as it is now; cached until masses, inertias or the base's fixation change."""
    mechanism = body.derived.get(Mechanism)
    if mechanism is None:
        mechanism = body.derived[Mechanism] = Mechanism(*body_nodes(body), free=not body.fixed_base)
    return mechanism


def mechanism_in_pybullet(body: BodyCore) -> Mechanism:
    """The mechanism of a body as PyBullet's algorithms have it: with joint axes of length 1.

    Steps, there as here, use axes as long as they are given. Cached as in `mechanism_of`.
    """
    mechanism = body.derived.get(mechanism_in_pybullet)
    if mechanism is None:
        if any(has_long_axis(body, link) for link in range(body.joint_count)):
            mechanism = Mechanism(*body_nodes(body, unit_axes=True), free=not body.fixed_base)
        else:
            mechanism = mechanism_of(body)
        body.derived[mechanism_in_pybullet] = mechanism
    return mechanism


class MotionQuestion:
    """The generalized forces of motions of a mechanism as arrays, at minimum cost.

    Its arguments are those of the function that `forces_of_motion` makes, and its errors are `ValueError`.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        counts = _motion_counts(mechanism, as_pybullet=False)
        numbers: np.ndarray = np.zeros(sum(counts), dtype=NUMPY_REAL)
        firsts = [*accumulate(counts, initial=0)]
        parts = [numbers[first : first + count] for first, count in zip(firsts, counts, strict=False)]
        self._parts = parts
        self._gravity, self._positions, self._rates, self._accelerations = parts
        self._launch = Launch(motion_kernel, 1, [*mechanism.structs, array_view(numbers), 0])
        self._run = self._launch.brief_function
        self._forces = mechanism.arrays["output"][: mechanism.dofs]

    def forces(
        self, gravity: Numbers, positions: Numbers, rates: Numbers, accelerations: Numbers
    ) -> np.ndarray:
        """The forces, (`dofs`,), a new array."""
        self._gravity[:] = gravity
        self._positions[:] = positions
        self._rates[:] = rates
        self._accelerations[:] = accelerations
        self._run()
        forces = self._forces.copy()
        if forces[0] != forces[0]:
            raise ValueError("the answer is not finite")
        return forces

    def asker(self, lock: float) -> Asker:
        """The function that does the same natively; see `carom.native.kernel_builtins`."""
        return asker(lock, self._launch, [Asked(part) for part in self._parts], self._forces, [self._forces])


def _motion_counts(mechanism: Mechanism, *, as_pybullet: bool) -> tuple[int, int, int, int]:
    """Numbers of gravity, positions, rates and accelerations in a question of `motion_kernel`."""
    positions = mechanism.joint_dofs if as_pybullet else mechanism.coordinates
    base = BASE_POSITIONS if mechanism.free else 0
    return int(POSE), positions + base, mechanism.dofs, mechanism.dofs


def forces_of_motion(mechanism: Mechanism, *, as_pybullet: bool = False) -> Ask:
    """A function for the generalized forces of a motion of a mechanism, which has at least one dof.

    With `as_pybullet`, gravity at a free base has the wrong direction that it has in PyBullet, see
    `turned_back_in_opposite_order`; and positions of spherical joints are roll, pitch and yaw.

    Returns:
        A function of four arguments: gravity [m/s²], in world axes, or in axes of the base if that is fixed;
            joint positions, for a free base after its position (3) and quaternion (4); joint rates, for a
            free base after its angular (3) and linear (3) velocity in its own axes; and the derivatives of
            these rates. It returns the joint forces, for a free base after the force (3) and torque (3) on it
            in its own axes. It raises `ValueError` if a number is not finite, a sequence has the wrong
            length, the quaternion is zero, or the forces overflow; `TypeError` for an argument that is not a
            sequence; and `struct.error` for an item that is not a number.
    """
    counts = _motion_counts(mechanism, as_pybullet=as_pybullet)
    numbers: np.ndarray = np.zeros(sum(counts), dtype=NUMPY_REAL)
    launch = Launch(motion_kernel, 1, [*mechanism.structs, array_view(numbers), int(as_pybullet)])
    output = numbers_of(mechanism.arrays["output"])
    return asking(counts, numbers_of(numbers), launch.brief_function, output, mechanism.dofs)
