"""Motor commands as lists, for joints with any number of degrees of freedom, mainly spherical joints."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, inf, nan
from typing import TYPE_CHECKING, Any, SupportsFloat

from carom.layouts.motor_commands import (
    DEFAULT_POSITION_GAIN,
    DEFAULT_VELOCITY_GAIN,
    NO_CLAMP,
    TARGET_ENTRIES,
)
from carom.model.joint_columns import NO_ENTRIES, Column, column_of
from pybullet._calls.arguments import (
    MAX_MAGNITUDE,
    Indices,
    Vector,
    bound,
    check_rotation,
    indices,
    integer,
    numbers,
    quantities,
    quantity,
    sequence,
)
from pybullet._calls.builtin import exported
from pybullet._calls.constants import PD_CONTROL, POSITION_CONTROL, STABLE_PD_CONTROL, TORQUE_CONTROL
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import OUT_OF_RANGE, body_access, joint_access, joint_of
from pybullet._joints.joints import NO_INDICES
from pybullet._maths.rotations import unit

if TYPE_CHECKING:
    from pybullet._access.body_access import BodyAccess

__all__ = ["setJointMotorControlMultiDof", "setJointMotorControlMultiDofArray"]

_ILLEGAL_MODE = "Illegal control mode."
_DAMPING = (1.0,)
_UNUSED = (nan,) * TARGET_ENTRIES
_ARRAY_MODES = (TORQUE_CONTROL, PD_CONTROL, STABLE_PD_CONTROL, POSITION_CONTROL)
_USUAL_LISTS = frozenset((list, tuple))
_USUAL_NUMBERS = frozenset((float, int))
_QUATERNION = 4
_ROUNDED = 1e-12


@exported
def setJointMotorControlMultiDof(
    bodyUniqueId: int,
    jointIndex: int,
    controlMode: int,
    targetPosition: Vector | None = None,
    targetVelocity: Vector | None = None,
    force: Vector | None = None,
    positionGain: float | Vector = 0.1,
    velocityGain: float | Vector = 1.0,
    maxVelocity: float = -1,
    damping: float | Vector = 1.0,
    physicsClientId: int = 0,
) -> None:
    """Sets the motor of a joint by one number for each degree of freedom.

    A list of the wrong length counts as not given. If neither position nor velocity is given, the motor does
    not change. If no force is given, the maximum is 1000000 N m or N.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        controlMode: `POSITION_CONTROL`, or `TORQUE_CONTROL`, which adds `force` to the torques of the
            next step.
        targetPosition: One number [rad or m]; for a spherical joint a quaternion (x, y, z, w).
        targetVelocity: One number [rad/s or m/s], or three; a spherical motor ignores it.
        force: Maximum forces of the motor, or the torques [N m or N]: a number for each degree of freedom, or
            one for all.
        positionGain: Fraction of the error corrected in one step. One number, or one for each degree of
            freedom; these count only if forces and both gains each have one for each degree of freedom.
        velocityGain: As in `setJointMotorControl2`; one or several numbers, as for `positionGain`.
        maxVelocity: Maximum velocity that the motor aims for if greater than 0; not for spherical joints.
        damping: Fraction of the angular velocity that a spherical motor removes, for each axis or for all.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body, joint or mode, or an argument holds something
            that is not a finite number.

    Examples:
        >>> p.setJointMotorControlMultiDof(arm, 3, p.POSITION_CONTROL, targetPosition=[0.5], force=[200])
    """
    client_of(physicsClientId)
    position = _list(targetPosition, "targetPosition", 4)
    velocity = _list(targetVelocity, "targetVelocity", 3)
    forces = _list(force, "force", 3, inf)
    kp, kd = _gain(positionGain, "positionGain"), _gain(velocityGain, "velocityGain")
    damped = _gain(damping, "damping")
    clamp = bound(maxVelocity, "maxVelocity")
    access, joint = joint_access(bodyUniqueId, jointIndex, physicsClientId)
    mode = integer(controlMode, "controlMode")
    if mode not in (TORQUE_CONTROL, POSITION_CONTROL):
        fail(_ILLEGAL_MODE, f"{mode} is neither position nor torque control.")
    if mode == POSITION_CONTROL and len(position) == _QUATERNION:
        _check_rotation(position)
        position = _rotation(position)
    _command(access, joint, mode, (position, velocity, forces, kp, kd, damped), clamp)


@exported
def setJointMotorControlMultiDofArray(
    bodyUniqueId: int,
    jointIndices: Indices,
    controlMode: int,
    targetPositions: Iterable[Vector] | None = None,
    targetVelocities: Iterable[Vector] | None = None,
    forces: Iterable[Vector] | None = None,
    positionGains: Vector | None = None,
    velocityGains: Vector | None = None,
    maxVelocities: Vector | None = None,
    physicsClientId: int = 0,
) -> None:
    """Sets the motors of several joints, each by a list of numbers.

    Nothing happens if a list is not empty and does not have one entry for each joint. An entry whose length
    does not fit its joint counts as not given.

    Args:
        bodyUniqueId: The body.
        jointIndices: The joints, in any order.
        controlMode: `POSITION_CONTROL` or `TORQUE_CONTROL` as in `setJointMotorControlMultiDof`;
            `PD_CONTROL` as in `setJointMotorControl2`, for joints of one degree of freedom;
            `STABLE_PD_CONTROL`, for the next step only: the torques of a PD controller that looks one step
            ahead with the equations of motion of the whole body, and so stays stable with high gains (Tan,
            Liu and Turk, 2011).
        targetPositions: For each joint one number [rad or m], or a quaternion (x, y, z, w).
        targetVelocities: For each joint one number [rad/s or m/s], or three.
        forces: For each joint the maximum forces of the motor, or the torques [N m or N].
        positionGains: A number for each joint.
        velocityGains: A number for each joint.
        maxVelocities: Not used, as in PyBullet.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body, joint or mode, or a list holds something that
            is not a finite number.

    Examples:
        >>> p.setJointMotorControlMultiDofArray(
        ...     arm, [2, 3], p.POSITION_CONTROL, targetPositions=[[0.1], [0.5]], forces=[[200], [200]]
        ... )
    """
    client = client_of(physicsClientId)
    mode = integer(controlMode, "controlMode")
    if mode not in _ARRAY_MODES:
        fail(_ILLEGAL_MODE, f"{mode} is not a control mode for an array of such joints.")
    requested = indices(jointIndices, NO_INDICES, "jointIndices")
    lists = (
        _entries(targetPositions, "targetPositions"),
        _entries(targetVelocities, "targetVelocities"),
        _entries(forces, "forces"),
        _entries(positionGains, "positionGains"),
        _entries(velocityGains, "velocityGains"),
    )
    count = len(requested)
    if count == 0 or not {0, count}.issuperset(map(len, lists)):
        return
    access = body_access(bodyUniqueId, physicsClientId, OUT_OF_RANGE)
    joints: Sequence[int] = requested
    if min(requested) < 0 or max(requested) >= access.body.joint_count:
        joints = [joint_of(access.body, index) for index in requested]
    positions = _column(lists[0], "targetPositions", 4)
    velocities = _column(lists[1], "targetVelocities", 3)
    bounds = _column(lists[2], "forces", 3, inf)
    kps = _gains(lists[3], "positionGains") or [DEFAULT_POSITION_GAIN] * count
    kds = _gains(lists[4], "velocityGains") or [DEFAULT_VELOCITY_GAIN] * count
    for position, length in zip(positions.entries, positions.counts, strict=True):
        if length == _QUATERNION:
            _check_rotation(position)
    if mode == STABLE_PD_CONTROL:
        from carom.algorithms.stable_pd import stable_pd_torques

        body, time_step = access.body, client.time_step
        torques = stable_pd_torques(body, requested, positions, velocities, bounds, kps, kds, time_step)
        first = body.first_velocity
        own = body.world.joint_torque[first : first + len(torques)]
        own += torques
        return
    columns = [column.entries or [()] * count for column in (positions, velocities, bounds)]
    for joint, position, velocity, force, kp, kd in zip(joints, *columns, kps, kds, strict=True):
        turn = _rotation(position) if len(position) == _QUATERNION else position
        lists = (turn, velocity, force, (kp,), (kd,), _DAMPING)
        _command(access, joint, mode, lists, NO_CLAMP)


def _command(
    access: BodyAccess, joint: int, mode: int, lists: Iterable[Sequence[float]], clamp: float
) -> None:
    """Tell a joint positions, velocities, forces, two gains and dampings; unused places hold NaN."""
    padded = [number for given in lists for number in (*given, *_UNUSED[len(given) :])]
    access.kernels("command_joint", joint, mode, *padded, clamp)


def _column(
    entries: Sequence[Vector | None], name: str, most: int, greatest: float = MAX_MAGNITUDE
) -> Column:
    """The checked numbers of each joint; usual lists are checked all at once, which is faster."""
    if not entries:
        return NO_ENTRIES
    if _USUAL_LISTS.issuperset(map(type, entries)):
        usual = column_of(entries)  # type: ignore[arg-type]
        if max(usual.counts) <= most and _are_usual(usual.numbers, greatest):
            return usual
    return column_of([_list(values, name, most, greatest) for values in entries])


def _gains(values: Sequence[float], name: str) -> Sequence[float]:
    """Checked numbers, likewise."""
    return values if _are_usual(values, MAX_MAGNITUDE) else [quantity(value, name) for value in values]


def _are_usual(values: Sequence[float], greatest: float) -> bool:
    """Whether all are Python's own numbers, finite, and their magnitudes at most `greatest`."""
    if not _USUAL_NUMBERS.issuperset(map(type, values)):
        return False
    # It is not less than the greatest of them, and NaN if one is. Great numbers that the bound allows may
    # have an infinite length: these are looked at one by one.
    try:
        length = hypot(*values)
    except OverflowError:
        return False
    return length <= greatest and length < inf


