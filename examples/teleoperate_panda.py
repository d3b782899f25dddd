"""Teleoperation: the Panda's hand follows a handle that the mouse or the left stick of a gamepad moves."""

import math

import pybullet_data
from carom import World
from carom.algorithms import inverse_kinematics
from carom.viewer import Viewer

HOME = [0, -0.4, 0, -2.2, 0, 1.9, 0.8, 0.04, 0.04]


def load():
    world = World()
    world.gravity = (0, 0, -9.81)
    arm = world.load_urdf(pybullet_data.getDataPath() + "/franka_panda/panda.urdf", fixed_base=True)
    arm.joints.reset(HOME)
    return world, arm


def teleoperate(world, arm, viewer, duration=math.inf):
    hand = arm.links["panda_grasptarget"]
    lower, upper = arm.joints.limits
    goal = viewer.handle("goal", *hand.pose)
    opening = viewer.slider("fingers [m]", 0, 0.04, 0.04)
    while viewer.is_open and world.time < duration:
        fingers = opening.value
        for pad in viewer.gamepads():
            right, down, *_ = pad.axes
            x, y, z = goal.position
            if math.hypot(right, down) > 0.1:
                goal.move_to((x - 0.001 * down, y - 0.001 * right, z))
            fingers = 0 if pad.pressed(0) else fingers
        found = inverse_kinematics(
            arm, [hand.index], [goal.position], [goal.orientation], lower=lower, upper=upper
        )
        arm.joints.set_position_targets([*found.positions[:7], fingers, fingers], max_velocities=2)
        world.step()


if __name__ == "__main__":
    world, arm = load()
    viewer = Viewer(world)
    viewer.set_speed(1.0)
    viewer.open_browser()
    print("The simulation is shown at", viewer.address)
    teleoperate(world, arm, viewer)
