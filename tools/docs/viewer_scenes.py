"""Programs whose pages are in the docs: `python tools/docs/viewer_scenes.py panda`, `mirror` or `crowd`."""

from __future__ import annotations

import math
import sys
import time

import pybullet as p
import pybullet_data

ARM, ELBOW, HAND = 7, 3, 8
REST = [0.4, -0.2, 0.1, -2.1, 0.1, 1.9, 0.9]
TIME_STEP = 1 / 240


def connect(title: str) -> None:
    """Opens the window. The page has the name of the script."""
    sys.argv[0] = title
    p.connect(p.GUI, options="--port=0")
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)


def panda() -> None:
    """A Panda that swings, with sliders, a drawn frame, and a camera."""
    connect("panda.py")
    p.loadURDF("plane.urdf")
    arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    p.loadURDF("r2d2.urdf", [-0.7, 0.9, 0.5], p.getQuaternionFromEuler([0, 0, -0.6]))
    for position in ([0.55, -0.3, 0.03], [0.62, -0.22, 0.03], [0.58, -0.26, 0.09]):
        p.loadURDF("cube_small.urdf", position)
    p.loadURDF("duck_vhacd.urdf", [0.65, 0.2, 0.05], p.getQuaternionFromEuler([math.pi / 2, 0, 1]))
    for joint, angle in enumerate(REST):
        p.resetJointState(arm, joint, angle)
    for name, lower, upper, value in (("kp", 0, 1, 0.3), ("kd", 0, 2, 1), ("amplitude [rad]", 0, 1, 0.35)):
        p.addUserDebugParameter(name, lower, upper, value)
    p.addUserDebugParameter("reset", 1, 0, 0)
    p.addUserDebugText(
        "hand", [0, 0, 0.12], [1, 0.85, 0.3], 1.2, parentObjectUniqueId=arm, parentLinkIndex=HAND
    )
    for axis in range(3):
        unit = [float(axis == i) for i in range(3)]
        tip = [0.15 * x for x in unit]
        p.addUserDebugLine([0, 0, 0], tip, unit, 4, parentObjectUniqueId=arm, parentLinkIndex=HAND)
    p.resetDebugVisualizerCamera(1.25, 62, -22, [0.25, 0.1, 0.35])
    step = 0
    while p.isConnected():
        swing = 0.35 * math.sin(step / 120)
        targets = [angle + swing * (joint in (1, ELBOW)) for joint, angle in enumerate(REST)]
        gains = [0.05] * ARM
        p.setJointMotorControlArray(arm, range(ARM), p.POSITION_CONTROL, targets, positionGains=gains)
        p.stepSimulation()
        if step % 240 == 0:
            view = p.computeViewMatrix([1.3, -0.9, 0.9], [0.3, 0, 0.25], [0, 0, 1])
            p.getCameraImage(320, 240, view, p.computeProjectionMatrixFOV(50, 4 / 3, 0.05, 6))
        step += 1
        time.sleep(TIME_STEP)


def mirror() -> None:
    """Robots on a floor that mirrors them."""
    connect("mirror.py")
    floor = p.loadURDF("plane.urdf")
    p.changeVisualShape(floor, -1, rgbaColor=[1, 1, 1, 0.7])
    p.configureDebugVisualizer(p.COV_ENABLE_PLANAR_REFLECTION, 1)
    kuka = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    for joint, angle in enumerate([0.3, 0.6, 0, -1.3, 0, 0.9, 0]):
        p.resetJointState(kuka, joint, angle)
    p.loadURDF("r2d2.urdf", [-0.8, 0.9, 0.48], p.getQuaternionFromEuler([0, 0, -0.9]))
    p.loadURDF(
        "duck_vhacd.urdf", [0.9, 0.3, 0.02], p.getQuaternionFromEuler([math.pi / 2, 0, 1]), globalScaling=3
    )
    p.loadURDF("soccerball.urdf", [0.6, -0.6, 0.12], globalScaling=0.24)
    p.resetDebugVisualizerCamera(1.7, 55, -16, [0.1, 0.15, 0.35])
    while p.isConnected():
        time.sleep(0.1)


def crowd() -> None:
    """A thousand boxes, balls and cylinders that fall in a heap."""
    connect("crowd.py")
    p.loadURDF("plane.urdf")
    collisions = [
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.05, 0.05]),
        p.createCollisionShape(p.GEOM_SPHERE, radius=0.06),
        p.createCollisionShape(p.GEOM_CYLINDER, radius=0.05, height=0.1),
    ]
    for n in range(1000):
        hue = n / 1000
        colour = [0.55 + 0.45 * math.cos(2 * math.pi * (hue + shift)) for shift in (0, 1 / 3, 2 / 3)]
        place = [0.16 * (n % 10 - 4.5), 0.16 * (n // 10 % 10 - 4.5), 0.3 + 0.17 * (n // 100)]
        body = p.createMultiBody(0.2, collisions[n % 3], -1, place)
        p.changeVisualShape(body, -1, rgbaColor=[*colour, 1])
    p.resetDebugVisualizerCamera(3.2, 40, -28, [0, 0, 0.35])
    while p.isConnected():
        p.stepSimulation()


SCENES = {scene.__name__: scene for scene in (panda, mirror, crowd)}

if __name__ == "__main__":
    SCENES[sys.argv[1]]()
