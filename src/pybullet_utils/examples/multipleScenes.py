"""Two worlds in one process: `python -m pybullet_utils.examples.multipleScenes`."""

from __future__ import annotations

import pybullet
import pybullet_data
from pybullet_utils.bullet_client import BulletClient


def main() -> None:
    """Loads a robot into one world and a stadium into another, and prints the number of bodies in each."""
    robots, stadium = BulletClient(pybullet.DIRECT), BulletClient(pybullet.DIRECT)
    for world in (robots, stadium):
        world.setAdditionalSearchPath(pybullet_data.getDataPath())
    robots.loadURDF("r2d2.urdf")
    stadium.loadSDF("stadium.sdf")
    for name, world in (("robots", robots), ("stadium", stadium)):
        print(f"{name}: {world.getNumBodies()} bodies")


if __name__ == "__main__":
    main()
