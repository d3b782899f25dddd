"""Watch blocks fall in a window, and keep a picture."""

import sys

import carom

world = carom.World(gravity=(0, 0, -9.81))
world.add_plane()
for number in range(5):
    world.add_box((0.1, 0.1, 0.1), (0, 0.02 * number, 0.3 + 0.3 * number))
if "--headless" not in sys.argv:
    world.view()
world.step(480)
camera = carom.Camera.with_field_of_view(640, 480, 50).look_at((2, 2, 1.5), (0, 0, 0.5))
world.image(camera).save("blocks.png")
