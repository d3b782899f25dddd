"""Inverse dynamics, Jacobians and mass matrices of articulated bodies."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from math import inf
from struct import error as StructError
from typing import TYPE_CHECKING, Any, overload

from pybullet._calls.arguments import NOT_GIVEN, Vector, check_rotation, integer, numbers, one_body, required
from pybullet._calls.builtin import exported, exported_requiring
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of, clients
from pybullet._clients.lookup import body_of, link_of
from pybullet._maths.maths import getQuaternionFromEuler

if TYPE_CHECKING:
    from carom.scene.body import Body

__all__ = ["calculateInverseDynamics", "calculateJacobian", "calculateMassMatrix"]

Matrix = tuple[tuple[float, ...], ...]

_FULL_MODEL = 1
_BASE_POSITIONS, _BASE_VELOCITIES = 7, 6
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_INVERSE_DYNAMICS = "Error in calculateInverseDynamics, please check arguments."
_INVERSE_DYNAMICS_SIZES = (
    "calculateInverseDynamics numDofs needs to be positive and [joint velocities] and[joint accelerations] "
    "need to be equal and match the number of degrees of freedom."
)
_JACOBIAN_SIZES = (
    "calculateJacobian [numDof] needs to be positive, [local position] needs to be of size 3 and "
    "[joint positions], [joint velocities], [joint accelerations] need to match the number of DoF."
)
_MASS_MATRIX_SIZES = (
    "calculateMassMatrix [numJoints] needs to be positive and [joint positions] need to match the number of "
    "joints."
)


@overload
def calculateInverseDynamics(
    bodyUniqueId: int,
    objPositions: Vector,
    objVelocities: Vector,
    objAccelerations: Vector,
    flags: int = 0,
    physicsClientId: int = 0,
) -> tuple[float, ...]: ...
@overload
def calculateInverseDynamics(
    *,
    bodyIndex: int,
    objPositions: Vector,
    objVelocities: Vector,
    objAccelerations: Vector,
    flags: int = 0,
    physicsClientId: int = 0,
) -> tuple[float, ...]: ...
@exported_requiring(4)
def calculateInverseDynamics(
    bodyUniqueId: int = NOT_GIVEN,
    objPositions: Vector = NOT_GIVEN,
    objVelocities: Vector = NOT_GIVEN,
    objAccelerations: Vector = NOT_GIVEN,
    flags: int = 0,
    physicsClientId: int = 0,
    *,
    bodyIndex: int = NOT_GIVEN,
) -> tuple[float, ...]:
    """Joint torques or forces for given accelerations, with gravity, without damping and motors.

    The state of the body is neither used nor changed. The coordinates are those of the joints
    that are not fixed, in the order of `getJointInfo`; a spherical joint has roll, pitch and yaw for its
    position. With a floating base the base comes first: in positions as position (3) and quaternion (4),
    in velocities, accelerations and forces as six numbers. A quaternion of four zeros means no turn.

    Gravity is PyBullet's: a fixed base's inertial frame is taken as parallel to the world frame, and a
    floating base is rotated by yaw, pitch and roll in the wrong order. So for a rotated base the gravity
    torques are wrong; those of `carom.algorithms.inverse_dynamics` are right.

    Args:
        bodyUniqueId: The body.
        objPositions: Positions [rad or m].
        objVelocities: Velocities [rad/s or m/s].
        objAccelerations: Accelerations [rad/s² or m/s²].
        flags: 1 for another model that counts the base of every body and four coordinates for a spherical
            joint; it ignores accelerations.
        physicsClientId: The connection.
        bodyIndex: Another name of `bodyUniqueId`.

    Returns:
        Forces [N m or N], one for each velocity. Those on a floating base are linear, then angular.

    Raises:
        pybullet.error: Not connected, there is no such body, the lists do not fit it, or the forces overflow.

    Examples:
        >>> torques = p.calculateInverseDynamics(arm, [0, 1, 0, 0, 0, 0, 0], [0] * 7, [0] * 7)
        >>> round(torques[1], 1)
        -45.1
    """
    try:
        client = clients[physicsClientId]
        if not flags:
            return client.bodies.forces_of_motion[bodyUniqueId](
                client.world.parameters.gravity, objPositions, objVelocities, objAccelerations
            )
    except (KeyError, TypeError, ValueError, OverflowError, StructError):
        pass
    body_id = one_body(bodyUniqueId, bodyIndex, "calculateInverseDynamics")
    required(
        "calculateInverseDynamics",
        objPositions=objPositions,
        objVelocities=objVelocities,
        objAccelerations=objAccelerations,
    )
    client = client_of(physicsClientId)
    body = body_of(client, body_id, _INVERSE_DYNAMICS)
    q = numbers(objPositions, _INVERSE_DYNAMICS, "objPositions")
    qd = numbers(objVelocities, _INVERSE_DYNAMICS, "objVelocities")
    qdd = numbers(objAccelerations, _INVERSE_DYNAMICS, "objAccelerations")
    full = integer(flags, "flags") & _FULL_MODEL != 0
    if len(qd) != len(qdd):
        fail(_INVERSE_DYNAMICS_SIZES, f"There are {len(qd)} velocities and {len(qdd)} accelerations.")
    floating = not body.fixed_base
    if full:
        positions = velocities = sum(body.position_count) + (_BASE_POSITIONS if floating else 0)
        # PyBullet accepts longer lists here.
        q, qd = q[:positions], qd[:velocities]
    else:
        positions = sum(body.velocity_count) + (_BASE_POSITIONS if floating else 0)
        velocities = sum(body.velocity_count) + (_BASE_VELOCITIES if floating else 0)
    if len(q) != positions or len(qd) != velocities or velocities == 0:
        fail(
            _INVERSE_DYNAMICS,
            f"Body {body.id} ({body.name}) takes {positions} positions and {velocities} velocities, "
            f"not {len(q)} and {len(qd)}.",
        )

    if full:
        from carom.algorithms.extended_model import extended_bias_forces

        _check_extended(body, q, _INVERSE_DYNAMICS)
        with _refusing_overflow(_INVERSE_DYNAMICS):
            return tuple(extended_bias_forces(body, q, qd).tolist())

    from carom.algorithms.mechanism import mechanism_in_pybullet

    if floating:
        if not any(q[3:_BASE_POSITIONS]):
            # Scripts that fill a list with zeros mean no turn, and in PyBullet get it.
            q = (*q[:3], *_NO_TURN, *q[_BASE_POSITIONS:])
        _check_rotation(q[3:_BASE_POSITIONS], _INVERSE_DYNAMICS)
    forces = client.bodies.forces_of_motion[body.id] = mechanism_in_pybullet(body).forces_in_pybullet
    with _refusing_overflow(_INVERSE_DYNAMICS):
        return forces(client.world.parameters.gravity, q, qd, qdd)


@exported
def calculateJacobian(
    bodyUniqueId: int,
    linkIndex: int,
    localPosition: Vector,
    objPositions: Vector,
    objVelocities: Vector,
    objAccelerations: Vector,
    physicsClientId: int = 0,
) -> tuple[Matrix, Matrix]:
    """The Jacobian of a point on a link: from joint velocities to the velocity of the point.

    The state of the body is neither used nor changed. The coordinates are those of the joints
    that are not fixed, in the order of `getJointInfo`.

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        localPosition: The point, from the origin of the link frame, in the axes of its inertial frame [m].
        objPositions: Positions [rad or m].
        objVelocities: Velocities; not used.
        objAccelerations: Accelerations; not used.
        physicsClientId: The connection.

    Returns:
        (linear, angular): two matrices of three rows and a column for each joint. With a floating base
        six columns for its angular and linear velocity come first.

    Raises:
        pybullet.error: Not connected, there is no such body or link, a joint is spherical or planar, the
            lists do not fit the body, or the result overflows.

    Examples:
        >>> linear, angular = p.calculateJacobian(arm, 6, [0, 0, 0], [0] * 7, [0] * 7, [0] * 7)
        >>> len(linear), len(linear[0])
        (3, 7)
    """
    try:
        mechanism = clients[physicsClientId].bodies[bodyUniqueId].mechanism
        if (
            mechanism is not None
            and len(objVelocities) == len(objAccelerations) == mechanism.joint_dofs > 0  # type: ignore[arg-type]
            and len(objPositions) == mechanism.coordinates  # type: ignore[arg-type]
            and len(localPosition) == 3  # type: ignore[arg-type]
        ):
            check = sum(localPosition) + sum(objPositions) + sum(objVelocities) + sum(objAccelerations)
            if -inf < check < inf:
                return mechanism.jacobian(linkIndex, localPosition, objPositions)  # type: ignore[arg-type]
    except (KeyError, TypeError, ValueError, OverflowError, StructError):
        pass
    body = body_of(client_of(physicsClientId), bodyUniqueId, _JACOBIAN_SIZES)
    link = integer(linkIndex, "linkIndex")
    if body.position_count != body.velocity_count:
        fail("Spherirical joints are not supported in the pybullet binding")
    if max(body.velocity_count, default=0) > 1:
        fail("Planar joints are not supported in the pybullet binding")
    freedoms = sum(body.velocity_count)
    lists = {
        "localPosition": (localPosition, 3),
        "objPositions": (objPositions, freedoms),
        "objVelocities": (objVelocities, freedoms),
        "objAccelerations": (objAccelerations, freedoms),
    }
    values = {name: numbers(given, _JACOBIAN_SIZES, name) for name, (given, _) in lists.items()}
    for name, (_, size) in lists.items():
        if len(values[name]) != size:
            fail(_JACOBIAN_SIZES, f"{name} has {len(values[name])} values instead of {size}.")
    if freedoms == 0:
        fail(_JACOBIAN_SIZES, f"Body {body.id} ({body.name}) has no joint that moves.")
    link_of(body, link, "linkIndex", "Internal error in calculateJacobian")

    from carom.algorithms.mechanism import mechanism_in_pybullet

    with _refusing_overflow(_JACOBIAN_SIZES):
        return mechanism_in_pybullet(body).jacobian(link, values["localPosition"], values["objPositions"])


@exported
def calculateMassMatrix(
    bodyUniqueId: int, objPositions: Vector, flags: int = 0, physicsClientId: int = 0
) -> Matrix:
    """The joint-space mass matrix (inertia matrix).

    The state of the body is neither used nor changed. The coordinates are those of the joints
    that are not fixed, in the order of `getJointInfo`; a spherical joint has roll, pitch and yaw.

    Args:
        bodyUniqueId: The body.
        objPositions: Positions [rad or m]; additional numbers are ignored.
        flags: 1 for another model that counts the base of every body, and four coordinates for a
            spherical joint; a floating base's position (3) and quaternion (4) then come first.
        physicsClientId: The connection.

    Returns:
        The rows of the matrix. With a floating base six rows and columns for its angular and linear velocity
        come first.

    Raises:
        pybullet.error: Not connected, there is no such body, there are too few positions, or the result
            overflows.

    Examples:
        >>> matrix = p.calculateMassMatrix(arm, [0] * 7)
        >>> len(matrix), len(matrix[0])
        (7, 7)
    """
    try:
        mechanism = clients[physicsClientId].bodies[bodyUniqueId].mechanism
        if (
            mechanism is not None
            and not flags
            and len(objPositions) == mechanism.coordinates  # type: ignore[arg-type]
            and -inf < sum(objPositions) < inf
        ):
            return mechanism.mass_matrix(objPositions)  # type: ignore[arg-type]
    except (KeyError, TypeError, ValueError, OverflowError, StructError):
        pass
    problem = "Internal error in calculateMassMatrix"
    body = body_of(client_of(physicsClientId), bodyUniqueId, problem)
    q = numbers(objPositions, _MASS_MATRIX_SIZES, "objPositions")
    full = integer(flags, "flags") & _FULL_MODEL != 0
    needed = sum(body.position_count if full else body.velocity_count)
    if full and not body.fixed_base:
        needed += _BASE_POSITIONS
    if len(q) < needed:
        fail(_MASS_MATRIX_SIZES, f"Body {body.id} ({body.name}) takes {needed} positions, not {len(q)}.")

    if full:
        from carom.algorithms.extended_model import extended_mass_matrix

        _check_extended(body, q, problem)
        with _refusing_overflow(problem):
            return _rows(extended_mass_matrix(body, q[:needed]))

    from carom.algorithms.mechanism import mechanism_in_pybullet

    with _refusing_overflow(problem):
        return mechanism_in_pybullet(body).mass_matrix(joint_coordinates(body, q[:needed]))


@contextmanager
def _refusing_overflow(problem: str) -> Iterator[None]:
    """Turn the `ValueError` of numbers whose results are not finite into `pybullet.error`."""
    try:
        yield
    except ValueError as overflow:
        fail(problem, f"{overflow}.")


def joint_coordinates(body: Body, values: tuple[float, ...]) -> tuple[float, ...]:
    """Joint positions as the engine stores them: quaternions of spherical joints instead of three angles."""
    return converted_rotations(body, values, body.velocity_count, getQuaternionFromEuler)


def converted_rotations(
    body: Body, values: tuple[float, ...], counts: Sequence[int], convert: Callable[[Vector], Iterable[float]]
) -> tuple[float, ...]:
    """Joint positions with those of spherical joints converted; `counts` are the numbers of each joint."""
    if body.position_count == body.velocity_count:
        return values
    result: list[float] = []
    first = 0
    for joint, count in enumerate(counts):
        own = values[first : first + count]
        result += own if body.position_count[joint] == body.velocity_count[joint] else convert(own)
        first += count
    return tuple(result)


def _check_extended(body: Body, positions: tuple[float, ...], problem: str) -> None:
    """Checks that a body has extended coordinates, and that their quaternions are rotations."""
    counts = zip(body.position_count, body.velocity_count, strict=True)
    if any(coordinates == freedoms > 1 for coordinates, freedoms in counts):
        fail(
            problem, f"Body {body.id} ({body.name}) has a planar joint, for which flags=1 has no coordinates."
        )
    first = 0 if body.fixed_base else _BASE_POSITIONS
    if first:
        _check_rotation(positions[3:7], problem)
    for count in body.position_count:
        if count == 4:
            _check_rotation(positions[first : first + 4], problem)
        first += count


def _check_rotation(quaternion: tuple[float, ...], problem: str) -> None:
    if quaternion:
        check_rotation(quaternion, problem, "A part of objPositions")


def _rows(matrix: Any) -> Matrix:
    return tuple(tuple(row) for row in matrix.tolist())
