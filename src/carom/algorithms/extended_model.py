"""The equations of motion in extended coordinates: seven of the base, four of a spherical joint.

PyBullet's stable PD controller sees a body this way, and so do its inverse dynamics and mass matrix with
`flags=1`. Spatial vectors, angular above linear, are in joint frames: their origin at the joint, their
axes such that a hinge turns about z and a slider moves along x.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_nodes import ROOT_COORDINATES, Node, extended_nodes, skew
from carom.description.pose import Vector3
from carom.description.transform import NO_ROTATION, rotation_matrix
from carom.model.codes import JointCode

if TYPE_CHECKING:
    from carom.body import Body

_SUBSPACES = {
    JointCode.REVOLUTE: np.array([[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]).T,
    JointCode.PRISMATIC: np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]).T,
    JointCode.SPHERICAL: np.vstack([np.eye(3, 4), np.zeros((3, 4))]),
    JointCode.FIXED: np.zeros((6, 0)),
}


class ExtendedModel:
    """A tree of nodes at given coordinates.

    Attributes:
        nodes: Links and the joints that carry them, parents first; the first is the root.
        size: Number of coordinates.
    """

    def __init__(self, nodes: Sequence[Node], position: np.ndarray) -> None:
        """Places the nodes.

        Args:
            nodes: As `extended_nodes` makes them.
            position: Coordinates; quaternions (x, y, z, w).
        """
        self.nodes = nodes
        self.size = nodes[-1].first + nodes[-1].count
        self._inertias = np.array([node.inertia for node in nodes])
        self._transforms = _motion_transforms(nodes, position)
        self._to_root = np.array(rotation_matrix(tuple(position[3:7].tolist()))).T
        self._jacobians = self._make_jacobians()

    def mass_matrix(self) -> np.ndarray:
        """Mass matrix.

        Returns:
            (size, size); zeros for what does not move, the fourth coordinate of quaternions.
        """
        momenta = self._inertias @ self._jacobians
        return self._jacobians.reshape(-1, self.size).T @ momenta.reshape(-1, self.size)

    def bias_forces(self, rate: np.ndarray, gravity: Vector3) -> np.ndarray:
        """Forces of inertia and gravity at zero acceleration.

        Args:
            rate: Rates of the coordinates: of the base its linear and angular velocity in world axes and a
                zero; of a spherical joint its angular velocity and a zero.
            gravity: [m/s²].

        Returns:
            (size,).
        """
        velocities = self._jacobians @ rate
        joint_velocities = velocities.copy()
        for index, node in enumerate(self.nodes[1:], start=1):
            joint_velocities[index] -= self._transforms[index] @ velocities[node.parent]
        accelerations = _cross_motion(velocities, joint_velocities)
        # The rate of the root's motion subspace, with the world's angular velocity where the body's belongs:
        # so does PyBullet.
        accelerations[0, 3:] -= self._to_root @ gravity + np.cross(rate[3:6], self._to_root @ rate[:3])
        for index, node in enumerate(self.nodes[1:], start=1):
            accelerations[index] += self._transforms[index] @ accelerations[node.parent]
        motions = np.stack([velocities, accelerations], axis=2)
        momenta, forces = np.moveaxis(self._inertias @ motions, 2, 0)
        forces = forces + _cross_force(velocities, momenta)
        return self._jacobians.reshape(-1, self.size).T @ forces.ravel()

    def _make_jacobians(self) -> np.ndarray:
        """Velocity of each node, in its axes, by rate: (nodes, 6, size)."""
        jacobians = np.zeros((len(self.nodes), 6, self.size))
        jacobians[0, 3:, :3] = jacobians[0, :3, 3:6] = self._to_root
        for index, node in enumerate(self.nodes[1:], start=1):
            np.matmul(self._transforms[index], jacobians[node.parent], out=jacobians[index])
            jacobians[index, :, node.first : node.first + node.count] = _SUBSPACES[node.kind]
        return jacobians


def _motion_transforms(nodes: Sequence[Node], position: np.ndarray) -> np.ndarray:
    """What takes motions from the joint frame of the parent to that of the node, (nodes, 6, 6)."""
    turns, slides = [NO_ROTATION], np.zeros(len(nodes))
    for index, node in enumerate(nodes[1:], start=1):
        own = position[node.first : node.first + node.count].tolist()
        turn = NO_ROTATION
        if node.kind == JointCode.REVOLUTE:
            c, s = cos(own[0]), sin(own[0])
            turn = ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))
        elif node.kind == JointCode.SPHERICAL:
            turn = rotation_matrix((own[0], own[1], own[2], own[3]))
        elif node.kind == JointCode.PRISMATIC:
            slides[index] = own[0]
        turns.append(turn)
    placements = np.array([node.rotation for node in nodes])
    origins = np.array([node.origin for node in nodes]) + placements[:, :, 0] * slides[:, None]
    back = np.swapaxes(placements @ np.array(turns), 1, 2)
    transforms = np.zeros((len(nodes), 6, 6))
    transforms[:, :3, :3] = transforms[:, 3:, 3:] = back
    transforms[:, 3:, :3] = -back @ skew(origins)
    return transforms


def _cross_motion(v: np.ndarray, m: np.ndarray) -> np.ndarray:
    """Spatial vector product of motions, (nodes, 6)."""
    angular, linear = v[:, :3], v[:, 3:]
    result = np.empty_like(v)
    result[:, :3] = np.cross(angular, m[:, :3])
    result[:, 3:] = np.cross(linear, m[:, :3]) + np.cross(angular, m[:, 3:])
    return result


def _cross_force(v: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Spatial vector product of motions and forces, (nodes, 6)."""
    angular, linear = v[:, :3], v[:, 3:]
    result = np.empty_like(v)
    result[:, :3] = np.cross(angular, f[:, :3]) + np.cross(linear, f[:, 3:])
    result[:, 3:] = np.cross(angular, f[:, 3:])
    return result


