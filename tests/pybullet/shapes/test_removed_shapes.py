"""Which shapes `removeCollisionShape` removes; the answers are those of PyBullet 3.2.7."""

from typing import Any

import pytest

import pybullet as p
import pybullet_data

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
DUCK = f"{pybullet_data.getDataPath()}/duck.obj"
TRIANGLES = [0, 1, 2, 0, 1, 3, 1, 2, 3, 0, 2, 3]
CONCAVE = {"fileName": DUCK, "flags": p.GEOM_FORCE_CONCAVE_TRIMESH}
HEIGHTS = {"heightfieldData": [0.0] * 9, "numHeightfieldRows": 3, "numHeightfieldColumns": 3}


@pytest.mark.parametrize(
    ("kind", "arguments", "following"),
    [
        (p.GEOM_SPHERE, {}, 0),
        (p.GEOM_MESH, {"fileName": DUCK}, 0),
        (p.GEOM_MESH, {"vertices": CORNERS, "indices": TRIANGLES}, 0),
        (p.GEOM_MESH, CONCAVE, 1),
        (p.GEOM_MESH, {**CONCAVE, "collisionFramePosition": [0, 0, 1]}, 0),
        (p.GEOM_HEIGHTFIELD, {**HEIGHTS, "meshScale": [1, 1, 1]}, 1),
    ],
)
def test_triangle_meshes_of_files_and_height_fields_keep_their_ids(
    client: int, kind: int, arguments: dict[str, Any], following: int
) -> None:
    shape = p.createCollisionShape(kind, **arguments)
    p.removeCollisionShape(shape)
    assert p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 1]) == following


@pytest.mark.parametrize(("kinds", "following"), [([p.GEOM_MESH], 1), ([p.GEOM_SPHERE, p.GEOM_MESH], 0)])
def test_so_do_arrays_of_one_shape(client: int, kinds: list[int], following: int) -> None:
    concave = [p.GEOM_FORCE_CONCAVE_TRIMESH] * len(kinds)
    files = [DUCK] * len(kinds)
    shape = p.createCollisionShapeArray(kinds, radii=[0.1] * len(kinds), fileNames=files, flags=concave)
    p.removeCollisionShape(shape)
    assert p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 1]) == following
