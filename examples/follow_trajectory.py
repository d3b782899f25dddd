"""Move a Panda along a path with the torques that the motion needs, and a little correction."""

import numpy as np

import carom

world = carom.World(gravity=(0, 0, -9.81), time_step=0.001)
panda = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
joints = panda.joints
start = [0, -0.4, 0, -2.2, 0, 1.9, 0.8, 0.02, 0.02]
goal = [1, 0.2, 0.3, -1.6, 0.4, 2.2, 0.2, 0.02, 0.02]
path = carom.control.QuinticTrajectory(start, goal, duration=2)
joints.positions = start
largest = 0.0
while world.time < 2:
    wanted = path.sample(world.time)
    error = wanted.position - joints.positions
    correction = 100 * error + 20 * (wanted.velocity - joints.velocities)
    joints.torques = panda.inverse_dynamics(wanted.acceleration + correction)
    world.step()
    largest = max(largest, np.abs(error).max())
print(largest)
