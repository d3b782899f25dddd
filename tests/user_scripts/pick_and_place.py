"""A Panda that reaches for a cube, holds it by a constraint and lifts it."""

from collections.abc import Sequence

import numpy as np

import pybullet as p
import pybullet_data
from pybullet_utils import bullet_client


class Panda:
    """The arm, its joints and its hand."""

    hand = 11
    home = (0.0, -0.2, 0.0, -2.2, 0.0, 2.0, 0.8)

    def __init__(self, client: bullet_client.BulletClient) -> None:
        self.client = client
        self.body = client.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
        infos = [p.getJointInfo(self.body, joint) for joint in range(p.getNumJoints(self.body))]
        movable = [info for info in infos if info[2] != p.JOINT_FIXED]
        self.joints = [info[0] for info in movable]
        self.lower = np.array([info[8] for info in movable])
        self.upper = np.array([info[9] for info in movable])
        for joint, angle in zip(self.joints, self.home, strict=False):
            p.resetJointState(self.body, joint, angle)

    def reach(self, position: Sequence[float], steps: int = 240) -> float:
        down = p.getQuaternionFromEuler([np.pi, 0, 0])
        targets = p.calculateInverseKinematics(
            self.body,
            self.hand,
            position,
            down,
            lowerLimits=self.lower.tolist(),
            upperLimits=self.upper.tolist(),
            jointRanges=(self.upper - self.lower).tolist(),
            restPoses=[*self.home, 0.02, 0.02],
            maxNumIterations=100,
        )
        p.setJointMotorControlArray(
            self.body, self.joints, p.POSITION_CONTROL, targetPositions=targets, forces=[200.0] * len(targets)
        )
        for _ in range(steps):
            p.stepSimulation()
        state = p.getLinkState(self.body, self.hand, computeForwardKinematics=True)
        assert state is not None
        return float(np.linalg.norm(np.subtract(state[4], position)))


def main() -> tuple[float, float]:
    client = bullet_client.BulletClient(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    cube = p.loadURDF("cube_small.urdf", [0.5, 0, 0.025])
    panda = Panda(client)
    error = panda.reach([0.5, 0.0, 0.1])
    grip = p.createConstraint(
        panda.body, panda.hand, cube, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0.05], [0, 0, 0]
    )
    p.changeConstraint(grip, maxForce=50)
    panda.reach([0.4, 0.2, 0.5])
    height = p.getBasePositionAndOrientation(cube)[0][2]
    p.removeConstraint(grip)
    client.disconnect()
    return error, height


if __name__ == "__main__":
    print(main())