def _list(values: Vector | None, name: str, most: int, greatest: float = MAX_MAGNITUDE) -> Sequence[float]:
    """The checked numbers of one joint, cut off after `most`; empty if not given.

    Their magnitude is at most `MAX_MAGNITUDE`, or finite if `greatest` is infinite.
    """
    if values is None:
        return ()
    checked = numbers if greatest == inf else quantities
    return checked(values, f"expected a {name} sequence", name)[:most]


def _entries(values: Any, name: str) -> tuple[Any, ...]:
    return () if values is None else sequence(values, f"expected a {name} sequence", name)


def _gain(value: float | Vector, name: str) -> tuple[float, ...]:
    """At most three checked numbers, or one; an empty sequence is kept and counts as not given."""
    if type(value) is float or type(value) is int:
        return (quantity(value, name),)
    # An array of one number can be converted to a float, too, but counts as a list.
    if isinstance(value, SupportsFloat) and not getattr(value, "ndim", 0):
        return (quantity(value, name),)
    return quantities(value, f"expected a {name} sequence", name)[:3]


def _rotation(position: Sequence[float]) -> Sequence[float]:
    """The rotation that a quaternion of any length stands for; as it is if that is 1 but for rounding."""
    x, y, z, w = position
    return position if abs(x * x + y * y + z * z + w * w - 1.0) < _ROUNDED else unit((x, y, z, w))


def _check_rotation(position: Sequence[float]) -> None:
    check_rotation(position, "expected a targetPosition sequence", "targetPosition")
