"""Records what PyBullet reports for rays that graze convex shapes; run it with PyBullet."""

import json
from pathlib import Path

import numpy as np
from record_rays import create

import pybullet as p

SHAPES = ("sphere", "box", "capsule", "cylinder", "hull")
RAYS = 60


def touching(body: int, rng: np.random.Generator) -> tuple[list[float], list[float]]:
    """A ray past a body: it goes along the surface near a random point, at up to 1.6 mm from it."""
    start = rng.normal(size=3)
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=1e-6)
    probe = p.createMultiBody(1, shape, -1, (2 * start / np.linalg.norm(start)).tolist())
    nearest = p.getClosestPoints(probe, body, 5.0)[0]
    p.removeBody(probe)
    place, normal = np.array(nearest[6]), np.array(nearest[7])
    along = np.cross(normal, rng.normal(size=3))
    along /= np.linalg.norm(along)
    middle = place + normal * rng.uniform(-0.0002, 0.0016)
    return (middle - along).tolist(), (middle + along * rng.uniform(0.3, 1.0)).tolist()


def main() -> None:
    """Shapes at one pose, after a step: before the first one PyBullet has tight bounds."""
    p.connect(p.DIRECT)
    rng = np.random.default_rng(12)
    turn = np.array([0.1, 0.7, -0.1, 0.7])
    record = {
        "position": [0.1, -0.2, 0.3],
        "orientation": (turn / np.linalg.norm(turn)).tolist(),
        "shapes": {},
    }
    for name in SHAPES:
        body = p.createMultiBody(0, create(name), -1, record["position"], record["orientation"])
        p.stepSimulation()
        rays = [touching(body, rng) for _ in range(RAYS)]
        hits = [p.rayTest(*ray)[0] for ray in rays]
        record["shapes"][name] = {
            "rays": [a + b for a, b in rays],
            "hits": [[hit[0] >= 0, hit[2], *np.round(hit[4], 6).tolist()] for hit in hits],
        }
        p.removeBody(body)
    path = Path(__file__).with_name("grazing_rays.json")
    path.write_text(json.dumps({"pybullet": "3.2.7", **record}, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
