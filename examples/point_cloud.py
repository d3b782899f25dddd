"""Take the points of a duck that a camera sees."""

import carom

world = carom.World()
world.add_plane()
duck = world.add_mesh("duck.obj", (0, 0, 0.1), scale=0.1, name="duck")
camera = carom.Camera.with_field_of_view(320, 240, 45).look_at((1, 0, 0.6), (0, 0, 0.1))
cloud = world.image(camera).point_cloud()
points = cloud.points[cloud.bodies == duck.id]
print(points.shape, points.mean(axis=0))
