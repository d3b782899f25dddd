"""Round things: a teddy, a bunny, cloth; and a courtyard to walk in."""

from __future__ import annotations

import numpy as np
from tools.assets.envelope import Envelope
from tools.assets.fields import Field, ball, blend, rod
from tools.assets.measured import Dress, dressed, fitted
from tools.assets.obj_mesh import ObjMesh, ObjParts
from tools.assets.parts import Mesh, Paint, Robot, Shape
from tools.assets.simple_meshes import ellipsoids, stretched
from tools.assets.surface import mesh_of

FUR = Paint("fur", (0.62, 0.42, 0.24, 1.0))
STONE = Paint("stone", (0.66, 0.65, 0.62, 1.0))
TEDDY_MIDDLE = (0.6787, 0.6611, 0.323)
BUNNY_BOUNDS = ((-0.4595, -0.6665, -0.959), (0.4666, 0.7769, 1.0157))


def spanning(mesh: ObjMesh) -> ObjMesh:
    """The mesh, moved and stretched so that it spans one unit around the origin along each axis."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert mesh.normals is not None
    normals = mesh.normals * (high - low)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return ObjMesh((mesh.vertices - (low + high) / 2.0) / (high - low), mesh.faces, normals)


def _meshed(field: Field, reach: float, cell: float) -> ObjMesh:
    return spanning(mesh_of(field, np.full(3, -reach), np.full(3, reach), cell))


def teddy_mesh() -> ObjMesh:
    """It sits, with y up, and looks along z."""
    pairs = [
        part
        for side in (-1.0, 1.0)
        for part in (
            rod((side * 0.25, -0.45, 0.0), (side * 0.4, -0.6, 0.45), 0.19),
            rod((side * 0.3, 0.1, 0.0), (side * 0.6, -0.15, 0.25), 0.14),
            ball((side * 0.28, 0.85, 0.0), 0.14),
        )
    ]
    trunk = (
        ball((0.0, -0.25, 0.0), 0.45),
        ball((0.0, 0.5, 0.0), 0.36),
        ball((0.0, 0.42, 0.3), 0.15),
    )
    return _meshed(blend(*trunk, *pairs, width=0.1), 1.1, 0.13)


def teddy_hulls() -> ObjParts:
    """A teddy as hulls of its parts, y upwards, where the original has them."""
    x, y, z = TEDDY_MIDDLE
    return ellipsoids(
        [
            ((x, y - 0.1, z), (0.22, 0.25, 0.2)),
            ((x, y + 0.25, z), (0.19, 0.18, 0.18)),
            ((x, y + 0.22, z + 0.18), (0.07, 0.07, 0.1337)),
            *(
                part
                for side in (-1.0, 1.0)
                for part in (
                    ((x + side * 0.15, y + 0.406, z), (0.07, 0.06, 0.05)),
                    ((x + side * 0.26, y, z + 0.05), (0.1204, 0.08, 0.08)),
                    ((x + side * 0.2, y - 0.346, z + 0.1), (0.09, 0.12, 0.2)),
                )
            ),
            ((x, y - 0.15, z - 0.2137), (0.1, 0.1, 0.1)),
        ]
    )


def cloth() -> Robot:
    """A box that is seen as a square of cloth."""
    seen = Shape(Mesh("cloth_z_up.obj"), paint=Paint("white", (1.0, 1.0, 1.0, 1.0)))
    return dressed("cloth_z_up.urdf", "A box seen as cloth.", Dress({"*": STONE}, seen={"*": (seen,)}))


def bunny_mesh() -> ObjMesh:
    """It sits, with y up, and looks along z."""
    pairs = [
        part
        for side in (-1.0, 1.0)
        for part in (
            rod((side * 0.14, 0.75, 0.35), (side * 0.22, 1.3, 0.1), 0.1, 0.07),
            ball((side * 0.3, -0.2, -0.15), 0.32),
            rod((side * 0.2, -0.5, 0.2), (side * 0.2, -0.52, 0.65), 0.13),
        )
    ]
    trunk = (ball((0.0, 0.0, -0.2), 0.5), ball((0.0, 0.55, 0.45), 0.32), ball((0.0, -0.25, -0.75), 0.16))
    mesh = mesh_of(blend(*trunk, *pairs, width=0.12), np.full(3, -1.6), np.full(3, 1.6), 0.12)
    return stretched(mesh, *BUNNY_BOUNDS)


def teddy(file: str) -> Robot:
    dress = Dress({"*": FUR}, {"*": fitted("teddy.obj")})
    return dressed(file, "A teddy that touches with its convex hull.", dress)


def _courtyard(room: Envelope) -> tuple[Shape, ...]:
    """A floor, a wall round it, and a tower of three storeys."""
    (low_x, high_x), (low_y, high_y) = room.inner("x"), room.inner("y")
    walls = (
        room.box(x=(None, low_x + 1.0), z=(None, 3.0)),
        room.box(x=(high_x - 1.0, None), z=(None, 3.0)),
        room.box(y=(None, low_y + 1.0), z=(None, 3.0)),
        room.box(y=(high_y - 1.0, None), z=(None, 3.0)),
    )
    tower = tuple(
        room.box(x=(30.0 - half, 30.0 + half), y=(-half, half), z=(None, height))
        for half, height in ((12.0, 10.0), (9.0, 20.0), (6.0, None))
    )
    return (room.box(z=(None, 0.0)), *walls, *tower)


def samurai() -> Robot:
    dress = Dress({"*": STONE}, {"*": _courtyard})
    return dressed("samurai.urdf", "A walled courtyard with a tower.", dress)
