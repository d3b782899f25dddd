"""The tangent space of the states of a world: names, moving along it, and differences."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import BALLS, BASE_POSITIONS, BASE_VELOCITIES, JOINTS, PLANES, UNFILTERED, JointCode
from carom.layouts.linearization import BALL_DOF, BASE_DOF, PLANE_DOF, SCALAR_DOF
from carom.linearization.turns import (
    cross,
    inverse,
    left_derivative,
    multiplied,
    quaternion_of,
    vector_of,
)

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

_AXES = "xyz"
_QUATERNION = ("qx", "qy", "qz", "qw")
# Quaternions are made unit if their squared norm is off by more: those of steps stay as they are.
_UNIT = 1e-12


class TangentSpace:
    """Small changes of positions: one number for each velocity, the motion in a unit of time with it.

    For a free base they are a rotation vector [rad] and a displacement [m] of its inertial frame, in world
    axes, in the order of `World.velocity`; for a spherical joint a rotation vector along the axes of its
    link; for a planar joint the angle, and displacements along the axes of its link; for others the change of
    the position. Bases that are fixed have none.

    Attributes:
        bodies: The bodies that can move.
        places: First dof and number of dofs of each of these.
        dofs: Rows of `World.velocity` of all dofs, (n,).
        labels: Names of the dofs in two parts: that of the joint or base, and which one of it, such as "x".
        actuators: Names of the actuators with activations.
        activations: Their rows in the arrays of actuators, (a,).
        trees: The tree of each dof, (n,).
        places_in_tree: Its place among the dofs of the tree, (n,).
        coordinates: Number of all coordinates, and length of `World.position`, which may have spare rows.
        rates: Likewise of `World.velocity`.
        coordinate_rows: Rows of `World.position` of the coordinates that can change, (c,): seven of a free
            base, (x, y, z) [m] and a quaternion (x, y, z, w), four of a spherical joint, and so on.
        coordinate_names: Their names.
        dof_of_row: The dofs by their rows of `World.velocity`.
        several: The dofs of joints with several positions, and of bases.
        column_of_actuator: The columns of activations by rows of actuators.
        bases, balls: First row of positions and first dof of each free base, and of each spherical joint.
        planes: Likewise of planar joints, and the sign of the turn from their first axis to the second.
    """

    def __init__(self, world: WorldCore, bodies: Iterable[BodyCore] | None = None) -> None:
        """Set up the tangent space of a world, or the part of some bodies."""
        self.bodies: list[BodyCore] = []
        self.places: list[tuple[int, int]] = []
        rows: list[int] = []
        labels: list[tuple[str, str]] = []
        # Pairs of a row of positions and a dof, for each kind of coordinates.
        self._scalars: list[tuple[int, int]] = []
        self.bases: list[tuple[int, int]] = []
        self.balls: list[tuple[int, int]] = []
        self.planes: list[tuple[int, int, float]] = []
        self.actuators: list[str] = []
        active: list[int] = []
        self.coordinate_names: list[str] = []
        moving: list[int] = []
        for body in world.bodies.values() if bodies is None else bodies:
            label, first = body_label(world, body), len(rows)
            if not body.fixed_base:
                self.bases.append((body.first_position, len(rows)))
                moving += range(body.first_position, body.first_position + BASE_POSITIONS)
                self.coordinate_names += [f"{label}.base.{end}" for end in (*_AXES, *_QUATERNION)]
                rows += range(body.first_velocity, body.first_velocity + BASE_VELOCITIES)
                labels += [
                    (f"{label}.base", f"{kind}.{axis}") for kind in ("turn", "shift") for axis in _AXES
                ]
            for joint, kind in enumerate(body.joint_types):
                count, position = body.velocity_count[joint], body.position_index[joint]
                if not count:
                    continue
                if kind in BALLS:
                    self.balls.append((position, len(rows)))
                elif kind in PLANES:
                    link = body.first_link + 1 + joint
                    model = world.arrays.model.numpy
                    axis, first_axis, second_axis = (
                        model[name][link]
                        for name in ("link_unit_axis", "link_planar_axis1", "link_planar_axis2")
                    )
                    hand = float(np.sign(cross(axis, first_axis) @ second_axis))
                    self.planes.append((position, len(rows), hand))
                else:
                    self._scalars.append((position, len(rows)))
                rows += range(body.velocity_index[joint], body.velocity_index[joint] + count)
                moving += range(position, position + body.position_count[joint])
                name = f"{label}.{body.spec.links[joint].joint_name}"
                parts = JOINTS[JointCode(kind)].coordinates
                self.coordinate_names += [f"{name}.{end}" for end in parts] if parts else [name]
                ends = _AXES[:count] if count > 1 else ("",)
                labels += [(f"{label}.{body.spec.links[joint].joint_name}", end) for end in ends]
            row = body.rows.first.get("actuator", 0)
            for index, actuator in enumerate(body.spec.actuators):
                if world.arrays.model.numpy["actuator_dynamics"][row + index] != UNFILTERED:
                    active.append(row + index)
                    self.actuators.append(f"{label}.{actuator.name}")
            if len(rows) > first:
                self.bodies.append(body)
                self.places.append((first, len(rows) - first))
        self.dofs: np.ndarray = np.array(rows, dtype=np.int64)
        self.coordinate_rows: np.ndarray = np.array(moving, dtype=np.int64)
        self.labels: list[tuple[str, str]] = labels
        self.activations: np.ndarray = np.array(active, dtype=np.int64)
        used = world.arrays.used
        self.coordinates: tuple[int, int] = used["position"], len(world.position)
        self.rates: tuple[int, int] = used["dof"], len(world.velocity)
        sizes = [size for _, size in self.places]
        self.trees: np.ndarray = np.repeat(
            np.array([body.rows.tree for body in self.bodies], dtype=np.int64), sizes
        )
        self.places_in_tree: np.ndarray = np.concatenate(
            [np.arange(size) for size in sizes] or [np.zeros(0, dtype=np.int64)]
        )
        self.dof_of_row: dict[int, int] = {row: dof for dof, row in enumerate(rows)}
        self.column_of_actuator: dict[int, int] = {row: column for column, row in enumerate(active)}
        self._positions = np.array([row for row, _ in self._scalars], dtype=np.int64)
        self._columns = np.array([dof for _, dof in self._scalars], dtype=np.int64)
        self.several: np.ndarray = np.setdiff1d(np.arange(len(rows)), self._columns)

    def __len__(self) -> int:
        return len(self.dofs)

    def firsts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of each dof its row of positions (-1 if it has none), what it is the first of, and a plane's hand.

        The second are codes of `carom.layouts.linearization`.
        """
        positions, kinds, hands = np.full(len(self), -1), np.full(len(self), SCALAR_DOF), np.zeros(len(self))
        positions[self._columns] = self._positions
        for kind, joints in ((BASE_DOF, self.bases), (BALL_DOF, self.balls)):
            for _, dof in joints:
                kinds[dof] = kind
        for _, dof, hand in self.planes:
            kinds[dof], hands[dof] = PLANE_DOF, hand
        return positions, kinds, hands

    def moved(self, positions: np.ndarray, changes: np.ndarray) -> np.ndarray:
        """Positions (m, coordinates) moved by changes (m, n): a new array."""
        after = positions.copy()
        after[:, self._positions] += changes[:, self._columns]
        for q, dof in self.bases:
            turn = quaternion_of(changes[:, dof : dof + 3])
            after[:, q : q + 3] += changes[:, dof + 3 : dof + 6]
            after[:, q + 3 : q + BASE_POSITIONS] = multiplied(turn, positions[:, q + 3 : q + BASE_POSITIONS])
        for q, dof in self.balls:
            turn = quaternion_of(changes[:, dof : dof + 3])
            after[:, q : q + 4] = multiplied(positions[:, q : q + 4], turn)
        for q, dof, hand in self.planes:
            for world in range(len(after)):
                turn = _plane_turn(hand * positions[world, q])
                after[world, q] += changes[world, dof]
                after[world, q + 1 : q + 3] += turn @ changes[world, dof + 1 : dof + 3]
        return after

    def difference(self, positions: np.ndarray, others: np.ndarray) -> np.ndarray:
        """The changes (m, n) that lead from `others` (m, coordinates) to `positions`."""
        changes = np.zeros((len(positions), len(self)))
        changes[:, self._columns] = positions[:, self._positions] - others[:, self._positions]
        for q, dof in self.bases:
            turn = multiplied(positions[:, q + 3 : q + 7], inverse(others[:, q + 3 : q + 7]))
            changes[:, dof : dof + 3] = vector_of(turn)
            changes[:, dof + 3 : dof + 6] = positions[:, q : q + 3] - others[:, q : q + 3]
        for q, dof in self.balls:
            turn = multiplied(inverse(others[:, q : q + 4]), positions[:, q : q + 4])
            changes[:, dof : dof + 3] = vector_of(turn)
        for q, dof, hand in self.planes:
            change = positions[:, q : q + 3] - others[:, q : q + 3]
            changes[:, dof] = change[:, 0]
            for world in range(len(changes)):
                angle = 0.5 * hand * (positions[world, q] + others[world, q])
                changes[world, dof + 1 : dof + 3] = _plane_turn(angle).T @ change[world, 1:]
        return changes

    def with_unit_quaternions(self, positions: np.ndarray) -> np.ndarray:
        """Positions (m, coordinates) whose quaternions have a norm of 1.

        Raises:
            ValueError: A quaternion is 0.
        """
        for q in (*(q + 3 for q, _ in self.bases), *(q for q, _ in self.balls)):
            own = positions[:, q : q + 4]
            squares = (own * own).sum(axis=1, keepdims=True)
            if not squares.all():
                raise ValueError("a quaternion is 0, so it is no orientation")
            if (np.abs(squares - 1.0) > _UNIT).any():
                positions = positions.copy()
                positions[:, q : q + 4] = np.where(np.abs(squares - 1.0) > _UNIT, own / np.sqrt(squares), own)
        return positions

    def of_changes(self, positions: np.ndarray, gradients: np.ndarray) -> np.ndarray:
        """Gradients (m, n) by changes of positions, of gradients (m, coordinates) by their coordinates.

        Args:
            positions: The positions, (m, coordinates), with unit quaternions.
            gradients: The gradients there.
        """
        found = np.zeros((len(positions), len(self)))
        found[:, self._columns] = gradients[:, self._positions]
        for q, dof in self.bases:
            own = slice(q + 3, q + BASE_POSITIONS)
            turned = multiplied(gradients[:, own], inverse(positions[:, own]))
            found[:, dof : dof + 3] = 0.5 * turned[:, :3]
            found[:, dof + 3 : dof + 6] = gradients[:, q : q + 3]
        for q, dof in self.balls:
            own = slice(q, q + 4)
            turned = multiplied(inverse(positions[:, own]), gradients[:, own])
            found[:, dof : dof + 3] = 0.5 * turned[:, :3]
        for q, dof, hand in self.planes:
            found[:, dof] = gradients[:, q]
            for world in range(len(found)):
                turn = _plane_turn(hand * positions[world, q])
                found[world, dof + 1 : dof + 3] = gradients[world, q + 1 : q + 3] @ turn
        return found

    def of_coordinates(self, positions: np.ndarray, gradients: np.ndarray) -> np.ndarray:
        """Gradients (m, coordinates) by coordinates, of gradients (m, n) by changes of positions.

        Those by a quaternion are those of the unit quaternion that it is made into.

        Args:
            positions: The positions, (m, coordinates); quaternions may have any norm but 0.
            gradients: The gradients there.
        """
        found = np.zeros(positions.shape)
        found[:, self._positions] = gradients[:, self._columns]
        for q, dof in self.bases:
            own = slice(q + 3, q + BASE_POSITIONS)
            turn = _pure(gradients[:, dof : dof + 3])
            found[:, own] = multiplied(turn, _twice_over_square(positions[:, own]))
            found[:, q : q + 3] = gradients[:, dof + 3 : dof + 6]
        for q, dof in self.balls:
            own = slice(q, q + 4)
            turn = _pure(gradients[:, dof : dof + 3])
            found[:, own] = multiplied(_twice_over_square(positions[:, own]), turn)
        for q, dof, hand in self.planes:
            found[:, q] = gradients[:, dof]
            for world in range(len(found)):
                turn = _plane_turn(hand * positions[world, q])
                found[world, q + 1 : q + 3] = turn @ gradients[world, dof + 1 : dof + 3]
        return found

    def stretch(self, positions: np.ndarray, rest: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """By how much springs of joints are stretched (n,), and the derivatives by changes, (n, n).

        Args:
            positions: Positions of all coordinates.
            rest: Positions of the springs, likewise.
        """
        found, by_position = np.zeros(len(self)), np.zeros((len(self), len(self)))
        found[self._columns] = positions[self._positions] - rest[self._positions]
        by_position[self._columns, self._columns] = 1.0
        for q, dof in self.balls:
            own = slice(dof, dof + 3)
            turned = multiplied(inverse(rest[q : q + 4]), positions[q : q + 4])
            found[own] = vector_of(turned)
            by_position[own, own] = np.linalg.inv(left_derivative(-found[own]))
        for q, dof, hand in self.planes:
            own = slice(dof + 1, dof + 3)
            change = positions[q : q + 3] - rest[q : q + 3]
            found[dof] = change[0]
            by_position[dof, dof] = 1.0
            found[own] = _plane_turn(hand * positions[q]).T @ change[1:]
            by_position[own, own] = np.eye(2)
            by_position[own, dof] = -hand * np.array([-found[dof + 2], found[dof + 1]])
        return found, by_position


def _pure(vectors: np.ndarray) -> np.ndarray:
    """Quaternions (m, 4) with these vectors (m, 3) and the scalar 0."""
    return np.concatenate([vectors, np.zeros((len(vectors), 1))], axis=1)


def _twice_over_square(quaternions: np.ndarray) -> np.ndarray:
    """Quaternions (m, 4), twice and divided by the squares of their norms."""
    return 2.0 * quaternions / (quaternions * quaternions).sum(axis=1, keepdims=True)


def _plane_turn(angle: float) -> np.ndarray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def body_label(world: WorldCore, body: BodyCore) -> str:
    """Name of a body, with its number if another has the same name."""
    same = [other for other in world.bodies.values() if other.name == body.name]
    return body.name if len(same) == 1 else f"{body.name}[{body.id}]"
