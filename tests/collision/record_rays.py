"""Records what PyBullet reports for rays; run it with an interpreter that has PyBullet."""

import json
from pathlib import Path

import numpy as np

import pybullet as p

SHAPES = ("sphere", "box", "capsule", "cylinder", "hull", "plane", "mesh")
CORNERS = [[x, y, z] for x in (-0.2, 0.2) for y in (-0.3, 0.3) for z in (-0.1, 0.1)]
TENT = [[-1, -1, 0], [1, -1, 0], [1, 1, 0.2], [-1, 1, 0], [0, 0, 0.5]]
TENT_FACES = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]


def create(name: str) -> int:
    """A collision shape of one kind."""
    return {
        "sphere": lambda: p.createCollisionShape(p.GEOM_SPHERE, radius=0.3),
        "box": lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2, 0.3, 0.1]),
        "capsule": lambda: p.createCollisionShape(p.GEOM_CAPSULE, radius=0.2, height=0.6),
        "cylinder": lambda: p.createCollisionShape(p.GEOM_CYLINDER, radius=0.2, height=0.6),
        "hull": lambda: p.createCollisionShape(p.GEOM_MESH, vertices=CORNERS),
        "plane": lambda: p.createCollisionShape(p.GEOM_PLANE, planeNormal=[0, 0, 1]),
        "mesh": lambda: p.createCollisionShape(
            p.GEOM_MESH, vertices=TENT, indices=TENT_FACES, flags=p.GEOM_FORCE_CONCAVE_TRIMESH
        ),
    }[name]()


def main() -> None:
    """Rays from and to random places, on shapes at one pose."""
    p.connect(p.DIRECT)
    rng = np.random.default_rng(9)
    record = {"position": [0.1, -0.2, 0.3], "orientation": [0.1, 0.7, -0.1, 0.7], "shapes": {}}
    record["orientation"] = (np.array(record["orientation"]) / np.linalg.norm(record["orientation"])).tolist()
    for name in SHAPES:
        body = p.createMultiBody(0, create(name), -1, record["position"], record["orientation"])
        starts = rng.normal(size=(40, 3))
        starts *= 2 / np.linalg.norm(starts, axis=1)[:, None]
        ends = rng.normal(size=(40, 3)) * 0.2 - starts
        starts, ends = np.round(starts, 4).tolist(), np.round(ends, 4).tolist()
        hits = p.rayTestBatch(starts, ends)
        record["shapes"][name] = {
            "rays": [a + b for a, b in zip(starts, ends, strict=True)],
            "hits": [[hit[0] >= 0, round(hit[2], 7), *np.round(hit[4], 5).tolist()] for hit in hits],
        }
        assert isinstance(body, int)
        p.removeBody(body)
    path = Path(__file__).with_name("rays.json")
    path.write_text(json.dumps({"pybullet": "3.2.7", **record}, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
