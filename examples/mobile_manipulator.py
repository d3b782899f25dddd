"""A Panda on a base that drives in the plane: tasks say what the hand does, a QP finds how.

The hand moves on a circle that the arm alone cannot reach, and keeps its orientation; the robot avoids a
ball. Needs a QP solver: `pip install 'carom[control]'`.
"""

import tempfile
import time
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

import pybullet_data
from carom import World
from carom.controllers import (
    CollisionAvoidanceLimit,
    Configuration,
    ConfigurationLimit,
    FrameTask,
    PostureTask,
    TaskIK,
    VelocityLimit,
)
from carom.examples.window import wants_window
from carom.viewer import Viewer

PANDA = Path(pybullet_data.getDataPath()) / "franka_panda" / "panda.urdf"
READY = np.array([0.0, 0.0, 0.0, 0.0, -0.4, 0.0, -2.0, 0.0, 1.7, 0.8, 0.02, 0.02])
DOWN = (1.0, 0.0, 0.0, 0.0)
TIME_STEP = 1 / 120
BASE = (
    ("drive_x", "prismatic", "1 0 0", "ground", "slide_x"),
    ("drive_y", "prismatic", "0 1 0", "slide_x", "slide_y"),
    ("turn", "revolute", "0 0 1", "slide_y", "panda_link0"),
)


def write_robot(path):
    """A copy of the Panda's file, with three joints between the ground and the arm."""
    robot = ElementTree.parse(PANDA).getroot()
    robot.set("name", "mobile_panda")
    for mesh in robot.iter("mesh"):
        mesh.set("filename", str(PANDA.parent / mesh.get("filename").removeprefix("package://")))
    for name in ("ground", "slide_x", "slide_y"):
        inertial = ElementTree.SubElement(ElementTree.SubElement(robot, "link", name=name), "inertial")
        ElementTree.SubElement(inertial, "mass", value="10")
        ElementTree.SubElement(inertial, "inertia", ixx="1", iyy="1", izz="1", ixy="0", ixz="0", iyz="0")
    for name, kind, axis, parent, child in BASE:
        joint = ElementTree.SubElement(robot, "joint", name=name, type=kind)
        ElementTree.SubElement(joint, "parent", link=parent)
        ElementTree.SubElement(joint, "child", link=child)
        ElementTree.SubElement(joint, "axis", xyz=axis)
        ElementTree.SubElement(joint, "limit", lower="-5", upper="5", effort="2000", velocity="2")
    ElementTree.ElementTree(robot).write(path)


def make_world():
    world = World(TIME_STEP)
    world.gravity = (0, 0, -9.81)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mobile_panda.urdf"
        write_robot(path)
        robot = world.load_urdf(path, fixed_base=True)
    robot.joints.reset(READY[-len(robot.joints.movable) :])
    ball = world.add_sphere(0.15, (1.0, 0.0, 0.4), mass=0.0)
    return world, robot, ball


def make_ik(robot, ball):
    configuration = Configuration(robot)
    links = {link.name: link.index for link in robot.links}
    hand = FrameTask(links["panda_hand"], (0.6, 0.0, 0.5), DOWN)
    arm = [(robot.id, links[f"panda_link{number}"]) for number in range(2, 8)]
    avoid = CollisionAvoidanceLimit(
        configuration,
        [([*arm, (robot.id, links["panda_hand"])], [(ball.id, -1)])],
        minimum_distance=0.03,
        detection_distance=0.2,
    )
    # The base moves only where the arm does not suffice.
    posture = PostureTask(configuration.positions, [0.02] * 3 + [0.05] * 9)
    limits = [ConfigurationLimit(configuration), VelocityLimit(1.5), avoid]
    return TaskIK(configuration, [hand, posture], limits), hand, avoid


def main(duration=12.0, window=False):
    record = {"time": [], "error": [], "distance": [], "base": []}
    world, robot, ball = make_world()
    ik, hand, avoid = make_ik(robot, ball)
    link = next(link for link in robot.links if link.name == "panda_hand")
    viewer = Viewer(world, title="Mobile manipulator") if window else None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
    while world.time < duration and (viewer is None or viewer.is_open):
        angle = 0.6 * max(world.time - 1.0, 0.0)
        goal = np.array((1.0 - 0.3 * np.cos(angle), 0.3 * np.sin(angle), 0.5))
        hand.move(goal, DOWN)
        ik.configuration.follow(keep=True)
        ik.tick(TIME_STEP)
        robot.joints.set_position_targets(ik.configuration.positions, gains=0.5, max_forces=3000.0)
        world.step()
        error = float(np.linalg.norm(link.pose.position - goal))
        distance = min(avoid.distances(ik.configuration), default=0.2)
        if viewer is not None:
            viewer.plot("error of the hand [m]", error)
            viewer.plot("distance to the ball [m]", distance)
            time.sleep(TIME_STEP)
        base = robot.joints.positions[:2].tolist()
        for name, value in zip(record, (world.time, error, distance, base), strict=True):
            record[name].append(value)
    if viewer is not None:
        viewer.close()
    print(f"nearest to the ball: {min(record['distance']):.3f} m; last error {record['error'][-1]:.4f} m")
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=float("inf") if wants_window() else 12.0)
