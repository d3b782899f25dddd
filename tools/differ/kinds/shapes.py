"""Shapes for collisions and looks."""

from __future__ import annotations

from typing import Any

from tools.differ.maker import Maker, Reference

SPHERE, BOX, CYLINDER, MESH, PLANE, CAPSULE, HEIGHTS = 2, 3, 4, 5, 6, 7, 9
_CONCAVE = 1
_MESHES = (
    "cube.obj",
    "duck_vhacd.obj",
    "sphere_smooth.obj",
    "l_finger_tip.stl",
    "teddy2_VHACD_CHs.obj",
    "duck.obj",
)
_TETRAHEDRON = [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0]


def shape(maker: Maker) -> None:
    """Make a shape that no body has, or remove one."""
    if maker.shapes and maker.chance(0.2):
        maker.call("removeCollisionShape", maker.one(maker.shapes))
    else:
        collision_shape(maker)


def collision_shape(maker: Maker) -> Reference:
    """Any collision shape that the theme allows, or several in one."""
    plain = maker.theme.plain
    if maker.chance(0.12) and not plain:
        reference = _several(maker)
    else:
        kind = maker.one((SPHERE, BOX) if plain else (SPHERE, BOX, BOX, CYLINDER, CAPSULE, MESH))
        keywords = _arguments(maker, kind)
        if maker.chance(0.35) and not plain:
            position, turn = maker.vector(0.2), maker.turn()
            keywords |= maker.some(collisionFramePosition=position, collisionFrameOrientation=turn)
        # Links with a concave shape have no inertia in PyBullet: for questions of geometry alone.
        if kind == MESH and "query" in maker.theme.kinds and not maker.theme.floor and maker.chance(0.2):
            keywords["flags"] = _CONCAVE
        reference = maker.call("createCollisionShape", kind, **keywords)
    maker.shapes.append(reference)
    return reference


def heights(maker: Maker) -> Reference:
    """A field of heights."""
    rows, columns = maker.random.randint(2, 8), maker.random.randint(2, 8)
    return maker.call(
        "createCollisionShape",
        HEIGHTS,
        meshScale=[maker.one((0.5, 1)), maker.one((0.5, 1)), maker.one((0.1, 1))],
        heightfieldData=[maker.random.uniform(0, 0.3) for _ in range(rows * columns)],
        numHeightfieldRows=rows,
        numHeightfieldColumns=columns,
    )


def visual_shape(maker: Maker) -> Reference | int:
    """A shape to look at, or none."""
    if maker.chance(0.5):
        return -1
    kind = maker.one((SPHERE, BOX, CYLINDER, CAPSULE, MESH))
    return maker.call(
        "createVisualShape",
        kind,
        **_arguments(maker, kind, visual=True),
        **maker.some(
            rgbaColor=[maker.share(), maker.share(), maker.share(), maker.one((1, 1, 0.5))],
            specularColor=[maker.share(), 0.2, 0],
            visualFramePosition=maker.vector(0.2),
            visualFrameOrientation=maker.turn(),
        ),
    )


def _size(maker: Maker) -> float:
    return maker.one((0.05, 0.1, 0.2, maker.random.uniform(0.03, 0.4)))


def _several(maker: Maker) -> Reference:
    kinds = [maker.one((SPHERE, BOX, CYLINDER, CAPSULE)) for _ in range(maker.random.randint(1, 3))]
    uniform = maker.random.uniform
    return maker.call(
        "createCollisionShapeArray",
        shapeTypes=kinds,
        radii=[uniform(0.05, 0.2) for _ in kinds],
        halfExtents=[[uniform(0.05, 0.2) for _ in range(3)] for _ in kinds],
        lengths=[uniform(0.1, 0.3) for _ in kinds],
        **maker.some(
            collisionFramePositions=[maker.vector(0.3) for _ in kinds],
            collisionFrameOrientations=[maker.turn() for _ in kinds],
        ),
    )


def _arguments(maker: Maker, kind: int, *, visual: bool = False) -> dict[str, Any]:
    """Sizes of a shape of a kind."""
    if kind == SPHERE:
        return {"radius": _size(maker)}
    if kind == BOX:
        return {"halfExtents": [_size(maker) for _ in range(3)]}
    if kind in (CYLINDER, CAPSULE):
        return {"radius": _size(maker), "length" if visual else "height": 2 * _size(maker)}
    if maker.chance(0.5):
        scale = maker.one(([0.1, 0.1, 0.1], [0.2, 0.1, 0.3]))
        return {"fileName": maker.one(_MESHES), "meshScale": scale}
    if visual or maker.chance(0.3):
        size = _size(maker)
        corners = [[size, 0, -size], [-size, size, -size], [-size, -size, -size], [0, 0, size]]
        normals = {"normals": [[1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0], [0, 0, 1.0]]} if visual else {}
        return {"vertices": corners, "indices": _TETRAHEDRON, **normals}
    corners = [maker.vector(0.3) for _ in range(maker.random.randint(4, 12))]
    return {"vertices": corners, **maker.some(meshScale=[5 * _size(maker), 1, 1])}
