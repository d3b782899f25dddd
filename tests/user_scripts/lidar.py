"""Rays around a rover, what it touches, and what is near it."""

import math

import pybullet as p
import pybullet_data

CLEAR = 0.8


def scan(body: int, rays: int, reach: float) -> list[float]:
    (x, y, z), _ = p.getBasePositionAndOrientation(body)
    angles = [2 * math.pi * ray / rays for ray in range(rays)]
    # From beyond the rover's own parts.
    starts, ends = (
        [[x + far * math.cos(angle), y + far * math.sin(angle), z + 0.3] for angle in angles]
        for far in (CLEAR, reach)
    )
    hits = p.rayTestBatch(starts, ends, numThreads=0)
    return [CLEAR + fraction * (reach - CLEAR) for _, _, fraction, _, _ in hits]


def main(rays: int = 36) -> tuple[float, int]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    ground = p.loadURDF("plane.urdf")
    rover = p.loadURDF("husky/husky.urdf", [0, 0, 0.1])
    wall = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 2, 1])
    p.createMultiBody(0, wall, basePosition=[2, 0, 1])
    for _ in range(60):
        p.stepSimulation()
    wheels = {point[3] for point in p.getContactPoints(rover, ground)}
    for point in p.getClosestPoints(rover, ground, 0.5):
        normal, distance, force = point[7], point[8], point[9]
        assert len(normal) == 3 and distance < 0.5 and force == 0.0
    for body, link in p.getOverlappingObjects(*p.getAABB(rover)) or ():
        assert body >= 0 and link >= -1
    nearest = min(scan(rover, rays, 5.0))
    p.disconnect()
    return nearest, len(wheels)


if __name__ == "__main__":
    print(main())
