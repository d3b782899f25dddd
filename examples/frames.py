"""Frames and quaternions: where the tip of a gripper is in the world, in three ways that agree."""

import math

import numpy as np

import pybullet as p
import pybullet_data

HAND = 8


def main():
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    turn = p.getQuaternionFromEuler([0, 0, math.radians(90)])
    panda = p.loadURDF("franka_panda/panda.urdf", [1, 0, 0], turn, useFixedBase=True)
    p.resetJointState(panda, 1, -0.5)
    # In the link frame of the hand, 10 cm ahead of it.
    tip = [0, 0, 0.1]

    # [4:6] is the link frame of the file, [0:2] the inertial frame, whose origin is the centre of mass.
    state = p.getLinkState(panda, HAND, computeForwardKinematics=1)
    position, orientation = state[4], state[5]
    composed, _ = p.multiplyTransforms(position, orientation, tip, [0, 0, 0, 1])

    rotation = np.reshape(p.getMatrixFromQuaternion(orientation), (3, 3))
    by_matrix = rotation @ tip + position

    # A pose in the hand's frame, seen from the base: the inverse of one, then the other.
    base = p.getBasePositionAndOrientation(panda)
    to_base = p.invertTransform(*base)
    seen, _ = p.multiplyTransforms(*to_base, composed, [0, 0, 0, 1])
    back, _ = p.multiplyTransforms(*base, seen, [0, 0, 0, 1])

    euler = [round(math.degrees(angle), 1) for angle in p.getEulerFromQuaternion(orientation)]
    print("tip in the world:", np.round(composed, 4))
    print("tip from the base:", np.round(seen, 4))
    print("hand: roll, pitch, yaw in degrees", euler)
    p.disconnect()
    return {"composed": composed, "by matrix": by_matrix, "back": back}


if __name__ == "__main__":
    main()
