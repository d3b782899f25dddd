"""A configuration of a body, with kinematics in world axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms import centroidal_dynamics
from carom.algorithms.mechanism import mechanism_of
from carom.checks import Array, vector
from carom.description.pose import Vector3
from carom.description.transform import conjugate, multiplied, rotation_matrix
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.linearization.spatial import moving_dofs
from carom.linearization.tangent import TangentSpace
from carom.pose import Pose as WorldPose

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_ORIGIN = (0.0, 0.0, 0.0)
_MAX_KEPT = 256


class Configuration:
    """Positions of a body that can be changed without moving it, in a copy of its world.

    Velocities, and small changes of positions, are ordered as in `World.velocity`: of a free base, angular
    and linear velocity in world axes come before those of the joints.

    Attributes:
        world: The copy of the world.
        body: The body in the copy.
        dofs: Number n of velocity coordinates.
        base_dofs: How many of them are those of a free base: 6 or 0.
    """

    def __init__(self, body: Body) -> None:
        """Start in the present configuration of a body."""
        self.world: World = body.world.copy()
        self.body: Body = self.world.bodies[body.id]
        self._origin = body
        self._mechanism = mechanism_of(self.body)
        self.dofs: int = self._mechanism.dofs
        self.base_dofs: int = self.dofs - self._mechanism.joint_dofs
        first = self.body.first_position + (0 if self.base_dofs else BASE_POSITIONS)
        self._own = slice(first, self.body.first_position + BASE_POSITIONS + self._mechanism.coordinates)
        self._joints = slice(self.body.first_position + BASE_POSITIONS, self._own.stop)
        first_dof = self.body.first_velocity + (0 if self.base_dofs else BASE_VELOCITIES)
        self._dofs = slice(first_dof, first_dof + self.dofs)
        self._tangent = TangentSpace(self.world, [self.body])
        self._frames = [self.body.link_inertial_frame(link) for link in range(-1, self.body.joint_count)]
        self._to_link = [
            (np.array(rotation_matrix(frame.orientation)).T, np.array(frame.position))
            for frame in self._frames
        ]
        self._before: dict[int, set[int]] = {-1: {-1}}
        for link, spec in enumerate(self.body.spec.links):
            self._before[link] = {link, *self._before[spec.parent]}
        self._moves: np.ndarray = moving_dofs(self.body)
        self._known_tips: dict[tuple[int, ...], list[tuple[int, list[int]]]] = {}
        self._changed()

    @property
    def positions(self) -> Array:
        """Positions; for a free base, its position (3) and quaternion (4) come first. It may be set."""
        return self.world.position[self._own].copy()

    @positions.setter
    def positions(self, value: ArrayLike) -> None:
        count = self._own.stop - self._own.start
        self.world.position[self._own] = vector(value, count, "positions")
        self._changed()

    def follow(self, *, keep: bool = False) -> None:
        """Give all bodies of the copy the positions that they have in the world.

        Args:
            keep: Leave this body where it is, and let only the others follow.
        """
        positions, own = self._origin.world.position, self.world.position[self._own].copy()
        self.world.position[:] = positions
        if keep:
            self.world.position[self._own] = own
        self._changed()

    def integrate(self, velocities: np.ndarray, time: float) -> None:
        """Move with velocities (n,) for some time [s]."""
        moved = self._tangent.moved(self.world.position[None], time * velocities[None])
        self.world.position[:] = moved[0]
        self._changed()

    def difference(self, positions: ArrayLike) -> Array:
        """The small changes (n,) that lead to other positions."""
        wanted = vector(positions, self._own.stop - self._own.start, "positions")
        there = self.world.position.copy()
        there[self._own] = wanted
        return self._tangent.difference(there[None], self.world.position[None])[0]

    def link_pose(self, link: int | str) -> WorldPose:
        """World pose of a link frame: position [m], (3,), and quaternion (x, y, z, w).

        Args:
            link: Index of the link, -1 for the base, or its name.
        """
        number = self.link_number(link)
        frame = self._frames[number + 1]
        row = self.world.link_pose[self.body.first_link + 1 + number].tolist()
        turn = multiplied((row[3], row[4], row[5], row[6]), conjugate(frame.orientation))
        return WorldPose(self._pose(number)[1].copy(), np.array(turn))

    def link_rotation(self, link: int | str) -> Array:
        """Rotation matrix (3, 3) from the axes of a link frame to the world's; the link as in `link_pose`."""
        return self._pose(self.link_number(link))[0].copy()

    def link_number(self, link: int | str) -> int:
        """Index of a link that is given by its index or name; raises `KeyError` for an unknown name."""
        return self.body.links[link].index if isinstance(link, str) else link

    def joint_dofs(self, joint: int | str) -> list[int]:
        """The velocity coordinates of a joint, by its index or name."""
        number = self.body.joints[joint].index if isinstance(joint, str) else joint
        first = self.body.velocity_index[number] - self._dofs.start
        return list(range(first, first + self.body.velocity_count[number]))

    def jacobian(self, link: int | str, point: np.ndarray | None = None) -> Array:
        """The Jacobian (6, n) of a point that moves with a link, linear before angular, in world axes.

        Args:
            link: As in `link_pose`.
            point: The point in world axes [m], (3,); the origin of the link frame by default.
        """
        number = self.link_number(link)
        found = self._at_origin(number).copy()
        if point is not None:
            found[:3] += _arm(point - self._pose(number)[1]) @ found[3:]
        return found

    def approaches(
        self, links: Sequence[int], points: Sequence[Vector3], directions: Sequence[Vector3]
    ) -> np.ndarray:
        """Velocities of k points, each of a link and in a direction, per velocity, (k, n); in world axes."""
        found = np.zeros((len(links), self.dofs))
        for tip, rows in self._tips(tuple(links)):
            # Links before a tip move with the same dofs as it, up to their own.
            ox, oy, oz = self._pose(tip)[1].tolist()
            wrenches = []
            for row in rows:
                (px, py, pz), (x, y, z) = points[row], directions[row]
                rx, ry, rz = px - ox, py - oy, pz - oz
                wrenches.append((x, y, z, ry * z - rz * y, rz * x - rx * z, rx * y - ry * x))
            moved = self._moves[[links[row] + 1 for row in rows]]
            found[rows] = moved * (np.array(wrenches) @ self._at_origin(tip))
        return found

    def _tips(self, links: tuple[int, ...]) -> list[tuple[int, list[int]]]:
        """Links that no other follows, each with the places of links up to it."""
        known = self._known_tips.get(links)
        if known is None:
            tips: dict[int, list[int]] = {}
            for place in sorted(range(len(links)), key=lambda place: -links[place]):
                link = links[place]
                tip = next((tip for tip in tips if link in self._before[tip]), link)
                tips.setdefault(tip, []).append(place)
            if len(self._known_tips) >= _MAX_KEPT:
                self._known_tips.clear()
            known = self._known_tips[links] = list(tips.items())
        return known

    def center_of_mass(self) -> tuple[Array, Array]:
        """The centre of mass [m], (3,), and its Jacobian (3, n), in world axes."""
        answer = centroidal_dynamics(self.body, self.positions, np.zeros(self.dofs), np.zeros(self.dofs))
        jacobian = answer.jacobian_center_of_mass.copy()
        if self.base_dofs:
            turn = self._base_rotation.T
            jacobian[:, :3], jacobian[:, 3:6] = jacobian[:, :3] @ turn, jacobian[:, 3:6] @ turn
        return answer.center_of_mass, jacobian

    def scalar_joints(self) -> tuple[np.ndarray, np.ndarray, list[int]]:
        """Dofs and places in `positions` of revolute and prismatic joints, and these joints."""
        joints = [joint for joint, count in enumerate(self.body.velocity_count) if count == 1]
        dofs = [self.body.velocity_index[joint] - self._dofs.start for joint in joints]
        places = [self.body.position_index[joint] - self._own.start for joint in joints]
        return np.array(dofs, dtype=np.int64), np.array(places, dtype=np.int64), joints

    def _pose(self, link: int) -> tuple[np.ndarray, np.ndarray]:
        """Rotation matrix and origin of a link frame, the same arrays until positions change."""
        found = self._poses.get(link)
        if found is None:
            row = self.world.link_pose[self.body.first_link + 1 + link].tolist()
            turn, offset = self._to_link[link + 1]
            rotation = np.array(rotation_matrix((row[3], row[4], row[5], row[6]))) @ turn
            found = self._poses[link] = rotation, np.array(row[:3]) - rotation @ offset
        return found

    def _at_origin(self, link: int) -> np.ndarray:
        """The Jacobian of the origin of a link frame, the same array until positions change."""
        found = self._jacobians.get(link)
        if found is None:
            rotation = self._base_rotation
            own = self._mechanism.jacobian_matrix(link, _ORIGIN, self._joint_positions)
            found = (rotation @ own.reshape(2, 3, self.dofs)).reshape(6, self.dofs)
            if self.base_dofs:
                found[:, :3] = found[:, :3] @ rotation.T
                found[:, 3:6] = found[:, 3:6] @ rotation.T
            if link < 0:
                # The point on the base is its centre of mass.
                center = self.world.link_pose[self.body.first_link, :3]
                found[:3] += _arm(self._pose(link)[1] - center) @ found[3:]
            self._jacobians[link] = found
        return found

    def _changed(self) -> None:
        self.body.update_link_poses()
        self._poses: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._jacobians: dict[int, np.ndarray] = {}
        self._joint_positions: list[float] = self.world.position[self._joints].tolist()
        x, y, z, w = self.world.position[self.body.first_position + 3 : self.body.first_position + 7].tolist()
        self._base_rotation: Array = np.array(rotation_matrix((x, y, z, w)))


def _arm(offset: np.ndarray) -> np.ndarray:
    """The matrix of the velocity of a point at an offset (3,), by the angular velocity."""
    x, y, z = offset.tolist()
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
