"""Motor commands for one joint or several joints with one degree of freedom each."""

from __future__ import annotations

from typing import Any, overload

from carom.layouts.motor_commands import (
    DEFAULT_FORCE,
    DEFAULT_POSITION_GAIN,
    DEFAULT_VELOCITY_GAIN,
    MODES,
    NO_CLAMP,
)
from pybullet._calls.arguments import (
    NOT_GIVEN,
    Indices,
    Vector,
    bound,
    indices,
    integer,
    length,
    one_body,
    quantity,
    real,
    required,
    sequence,
)
from pybullet._calls.builtin import exported_as, exported_requiring
from pybullet._calls.constants import POSITION_CONTROL, TORQUE_CONTROL, VELOCITY_CONTROL
from pybullet._calls.errors import error, fail
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import OUT_OF_RANGE, body_access, joint_access, joint_of
from pybullet._joints.joints import NO_INDICES

__all__ = ["setJointMotorControl", "setJointMotorControl2", "setJointMotorControlArray"]

_ILLEGAL_MODE = "Illegal control mode."
_UNPARSED = "Error parsing arguments in setJointControl."
_WRONG_POSITIONS = "number of target positions should match the number of joint indices"
_WRONG_VELOCITIES = "number of target velocies should match the number of joint indices"
_WRONG_FORCES = "number of forces should match the joint indices"
_WRONG_KPS = "number of kps should match the joint indices"
_WRONG_KDS = "number of kds should match the number of joint indices"


@overload
def setJointMotorControl2(
    bodyUniqueId: int,
    jointIndex: int,
    controlMode: int,
    targetPosition: float = 0.0,
    targetVelocity: float = 0.0,
    force: float = DEFAULT_FORCE,
    positionGain: float = DEFAULT_POSITION_GAIN,
    velocityGain: float = DEFAULT_VELOCITY_GAIN,
    maxVelocity: float = -1,
    physicsClientId: int = 0,
) -> None: ...
@overload
def setJointMotorControl2(
    *,
    bodyIndex: int,
    jointIndex: int,
    controlMode: int,
    targetPosition: float = 0.0,
    targetVelocity: float = 0.0,
    force: float = DEFAULT_FORCE,
    positionGain: float = DEFAULT_POSITION_GAIN,
    velocityGain: float = DEFAULT_VELOCITY_GAIN,
    maxVelocity: float = -1,
    physicsClientId: int = 0,
) -> None: ...
@exported_requiring(3)
def setJointMotorControl2(
    bodyUniqueId: int = NOT_GIVEN,
    jointIndex: int = NOT_GIVEN,
    controlMode: int = NOT_GIVEN,
    targetPosition: float = 0.0,
    targetVelocity: float = 0.0,
    force: float = DEFAULT_FORCE,
    positionGain: float = DEFAULT_POSITION_GAIN,
    velocityGain: float = DEFAULT_VELOCITY_GAIN,
    maxVelocity: float = -1,
    physicsClientId: int = 0,
    *,
    bodyIndex: int = NOT_GIVEN,
) -> None:
    """Sets the motor of a joint, until it is set again.

    In each step the motor of a revolute or prismatic joint aims for the velocity `velocity + positionGain ·
    (targetPosition - position) / timeStep + velocityGain · (targetVelocity - velocity)` and reaches it unless
    that takes more than `force`. A new body's motors hold its joints still with an impulse of
    1 N m s (240 N m at the default step), so for joints that swing freely, or under torque control, call this
    first with `VELOCITY_CONTROL` and `force=0`.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0. The motor of a fixed joint does nothing.
        controlMode: `POSITION_CONTROL` as above. `VELOCITY_CONTROL` the same without the position.
            `TORQUE_CONTROL` adds `force` to the torques of the next step, in addition to the motor.
            `PD_CONTROL` adds the torque `positionGain · (targetPosition - position) + velocityGain ·
            (targetVelocity - velocity)`, at most `force`, in every step, in addition to the motor; `force=0`
            ends it.
        targetPosition: [rad or m]; clipped to the joint's limits.
        targetVelocity: [rad/s or m/s].
        force: Maximum force of the motor, or the torque [N m or N]. As the maximum of a motor it may be
            infinite.
        positionGain: See above.
        velocityGain: See above.
        maxVelocity: Maximum velocity that the motor aims for with `POSITION_CONTROL` if greater than 0 [rad/s
            or m/s]; it stays until `VELOCITY_CONTROL` is set.
        physicsClientId: The connection.
        bodyIndex: Another name of `bodyUniqueId`.

    Raises:
        pybullet.error: Not connected, there is no such body, joint or mode, or a number is not finite.

    Examples:
        >>> p.setJointMotorControl2(arm, 3, p.POSITION_CONTROL, targetPosition=0.5, force=200)
        >>> for _ in range(240):
        ...     _ = p.stepSimulation()
        >>> round(p.getJointState(arm, 3)[0], 2)
        0.5
    """
    body = one_body(bodyUniqueId, bodyIndex, "setJointMotorControl2")
    required("setJointMotorControl2", jointIndex=jointIndex, controlMode=controlMode)
    access, joint = joint_access(body, jointIndex, physicsClientId)
    mode = integer(controlMode, "controlMode")
    # A torque has to be finite, the maximum force of a motor may be infinite.
    checked_force = real if mode == TORQUE_CONTROL else bound
    command = (
        quantity(targetPosition, "targetPosition"),
        quantity(targetVelocity, "targetVelocity"),
        checked_force(force, "force"),
        quantity(positionGain, "positionGain"),
        quantity(velocityGain, "velocityGain"),
        bound(maxVelocity, "maxVelocity"),
    )
    if mode not in MODES:
        fail(_ILLEGAL_MODE, f"{mode} is not a control mode for a single joint.")
    access.kernels("command_motor", joint, mode, *command)


