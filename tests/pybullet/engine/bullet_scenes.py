"""Scenes whose state real PyBullet saved: the files and its answers are in `bullet_files`.

`python bullet_scenes.py` with PyBullet instead of Carom records them anew.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pybullet as p

FILES = Path(__file__).with_name("bullet_files")
ANSWERS = FILES / "answers.json"
STEPS = 25


def arms() -> None:
    """Two robots, one with a fixed base, and a body whose place another takes."""
    p.setGravity(0, 0, -9.8)
    gone = _ball(-5.0)
    p.loadURDF(str(FILES / "arm.urdf"), [0, 0, 2], [0.1, 0.2, 0.3, 0.9])
    p.loadURDF(str(FILES / "arm.urdf"), [3, 0, 2], useFixedBase=True)
    _ball(6.0)
    p.removeBody(gone)


def maximal() -> None:
    """Bodies with reduced and with maximal coordinates, in turns."""
    for number in range(4):
        _ball(float(number), maximal=number % 2)


SCENES: dict[str, Callable[[], None]] = {"arms": arms, "maximal": maximal}


def _ball(x: float, maximal: int = 0) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    return p.createMultiBody(
        1.0,
        shape,
        basePosition=[x, 0, 1],
        baseInertialFramePosition=[0.01, 0.02, 0],
        useMaximalCoordinates=maximal,
    )


def move() -> None:
    """Give every body another place, turn and velocity, and every joint another state."""
    for serial in range(p.getNumBodies()):
        body = p.getBodyUniqueId(serial)
        turn = p.getQuaternionFromEuler([0.4 + serial, -0.3, 2.0 * serial])
        p.resetBasePositionAndOrientation(body, [serial, 0.5, 3.0 + serial], turn)
        p.resetBaseVelocity(body, [0.1, 0.2 * serial, -0.3], [0.5, -0.4, 0.3 + serial])
        for joint in range(p.getNumJoints(body)):
            kind = list(p.getJointInfo(body, joint) or ())[2]
            if kind == p.JOINT_SPHERICAL:
                p.resetJointStateMultiDof(
                    body, joint, p.getQuaternionFromEuler([0.3, 0.2, serial]), [1, -2, 0.5]
                )
            elif kind != p.JOINT_FIXED:
                p.resetJointState(body, joint, 0.2 + 0.1 * joint, -0.3)
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
            if kind == p.JOINT_SPHERICAL:
                p.setJointMotorControlMultiDof(
                    body, joint, p.POSITION_CONTROL, targetPosition=[0, 0, 0, 1], force=[0, 0, 0]
                )


def told() -> list[Any]:
    """What PyBullet says about every body."""
    answers: list[Any] = []
    for serial in range(p.getNumBodies()):
        body = p.getBodyUniqueId(serial)
        joints = range(p.getNumJoints(body))
        answers.append(
            [
                p.getBasePositionAndOrientation(body),
                p.getBaseVelocity(body),
                [p.getJointStateMultiDof(body, joint)[:2] for joint in joints],
                [(p.getLinkState(body, joint, 1) or ())[:8] for joint in joints],
            ]
        )
    return answers


def run() -> list[Any]:
    """What PyBullet says after some steps."""
    for _ in range(STEPS):
        p.stepSimulation()
    return told()


def _record() -> None:
    p.connect(p.DIRECT)
    answers = {}
    for name, scene in SCENES.items():
        p.resetSimulation()
        scene()
        move()
        run()
        p.saveBullet(str(FILES / f"{name}.bullet"))
        p.resetSimulation()
        scene()
        for serial in range(p.getNumBodies()):
            body = p.getBodyUniqueId(serial)
            for joint in range(p.getNumJoints(body)):
                p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
        p.restoreState(fileName=str(FILES / f"{name}.bullet"))
        answers[name] = {"restored": told(), "later": run()}
    lines = [f"{json.dumps(name)}: {json.dumps(there)}" for name, there in answers.items()]
    ANSWERS.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    _record()
