"""What the helpers of scripts give in a few cases; the same under real PyBullet, where it is recorded.

.oracle/bin/python -m tests.script_helpers.scenes
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import pybullet as p
import pybullet_data
from pybullet_utils import transformations as transform
from pybullet_utils.pd_controller_stable import PDControllerStable, PDControllerStableMultiDof

RECORD = Path(__file__).with_name("pybullet.json")
AXES = ("sxyz", "rzyx", "syxz", "rzxz", "sxyx", "szyx", "ryzy")


def numbers() -> dict[str, list[float]]:
    """Named lists of numbers."""
    return {**_rotations(), **_torques_of_an_arm(), **_torques_of_a_humanoid()}


def _rotations() -> dict[str, list[float]]:
    first, second = (
        transform.quaternion_from_euler(0.1, 0.2, 0.3),
        transform.quaternion_about_axis(1, [1, 2, 3]),
    )
    result = {
        "product": transform.quaternion_multiply(first, second),
        "inverse": transform.quaternion_inverse(2.0 * second),
        "matrix": transform.quaternion_matrix(first),
        "from matrix": transform.quaternion_from_matrix(transform.quaternion_matrix(second)),
        "between": transform.quaternion_slerp(first, second, 0.3),
        "short way": transform.quaternion_slerp(first, -second, 0.3),
        "long way": transform.quaternion_slerp(first, -second, 0.3, shortestpath=False),
        "spun": transform.quaternion_slerp(first, second, 0.3, spin=1),
        "upright": transform.euler_from_quaternion(transform.quaternion_from_euler(0.3, np.pi / 2, 0.4)),
    }
    for axes in AXES:
        result[f"to {axes}"] = transform.quaternion_from_euler(0.4, 0.7, -1.1, axes)
        result[f"from {axes}"] = transform.euler_from_matrix(transform.quaternion_matrix(second), axes)
    return {name: np.ravel(values).tolist() for name, values in result.items()}


def _torques_of_an_arm() -> dict[str, list[float]]:
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    for joint in range(7):
        p.resetJointState(arm, joint, 0.1 * joint, 0.2)
    control = PDControllerStable(p)
    joints, aim = list(range(7)), [0.3] * 7
    soft = control.computePD(arm, joints, aim, [0.0] * 7, [400] * 7, [40] * 7, [500] * 7, 1 / 240)
    hard = control.computePD(arm, joints, aim, [0.1] * 7, [4000] * 7, [400] * 7, [50] * 7, 1 / 60)
    p.disconnect(client)
    return {"arm, soft": list(soft), "arm, hard": list(hard)}


def _torques_of_a_humanoid() -> dict[str, list[float]]:
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    body = p.loadURDF("humanoid/humanoid.urdf", [0, 0, 3], globalScaling=0.25)
    joints = [
        joint for joint in range(p.getNumJoints(body)) if p.getJointInfo(body, joint)[2] != p.JOINT_FIXED
    ]
    aim = [0.1, 0.2, 3.1, 0.0, 0.0998334, 0.0, 0.9950042]
    for joint in joints:
        if p.getJointInfo(body, joint)[2] == p.JOINT_SPHERICAL:
            turn = [0.1, 0.02 * joint, -0.1, 1.0]
            turn = (np.array(turn) / np.linalg.norm(turn)).tolist()
            p.resetJointStateMultiDof(body, joint, turn, [0.1, 0.2, 0.3])
            aim += p.getQuaternionFromEuler([0.3, 0.1, 0.03 * joint])
        else:
            p.resetJointState(body, joint, 0.03 * joint, 0.2)
            aim.append(0.1)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [0.4, 0.5, 0.6])
    control, count = PDControllerStableMultiDof(p), len(aim)
    free = [0] * 7
    gains = free + [300] * (count - 7), free + [30] * (count - 7)
    loose = control.computePD(body, joints, aim, [0] * count, *gains, [200] * count, 1 / 240)
    held = control.computePD(
        body, joints, aim, [0.1] * count, [500] * count, [50] * count, [1e5] * count, 1 / 60
    )
    p.disconnect(client)
    return {"humanoid, loose": list(loose), "humanoid, held": list(held)}


if __name__ == "__main__":
    RECORD.write_text(json.dumps(numbers(), indent=1) + "\n")