@overload
def setJointMotorControlArray(
    bodyUniqueId: int,
    jointIndices: Indices,
    controlMode: int,
    targetPositions: Vector | None = None,
    targetVelocities: Vector | None = None,
    forces: Vector | None = None,
    positionGains: Vector | None = None,
    velocityGains: Vector | None = None,
    physicsClientId: int = 0,
) -> None: ...
@overload
def setJointMotorControlArray(
    *,
    bodyIndex: int,
    jointIndices: Indices,
    controlMode: int,
    targetPositions: Vector | None = None,
    targetVelocities: Vector | None = None,
    forces: Vector | None = None,
    positionGains: Vector | None = None,
    velocityGains: Vector | None = None,
    physicsClientId: int = 0,
) -> None: ...
@exported_requiring(3)
def setJointMotorControlArray(
    bodyUniqueId: int = NOT_GIVEN,
    jointIndices: Indices = NOT_GIVEN,
    controlMode: int = NOT_GIVEN,
    targetPositions: Vector | None = None,
    targetVelocities: Vector | None = None,
    forces: Vector | None = None,
    positionGains: Vector | None = None,
    velocityGains: Vector | None = None,
    physicsClientId: int = 0,
    *,
    bodyIndex: int = NOT_GIVEN,
) -> None:
    """Sets the motors of several joints of a body: `setJointMotorControl2` for each.

    Nothing is set if an argument is wrong. Lists not given stand for the defaults of `setJointMotorControl2`.

    Args:
        bodyUniqueId: The body.
        jointIndices: The joints, in any order.
        controlMode: `POSITION_CONTROL`, `VELOCITY_CONTROL`, `TORQUE_CONTROL` or `PD_CONTROL`.
        targetPositions: A number for each joint [rad or m].
        targetVelocities: A number for each joint [rad/s or m/s].
        forces: A number for each joint [N m or N].
        positionGains: A number for each joint.
        velocityGains: A number for each joint.
        physicsClientId: The connection.
        bodyIndex: Another name of `bodyUniqueId`.

    Raises:
        pybullet.error: Not connected, there is no such body, joint or mode, a list does not have one number
            for each joint, or a number is not finite.

    Examples:
        >>> p.setJointMotorControlArray(arm, [0, 1], p.VELOCITY_CONTROL, targetVelocities=[0.5, 0])
        >>> for _ in range(24):
        ...     _ = p.stepSimulation()
        >>> round(p.getJointState(arm, 0)[1], 2)
        0.5
    """
    body = one_body(bodyUniqueId, bodyIndex, "setJointMotorControlArray")
    required("setJointMotorControlArray", jointIndices=jointIndices, controlMode=controlMode)
    client_of(physicsClientId)
    mode = integer(controlMode, "controlMode")
    if mode not in MODES:
        fail(_ILLEGAL_MODE, f"{mode} is not a control mode for an array of joints.")
    requested = indices(jointIndices, NO_INDICES, "jointIndices")
    if not requested:
        return
    access = body_access(body, physicsClientId, OUT_OF_RANGE)
    joints = [joint_of(access.body, index) for index in requested]
    count, torque = len(joints), mode == TORQUE_CONTROL
    velocities = _one_each(targetVelocities, 0.0, count, _WRONG_VELOCITIES, "targetVelocities")
    columns = [
        joints,
        _one_each(targetPositions, 0.0, count, _WRONG_POSITIONS, "targetPositions"),
        velocities,
        _one_each(forces, DEFAULT_FORCE, count, _WRONG_FORCES, "forces", infinite=not torque),
        _one_each(positionGains, DEFAULT_POSITION_GAIN, count, _WRONG_KPS, "positionGains"),
        _one_each(velocityGains, DEFAULT_VELOCITY_GAIN, count, _WRONG_KDS, "velocityGains"),
        (NO_CLAMP,) * count,
    ]
    rows = [number for row in zip(*columns, strict=True) for number in row]
    access.kernels("command_each", mode, count, *rows)


