"""Save a world in motion, reset it, and go on from the file as if nothing had happened."""

import numpy as np

import carom

world = carom.World(gravity=(0, 0, -9.81))
world.add_plane()
cube = world.add_box((0.1, 0.1, 0.1), (0, 0, 1), (0.3, 0.2, 0.1, 0.9))
world.step(100)
world.save("falling.carom")
with world.record("falling.html"):
    world.step(200)
end = cube.pose

world.reset()
print(world.time, cube.pose.position)

again = carom.World()
again.load("falling.carom")
again.step(200)
print(np.array_equal(again["box"].pose.position, end.position))
