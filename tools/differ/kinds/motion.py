"""What moves bodies: steps, motors, forces, and states of bases and joints that are set."""

from __future__ import annotations

from typing import Any

from tools.differ.assets import SPHERICAL
from tools.differ.maker import Body, Maker

_VELOCITY, _TORQUE, _POSITION, _PD = range(4)


def step(maker: Maker) -> None:
    """A few steps; after each the state of everything."""
    for _ in range(maker.one((1, 1, 2, 5))):
        maker.call("stepSimulation")
        maker.call("@probe")


def motor(maker: Maker) -> None:
    """A command to one joint, or to several."""
    body = maker.body()
    if not body.joints:
        return
    mode = maker.one((_VELOCITY, _VELOCITY, _TORQUE, _POSITION, _POSITION, _POSITION, _PD))
    if maker.chance(0.7):
        joint = maker.link(body, base=False)
        maker.call("setJointMotorControl2", body.reference, joint, mode, **_command(maker, mode))
    else:
        _commands(maker, body, mode)


def _command(maker: Maker, mode: int) -> dict[str, Any]:
    if mode == _TORQUE:
        return {"force": maker.number(-20, 20)}
    keywords = maker.some(
        targetPosition=maker.number(-2, 2),
        targetVelocity=maker.number(-5, 5),
        force=maker.one((0, 1, 10, maker.positive(0.1, 500), -maker.positive(0.1, 500))),
        positionGain=maker.one((0, 0.1, 1, maker.share())),
        velocityGain=maker.one((0, 0.5, 1, 2, maker.share())),
        maxVelocity=maker.positive(0.1, 5),
    )
    if mode == _PD:
        keywords |= {"positionGain": maker.positive(0.1, 100), "velocityGain": maker.share()}
    return keywords


def _commands(maker: Maker, body: Body, mode: int) -> None:
    joints = [number for number, joint in enumerate(body.joints) if joint.type != SPHERICAL]
    joints = maker.random.sample(joints, maker.random.randint(0, len(joints)))
    if mode == _TORQUE:
        keywords: dict[str, Any] = {"forces": [maker.number(-20, 20) for _ in joints]}
    else:
        keywords = maker.some(
            targetPositions=[maker.number(-2, 2) for _ in joints],
            targetVelocities=[maker.number(-5, 5) for _ in joints],
            forces=[maker.positive(0.1, 100) for _ in joints],
            positionGains=[maker.share() for _ in joints],
            velocityGains=[maker.share() for _ in joints],
        )
    maker.call("setJointMotorControlArray", body.reference, joints, mode, **keywords)


def multi(maker: Maker) -> None:
    """Calls for joints of several degrees of freedom."""
    body = maker.one([body for body in maker.bodies if body.of_type(SPHERICAL)] or maker.bodies)
    if not body.joints:
        return
    balls = body.of_type(SPHERICAL)
    joint = maker.one(balls) if balls and maker.chance(0.8) else maker.link(body, base=False)
    ball = joint in balls
    position = maker.turn() if ball else [maker.number(-1, 1)]
    velocity = maker.vector(2) if ball else [maker.number(-1, 1)]
    kind = maker.random.randrange(6)
    if kind < 2:
        keywords = maker.some(targetVelocity=velocity)
        maker.call("resetJointStateMultiDof", body.reference, joint, position, **keywords)
    elif kind < 4:
        mode = maker.one((_POSITION, _POSITION, _VELOCITY, _PD))
        keywords = maker.some(
            targetVelocity=velocity,
            positionGain=maker.share(),
            velocityGain=maker.share(),
            force=[maker.positive(0.1, 50)] * (3 if ball else 1),
        )
        if mode != _VELOCITY:
            keywords["targetPosition"] = position
        maker.call("setJointMotorControlMultiDof", body.reference, joint, mode, **keywords)
    elif kind == 4:
        maker.call("getJointStatesMultiDof", body.reference, list(range(len(body.joints))))
    else:
        maker.call("getJointStateMultiDof", body.reference, joint)


def force(maker: Maker) -> None:
    """A force or a torque for the next step."""
    body, frame = maker.body(), maker.one((1, 2))
    link = maker.link(body)
    if maker.chance(0.6):
        maker.call("applyExternalForce", body.reference, link, maker.vector(20), maker.vector(0.5), frame)
    else:
        maker.call("applyExternalTorque", body.reference, link, maker.vector(3), frame)


def joint(maker: Maker) -> None:
    """Set joints, switch sensors, and let all joints go."""
    body = maker.body()
    if not body.joints:
        return
    kind = maker.random.randrange(6)
    if kind < 4:
        for _ in range(maker.one((1, 1, 4))):
            velocity = maker.some(targetVelocity=maker.number(-3, 3))
            link = maker.link(body, base=False)
            maker.call("resetJointState", body.reference, link, maker.number(-1.5, 1.5), **velocity)
    elif kind == 4:
        link = maker.link(body, base=False)
        maker.call("enableJointForceTorqueSensor", body.reference, link, maker.one((1, 1, 0)))
    else:
        joints = [number for number in body.moving if body.joints[number].type != SPHERICAL]
        maker.call("setJointMotorControlArray", body.reference, joints, _VELOCITY, forces=[0] * len(joints))


def reset(maker: Maker) -> None:
    """Set the pose or the velocity of a base."""
    body = maker.body()
    if maker.chance(0.5):
        maker.call("resetBasePositionAndOrientation", body.reference, maker.place(), maker.turn())
    else:
        keywords = maker.some(linearVelocity=maker.vector(3), angularVelocity=maker.vector(5))
        maker.call("resetBaseVelocity", body.reference, **keywords)
