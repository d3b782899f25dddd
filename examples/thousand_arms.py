"""A thousand Pandas at once: the same scene a thousand times, each arm with a target of its own."""

import time

import numpy as np

import pybullet_data
from carom import World, Worlds

PANDA = f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf"
HOME = np.array([0.0, 0.3, 0.0, -2.1, 0.0, 2.4, 0.785, 0.04, 0.04])


def main(count=1000, duration=1.0):
    world = World(time_step=1 / 240)
    world.gravity = (0, 0, -9.81)
    # All links have the same inertia in it, a placeholder; as in PyBullet, that of the shapes is used.
    panda = world.load_urdf(PANDA, fixed_base=True, as_pybullet=True)

    worlds = Worlds(world, count)
    arms = worlds[panda]
    arms.joints.positions = HOME
    start = worlds.snapshot()

    random = np.random.default_rng(0)
    targets = HOME + random.uniform(-0.4, 0.4, (count, 9)) * (np.arange(9) < 7)
    arms.joints.set_position_targets(targets, gains=0.2)
    began = time.perf_counter()
    steps = round(duration * 240)
    worlds.step(steps)
    rate = count * steps / (time.perf_counter() - began)
    error = np.abs(arms.joints.positions - targets).max(axis=1)
    print(f"{rate:,.0f} steps of a world per second; joints off by {np.degrees(error.max()):.2f} degrees")

    # Every other world goes back to the start; the others stay where they are.
    back = np.arange(count) % 2 == 0
    worlds.restore(start, where=back)
    away = np.abs(arms.joints.positions - HOME).max(axis=1)
    print(f"after the restore {np.count_nonzero(away == 0)} arms are at home")

    # Number 7 as a world of its own, which goes on exactly as that one does.
    lone = worlds.extract(7)
    lone.step()
    worlds.step()
    same = lone.bodies[panda.id].joints.positions == arms.joints.positions[7]
    print(f"world 7 alone is the same: {bool(same.all())}")
    return {"error": error, "away": away, "same": bool(same.all())}


if __name__ == "__main__":
    main()
