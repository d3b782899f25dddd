"""The modern interface: bodies from shapes, kinematics, rays, cameras and many worlds."""

import numpy as np
from numpy.typing import NDArray

from carom import Camera, World, Worlds
from carom.algorithms import forward_kinematics, inverse_kinematics, jacobian, mass_matrix
from carom.render.lights import Light

TARGET = (0.5, 0.1, 0.5)
COUNT = 4


def main() -> tuple[float, float, int]:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.add_plane(colour=(0.4, 0.5, 0.4))
    red = world.add_box((0.05, 0.05, 0.05), (0.6, 0.0, 0.05), mass=0.2, colour=(1.0, 0.0, 0.0))
    world.add_sphere(0.05, (0.6, 0.3, 0.05), mass=0.1, colour=(0.0, 0.0, 1.0, 1.0))
    arm = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)

    hand = arm.links["panda_hand"].index
    found = inverse_kinematics(arm, [hand], [TARGET])
    assert found.success, found.residual
    arm.joints.reset(found.positions)
    (pose,) = forward_kinematics(arm, found.positions, [hand])
    away: NDArray[np.float64] = np.subtract(pose.position, TARGET)
    linear, _angular = jacobian(arm, hand, (0.0, 0.0, 0.0), found.positions)
    assert linear.shape[1] == mass_matrix(arm, found.positions).shape[0]

    hit = world.queries().cast_ray((0.6, 0.0, 1.0), (0.6, 0.0, -1.0))
    assert hit.success
    assert hit.body == red.id
    height: float = hit.position[2]

    with world.log("position", every=2) as log:
        world.step(10)
    times: NDArray[np.float64] = log["time"]
    assert len(times) == 5

    camera = Camera.with_field_of_view(84, 84, 60.0, light=Light()).look_at((1.5, 0.0, 1.0), (0.5, 0.0, 0.2))
    assert camera.capture(world).names()["box/base"] > 0
    worlds = Worlds(world, COUNT)
    colour: NDArray[np.uint8] = worlds.images(camera).colour
    return float(np.abs(away).max()), height, len(colour)
