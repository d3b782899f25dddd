"""Let a quadruped stand as its keyframe says."""

import carom
from carom.examples import robot_file

world = carom.World()
robot = world.load(robot_file("quadruped.xml"))["trunk"]
world.reset("stand")
world.step(1000)
print(robot.pose)
