"""The scene in which every call is made, and what its parts are called."""

from __future__ import annotations

from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
ROBOTS = "<repo>/tests/pybullet/robots"
DATA = "<repo>/src/pybullet_data"

PLANE, ZOO, ARM, BALL, CRATE, LAMP = range(6)
"""The bodies."""
SHOULDER, DRAWER, WELD, SOCKET, AXLE = range(5)
"""The joints of the zoo: turning, sliding, fixed, ball, and turning without end."""
ARM_JOINTS = (0, 1, 2)
NO_BODY = 99
HANG = 1
"""The constraint."""
SPARE_SPHERE, SPARE_BOX = 0, 1
"""Collision shapes that no body has."""
SPARE_LOOK = 2
"""A visual shape that no body has."""
COLOUR = 0
"""User data of the zoo."""
CHECKER = 0
"""A texture."""

UPRIGHT = (0.0, 0.0, 0.0, 1.0)
TILTED = (0.0, 0.6, 0.0, 0.8)


def build(p: Any) -> None:
    """Make the scene in a new connection."""
    robots = ROOT / "tests" / "pybullet" / "robots"
    p.setGravity(0, 0, -9.8)
    p.createCollisionShape(p.GEOM_SPHERE, radius=0.2)
    p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    p.createVisualShape(p.GEOM_SPHERE, radius=0.2, rgbaColor=[1, 0, 0, 1])
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE), basePosition=[0, 0, -10])
    p.loadURDF(str(robots / "zoo.urdf"), [0, 0, 1], useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)
    p.loadURDF(str(robots / "arm.urdf"), [3, 0, 1], useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.25)
    p.createMultiBody(1.5, ball, basePosition=[-2, 0, -9.75])
    crate = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2, 0.3, 0.4])
    crate_look = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.2, 0.3, 0.4], rgbaColor=[0, 0.5, 1, 1])
    p.createMultiBody(2, crate, crate_look, [0, 3, 5], TILTED)
    lamp = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    p.createMultiBody(0.5, lamp, basePosition=[0, -3, 4])
    p.createConstraint(LAMP, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0.3], [0, -3, 4.3])
    p.addUserData(ZOO, "colour", "green")
    p.loadTexture(str(ROOT / "src" / "pybullet_data" / "checker_blue.png"))
    p.resetJointState(ZOO, SHOULDER, 0.3, 0.5)
    p.resetJointState(ARM, 1, 0.4)
    p.setJointMotorControlArray(ARM, ARM_JOINTS, p.VELOCITY_CONTROL, forces=[0, 0, 0])
    p.resetBaseVelocity(CRATE, [0.1, 0.2, 0.3], [0.3, -0.2, 0.1])
    p.stepSimulation()