def extended_mass_matrix(body: Body, positions: Sequence[float]) -> np.ndarray:
    """Mass matrix of a body in extended coordinates, ones for those that do not move anything.

    Args:
        body: The body.
        positions: Of a floating base position and quaternion first; of each joint one number, or the
            quaternion (x, y, z, w) of a spherical one.

    Returns:
        (n, n) over all extended coordinates, the base's seven first, of a fixed base as well.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    position = _with_base(body, positions, _base_pose(body))
    matrix = ExtendedModel(extended_nodes(body, as_pybullet=True), position).mass_matrix()
    diagonal = np.diag_indices_from(matrix)
    matrix[diagonal] = np.where(matrix[diagonal] == 0.0, 1.0, matrix[diagonal])
    return matrix


def extended_bias_forces(body: Body, positions: Sequence[float], velocities: Sequence[float]) -> np.ndarray:
    """Forces that keep a body at zero acceleration in extended coordinates.

    Args:
        body: The body.
        positions: As in `extended_mass_matrix`.
        velocities: As many: of a floating base linear and angular velocity and a number that does not
            matter; of a spherical joint its angular velocity and a number that does not matter.

    Returns:
        (n,) as in `extended_mass_matrix`.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    position = _with_base(body, positions, _base_pose(body))
    u = body.first_velocity
    angular, linear = body.world.velocity[u : u + 3], body.world.velocity[u + 3 : u + 6]
    rate = _with_base(body, velocities, np.concatenate([linear, angular, [0.0]]))
    model = ExtendedModel(extended_nodes(body, as_pybullet=True), position)
    return model.bias_forces(rate, body.world.parameters.gravity)


def _base_pose(body: Body) -> np.ndarray:
    return body.world.position[body.first_position : body.first_position + ROOT_COORDINATES]


def _with_base(body: Body, values: Sequence[float], of_fixed_base: np.ndarray) -> np.ndarray:
    """Extended coordinates; those of a fixed base are not among the values."""
    own = np.asarray(values, dtype=float)
    return np.concatenate([of_fixed_base, own]) if body.fixed_base else own
