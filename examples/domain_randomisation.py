"""One push, a thousand cubes that differ: how far they slide depends on friction, and on nothing else."""

import numpy as np

import pybullet_data
from carom import World, Worlds

SPEED = 2.0


def main(count=1000):
    world = World(time_step=1 / 240)
    assets = pybullet_data.getDataPath()
    floor = world.load_urdf(f"{assets}/plane.urdf")
    cube = world.load_urdf(f"{assets}/cube_small.urdf")
    floor.change_dynamics(-1, lateral_friction=1.0)

    worlds = Worlds(world, count)
    random = np.random.default_rng(0)
    friction, mass = random.uniform(0.2, 0.8, count), random.uniform(0.05, 1.0, count)
    gravity = np.zeros((count, 3))
    gravity[:, 2] = -9.81 + random.uniform(-0.5, 0.5, count)

    cubes = worlds[cube]
    cubes.change_dynamics(-1, lateral_friction=friction, mass=mass)
    worlds.gravity = gravity
    cubes.pose = (0.0, 0.0, 0.025), (0.0, 0.0, 0.0, 1.0)
    cubes.velocity = (SPEED, 0.0, 0.0), (0.0, 0.0, 0.0)
    worlds.step(480)

    distance = np.linalg.norm(cubes.pose.position[:, :2], axis=1)
    expected = SPEED**2 / (2.0 * friction * -gravity[:, 2])
    touching = worlds.contacts(cube, floor)
    print(f"cubes slid {distance.min():.2f} to {distance.max():.2f} m")
    print(f"as friction has it to within {100 * np.abs(distance / expected - 1).max():.1f} %")
    print(f"{np.count_nonzero(touching.touching)} lie on the floor, which bears their weight")
    weight = touching.forces[:, 2]

    # Every other cube comes onto ice and is pushed again; `where` leaves the others alone.
    icy = np.arange(0, count, 2)
    cubes.change_dynamics(-1, lateral_friction=random.uniform(0.05, 0.1, len(icy)), where=icy)
    cubes.set_velocity((SPEED, 0.0, 0.0), where=icy)
    worlds.step(240)
    farther = np.linalg.norm(cubes.pose.position[:, :2], axis=1) - distance
    kept = np.count_nonzero(cubes.dynamics(-1)["lateral_friction"] == friction)
    print(f"on ice {len(icy)} slid {farther[icy].min():.2f} m farther at least")
    print(f"{kept} have the friction they had")
    bears = mass * -gravity[:, 2]
    return {"distance": distance, "expected": expected, "weight": weight, "bears": bears, "farther": farther}


if __name__ == "__main__":
    main()
