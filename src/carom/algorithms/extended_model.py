"""The equations of motion in extended coordinates: seven for the base, four for a spherical joint.

PyBullet's inverse dynamics and mass matrix use these coordinates with `flags=1`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_nodes import extended_nodes
from carom.algorithms.mechanism import Mechanism
from carom.algorithms.nodes import Node
from carom.description.pose import Vector3
from carom.description.transform import matrix_vector, rotation_matrix, transposed
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES, POSITION_COUNT
from carom.native.gates import gated
from carom.native.products import dots, product

if TYPE_CHECKING:
    from carom.scene.body import Body


class ExtendedModel:
    """A mechanism of nodes in extended coordinates.

    Rates and forces begin with those of the base in world axes, linear before angular, and a zero. Those of
    the joints follow; a spherical joint has three and a zero. Positions are those of the base and of the
    joints; quaternions are (x, y, z, w).

    Attributes:
        size: Number of coordinates.
    """

    def __init__(self, nodes: Sequence[Node]) -> None:
        self._mechanism = Mechanism(nodes, free=True)
        self.size: int = BASE_POSITIONS + self._mechanism.coordinates
        # The extended coordinate of each dof of the mechanism, whose base has its angular dofs first.
        places = [3, 4, 5, 0, 1, 2]
        first = BASE_POSITIONS
        for node in nodes:
            places += range(first, first + len(node.axes))
            first += POSITION_COUNT[node.kind]
        self._places = np.array(places)

    def mass_matrix(self, position: np.ndarray) -> np.ndarray:
        """Mass matrix, (size, size), with zeros for the fourth coordinate of quaternions."""
        moving = np.array(self._mechanism.mass_matrix(position[BASE_POSITIONS:]))
        turn = np.eye(self._mechanism.dofs)
        turn[:3, :3] = turn[3:6, 3:6] = _rotation(position)
        matrix = np.zeros((self.size, self.size))
        matrix[np.ix_(self._places, self._places)] = product(product(turn, moving), turn.T)
        return _finite(matrix, "mass matrix is")

    def bias_forces(self, position: np.ndarray, rate: np.ndarray, gravity: Vector3) -> np.ndarray:
        """Generalized forces of inertia and gravity (`gravity` in m/s²) at zero acceleration, (size,)."""
        rotation = _rotation(position)
        velocity, omega = rate[:3].tolist(), rate[3:6].tolist()
        self._mechanism.set_base_motion(*base_motion(position[3:7].tolist(), velocity, omega, gravity))
        still = np.zeros(self._mechanism.joint_dofs)
        rates = rate[self._places[BASE_VELOCITIES:]]
        forces = np.array(self._mechanism.forces(position[BASE_POSITIONS:], rates, still))
        forces[:3], forces[3:6] = dots(rotation, forces[:3]), dots(rotation, forces[3:6])
        result = np.zeros(self.size)
        result[self._places] = forces
        return _finite(result, "forces are")


def base_motion(
    orientation: Sequence[float], velocity: Sequence[float], omega: Sequence[float], gravity: Vector3
) -> tuple[float, ...]:
    """Motion of a base at zero acceleration, for `Mechanism.set_base_motion`, as PyBullet computes it.

    The orientation is a quaternion (x, y, z, w). Velocity [m/s], angular velocity [rad/s] and gravity [m/s²]
    are in world axes.
    """
    x, y, z, w = orientation
    to_base = transposed(rotation_matrix((x, y, z, w)))
    (vx, vy, vz), (ox, oy, oz) = velocity, omega
    vx, vy, vz = matrix_vector(to_base, (vx, vy, vz))
    own_omega = matrix_vector(to_base, (ox, oy, oz))
    gx, gy, gz = matrix_vector(to_base, gravity)
    # PyBullet takes the two angular velocities here in different axes. In the same axes they would cancel,
    # and only gravity would remain.
    dx, dy, dz = own_omega[0] - ox, own_omega[1] - oy, own_omega[2] - oz
    acceleration = (dy * vz - dz * vy - gx, dz * vx - dx * vz - gy, dx * vy - dy * vx - gz)
    return (*own_omega, 0.0, 0.0, 0.0, *acceleration)


def _finite(values: np.ndarray, name: str) -> np.ndarray:
    """The values; raises `ValueError` if one is not finite."""
    if not np.isfinite(values).all():
        raise ValueError(f"the {name} not finite")
    return values


def _rotation(position: np.ndarray) -> np.ndarray:
    x, y, z, w = position[3:BASE_POSITIONS].tolist()
    return np.array(rotation_matrix((x, y, z, w)))


@gated("world.call_lock")
def extended_mass_matrix(body: Body, positions: Sequence[float]) -> np.ndarray:
    """Mass matrix of a body in extended coordinates; coordinates without inertia have a 1 on the diagonal.

    It is (n, n) over all extended coordinates, the base's seven first, also for a fixed base. Positions are
    first those and the quaternion of the base, if it is floating; then one number for each joint, or a
    quaternion (x, y, z, w) for a spherical joint.

    Raises:
        ValueError: A joint is planar, or the entries overflow.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    matrix = _model(body).mass_matrix(_with_base(body, positions, _base_pose(body)))
    diagonal = np.diag_indices_from(matrix)
    matrix[diagonal] = np.where(matrix[diagonal] == 0.0, 1.0, matrix[diagonal])
    return matrix


@gated("world.call_lock")
def extended_bias_forces(body: Body, positions: Sequence[float], velocities: Sequence[float]) -> np.ndarray:
    """Forces (n,) that keep a body at zero acceleration, in the coordinates of `extended_mass_matrix`.

    Velocities are as many numbers as positions: first linear and angular velocity of the base and an ignored
    number, if it is floating; then one rate for each joint, or for a spherical joint its angular velocity and
    an ignored number. The errors are those of `extended_mass_matrix`.
    """
    position = _with_base(body, positions, _base_pose(body))
    u = body.first_velocity
    angular, linear = body.world.velocity[u : u + 3], body.world.velocity[u + 3 : u + 6]
    rate = _with_base(body, velocities, np.concatenate([linear, angular, [0.0]]))
    return _model(body).bias_forces(position, rate, body.world.parameters.gravity)


def _model(body: Body) -> ExtendedModel:
    model = body.derived.get(ExtendedModel)
    if model is None:
        model = body.derived[ExtendedModel] = ExtendedModel(extended_nodes(body, as_pybullet=True))
    return model


def _base_pose(body: Body) -> np.ndarray:
    return body.world.position[body.first_position : body.first_position + BASE_POSITIONS]


def _with_base(body: Body, values: Sequence[float], of_fixed_base: np.ndarray) -> np.ndarray:
    """All extended coordinates; `values` does not contain those of a fixed base."""
    own = np.asarray(values, dtype=float)
    return np.concatenate([of_fixed_base, own]) if body.fixed_base else own