@overload
def setJointMotorControl(
    bodyUniqueId: int,
    jointIndex: int,
    controlMode: int,
    targetValue: float,
    maxForce: float = DEFAULT_FORCE,
    gain: float = ...,
    /,
    *,
    physicsClientId: int = 0,
) -> None: ...
@overload
def setJointMotorControl(
    bodyUniqueId: int,
    jointIndex: int,
    controlMode: int,
    targetPosition: float,
    targetVelocity: float,
    maxForce: float,
    kp: float,
    kd: float,
    /,
    *,
    physicsClientId: int = 0,
) -> None: ...
@exported_as("(*arguments, physicsClientId=0)")
def setJointMotorControl(*arguments: Any, physicsClientId: int = 0) -> None:
    """Sets the motor of a joint. An old form of `setJointMotorControl2`, with positional arguments.

    Called as `(body, joint, mode, target)`, `(body, joint, mode, target, maxForce)`,
    `(body, joint, mode, target, maxForce, gain)` or
    `(body, joint, mode, targetPosition, targetVelocity, maxForce, kp, kd)`.

    Args:
        *arguments: Body, joint, mode (`POSITION_CONTROL`, `VELOCITY_CONTROL`, or `TORQUE_CONTROL` in the
            first and last form), and the target: a position, a velocity or, in the first form, a torque. In
            the last form a torque is 0.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body, joint or mode, the number of arguments is
            none of these, or a number is not finite.

    Examples:
        >>> p.setJointMotorControl(arm, 3, p.POSITION_CONTROL, 0.5, 200)
    """
    client_of(physicsClientId)
    count = len(arguments)
    if count not in (4, 5, 6, 8):
        fail(_UNPARSED, f"There are {count} arguments instead of 4, 5, 6 or 8.")
    try:
        body, index, mode = (
            integer(value, name)
            for value, name in zip(arguments, ("bodyUniqueId", "jointIndex", "controlMode"), strict=False)
        )
        values = [real(value, "argument") for value in arguments[3:]]
    except (TypeError, OverflowError) as problem:
        raise error(f"Error parsing arguments. {problem}") from None
    position = velocity = torque = 0.0
    force, kp, kd = DEFAULT_FORCE, DEFAULT_POSITION_GAIN, DEFAULT_VELOCITY_GAIN
    if count == 8:
        position, velocity, force, kp, kd = values
    elif mode == POSITION_CONTROL:
        position, force, kp = (*values, *(force, kp)[len(values) - 1 :])
    elif mode == VELOCITY_CONTROL:
        velocity, force, kd = (*values, *(force, kd)[len(values) - 1 :])
    elif mode == TORQUE_CONTROL and count == 4:
        torque = values[0]
    else:
        fail(_UNPARSED, f"Mode {mode} cannot be used with {count} arguments.")
    access, joint = joint_access(body, index, physicsClientId)
    if mode not in (POSITION_CONTROL, VELOCITY_CONTROL, TORQUE_CONTROL):
        fail(_ILLEGAL_MODE, f"{mode} is neither position, velocity nor torque control.")
    strength = torque if mode == TORQUE_CONTROL else force
    access.kernels("command_motor", joint, mode, position, velocity, strength, kp, kd, NO_CLAMP)


def _one_each(
    values: Any, default: float, count: int, problem: str, name: str, infinite: bool = False
) -> tuple[float, ...]:
    """A checked number for each joint; the default if no list is given."""
    if values is None:
        return (default,) * count
    given = length(values, problem, name)
    if given != count:
        fail(problem, f"{name} has {given} values for {count} joints.")
    items = sequence(values, problem, name)
    convert = bound if infinite else real
    return tuple([convert(item, name) for item in items])
