"""Builds of CPython without native small calls: the way through Python does the same, and is announced."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import logging
import sys

logging.basicConfig(level=logging.INFO)
if {free}:
    sys.version += " free-threading build"
import pybullet as p
import pybullet_data

p.connect(p.DIRECT)
p.setAdditionalSearchPath(pybullet_data.getDataPath())
p.setGravity(0, 0, -9.81)
p.loadURDF("plane.urdf")
robot = p.loadURDF("r2d2.urdf", [0, 0, 0.6])
for _ in range(100):
    p.setJointMotorControl2(robot, 2, p.VELOCITY_CONTROL, targetVelocity=1, force=10)
    p.stepSimulation()
print(p.getBasePositionAndOrientation(robot), p.getJointState(robot, 2), p.getContactPoints(robot))
"""


def run(free: bool) -> tuple[str, str]:
    command = [sys.executable, "-c", SCRIPT.format(free=free)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return done.stdout, done.stderr


def test_a_free_threaded_build_gives_the_same_and_says_what_takes_more_time():
    usual, said = run(free=False)
    free, said_free = run(free=True)
    assert free == usual
    assert "small calls take the way through Python" in said_free
    assert "small calls" not in said
