"""Frames and quaternions: where the tip of a gripper is in the world, in three ways that agree.

In the window a slider bends the arm; the frame at the tip has a red x, a green y and a blue z axis.
"""

import math

import numpy as np

import pybullet as p
import pybullet_data
from carom.examples.window import connect, slider, steps, wants_window

HAND = 8


def show_frame(position, orientation, numbers):
    """Draws the three axes of a frame, 20 cm long, in place of those with these numbers."""
    axes = np.reshape(p.getMatrixFromQuaternion(orientation), (3, 3)).T
    return [
        p.addUserDebugLine(
            position, position + 0.2 * axis, colour, 4, **({"replaceItemUniqueId": old} if numbers else {})
        )
        for axis, colour, old in zip(axes, np.eye(3), numbers or [-1] * 3, strict=True)
    ]


def play(panda, tip):
    """The slider bends the shoulder until ESC."""
    shoulder, lines = slider("shoulder [rad]", -1.5, 1.5, -0.5), []
    for _ in steps(math.inf, True):
        p.resetJointState(panda, 1, shoulder())
        position, orientation = p.getLinkState(panda, HAND, computeForwardKinematics=1)[4:6]
        lines = show_frame(
            p.multiplyTransforms(position, orientation, tip, [0, 0, 0, 1])[0], orientation, lines
        )


def main(window=False):
    connect(window)
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
    if window:
        play(panda, tip)
    p.disconnect()
    return {"composed": composed, "by matrix": by_matrix, "back": back}


if __name__ == "__main__":
    main(window=wants_window())
