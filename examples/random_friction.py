"""Push a brick in 512 worlds, with another friction in each."""

import numpy as np

import carom

world = carom.World(gravity=(0, 0, -9.81))
world.add_plane(friction=1)
brick = world.add_box((0.1, 0.1, 0.02), (0, 0, 0.02))
worlds = carom.Worlds(world, 512)
bricks = worlds[brick]
friction = np.random.default_rng(0).uniform(0.1, 0.8, 512)
bricks.shapes[0].friction = friction
bricks.set_velocity((2, 0, 0))
worlds.step(500)
slid = bricks.pose.position[:, 0]
print((slid * friction).mean())
