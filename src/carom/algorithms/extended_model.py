"""The equations of motion in extended coordinates: seven of the base, four of a spherical joint.

PyBullet's stable PD controller sees a body this way, and so do its inverse dynamics and mass matrix with
`flags=1`. Spatial vectors, angular above linear, are in joint frames: their origin at the joint, their
axes such that a hinge turns about z and a slider moves along x.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_nodes import ROOT_COORDINATES, Node, extended_nodes, skew
from carom.description.pose import Vector3
from carom.description.transform import rotation_matrix
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
    """A tree of nodes.

    Attributes:
        nodes: Links and the joints that carry them, parents first; the first is the root.
        size: Number of coordinates.
    """

    def __init__(self, nodes: Sequence[Node]) -> None:
        self.nodes = nodes
        self.size = nodes[-1].first + nodes[-1].count

    def mass_matrix(self, position: np.ndarray) -> np.ndarray:
        """Mass matrix by the composite rigid body algorithm.

        Args:
            position: Coordinates; quaternions (x, y, z, w).

        Returns:
            (size, size); zeros for what does not move, the fourth coordinate of quaternions.
        """
        transforms = [self._transform(node, position) for node in self.nodes]
        subspaces = [self._subspace(node, position) for node in self.nodes]
        composite = [node.inertia.copy() for node in self.nodes]
        matrix = np.zeros((self.size, self.size))
        for index in range(len(self.nodes) - 1, -1, -1):
            node = self.nodes[index]
            if node.parent >= 0:
                x = transforms[index]
                composite[node.parent] += x.T @ composite[index] @ x
            own = slice(node.first, node.first + node.count)
            force = composite[index] @ subspaces[index]
            matrix[own, own] = subspaces[index].T @ force
            while node.parent >= 0:
                force = transforms[index].T @ force
                index, node = node.parent, self.nodes[node.parent]
                above = slice(node.first, node.first + node.count)
                matrix[above, own] = subspaces[index].T @ force
                matrix[own, above] = matrix[above, own].T
        return matrix

    def bias_forces(self, position: np.ndarray, rate: np.ndarray, gravity: Vector3) -> np.ndarray:
        """Forces of inertia and gravity at zero acceleration, by recursive Newton-Euler.

        Args:
            position: Coordinates; quaternions (x, y, z, w).
            rate: Their rates: of the base its linear and angular velocity in world axes and a zero; of a
                spherical joint its angular velocity and a zero.
            gravity: [m/s²].

        Returns:
            (size,).
        """
        count = len(self.nodes)
        velocities, accelerations = np.zeros((count, 6)), np.zeros((count, 6))
        forces = np.zeros((count, 6))
        transforms = [self._transform(node, position) for node in self.nodes]
        subspaces = [self._subspace(node, position) for node in self.nodes]
        for index, node in enumerate(self.nodes):
            own = rate[node.first : node.first + node.count]
            joint_velocity = subspaces[index] @ own
            velocity, acceleration = joint_velocity, np.zeros(6)
            if node.parent >= 0:
                velocity = transforms[index] @ velocities[node.parent] + joint_velocity
                acceleration = transforms[index] @ accelerations[node.parent]
            else:
                rotation = _matrix(position[3:7])
                acceleration[3:] = rotation.T @ (-np.asarray(gravity))
                # The rate of the root's motion subspace, with the world's angular velocity where the
                # body's belongs: so does PyBullet.
                acceleration[3:] -= np.cross(rate[3:6], rotation.T @ rate[:3])
            acceleration = acceleration + _cross_motion(velocity, joint_velocity)
            momentum = node.inertia @ velocity
            velocities[index], accelerations[index] = velocity, acceleration
            forces[index] = node.inertia @ acceleration + _cross_force(velocity, momentum)
        result = np.zeros(self.size)
        for index in range(count - 1, -1, -1):
            node = self.nodes[index]
            result[node.first : node.first + node.count] = subspaces[index].T @ forces[index]
            if node.parent >= 0:
                forces[node.parent] += transforms[index].T @ forces[index]
        return result

    def _transform(self, node: Node, position: np.ndarray) -> np.ndarray:
        """Motion transform from the parent's joint frame to the node's, (6, 6)."""
        rotation, origin = node.rotation, node.origin
        own = position[node.first : node.first + node.count]
        if node.parent < 0:
            rotation, origin = _matrix(own[3:7]), own[:3]
        elif node.kind == JointCode.REVOLUTE:
            c, s = np.cos(own[0]), np.sin(own[0])
            rotation = rotation @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        elif node.kind == JointCode.PRISMATIC:
            origin = origin + rotation[:, 0] * own[0]
        elif node.kind == JointCode.SPHERICAL:
            rotation = rotation @ _matrix(own)
        return _motion_transform(rotation, origin)

    def _subspace(self, node: Node, position: np.ndarray) -> np.ndarray:
        if node.parent >= 0:
            return _SUBSPACES[node.kind]
        to_body = _matrix(position[3:7]).T
        subspace = np.zeros((6, ROOT_COORDINATES))
        subspace[3:, :3] = to_body
        subspace[:3, 3:6] = to_body
        return subspace


def _matrix(quaternion: np.ndarray) -> np.ndarray:
    x, y, z, w = quaternion.tolist()
    return np.array(rotation_matrix((x, y, z, w)))


def _motion_transform(rotation: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Takes motions to a frame that is turned and displaced."""
    transform = np.zeros((6, 6))
    transform[:3, :3] = transform[3:, 3:] = rotation.T
    transform[3:, :3] = -rotation.T @ skew(origin)
    return transform


def _cross_motion(v: np.ndarray, m: np.ndarray) -> np.ndarray:
    angular, linear = v[:3], v[3:]
    return np.concatenate([np.cross(angular, m[:3]), np.cross(linear, m[:3]) + np.cross(angular, m[3:])])


def _cross_force(v: np.ndarray, f: np.ndarray) -> np.ndarray:
    angular, linear = v[:3], v[3:]
    return np.concatenate([np.cross(angular, f[:3]) + np.cross(linear, f[3:]), np.cross(angular, f[3:])])


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
    model = ExtendedModel(extended_nodes(body, as_pybullet=True))
    matrix = model.mass_matrix(_with_base(body, positions, _base_pose(body)))
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
    model = ExtendedModel(extended_nodes(body, as_pybullet=True))
    u = body.first_velocity
    angular, linear = body.world.velocity[u : u + 3], body.world.velocity[u + 3 : u + 6]
    rate = _with_base(body, velocities, np.concatenate([linear, angular, [0.0]]))
    return model.bias_forces(
        _with_base(body, positions, _base_pose(body)), rate, body.world.parameters.gravity
    )


def _base_pose(body: Body) -> np.ndarray:
    return body.world.position[body.first_position : body.first_position + ROOT_COORDINATES]


def _with_base(body: Body, values: Sequence[float], of_fixed_base: np.ndarray) -> np.ndarray:
    """Extended coordinates; those of a fixed base are not among the values."""
    own = np.asarray(values, dtype=float)
    return np.concatenate([of_fixed_base, own]) if body.fixed_base else own
