"""Blocks and what they go into: the toys folder, and the bricks and tiles of other folders as meshes."""

from __future__ import annotations

import numpy as np
from tools.assets.obj_mesh import ObjMesh, ObjParts, together
from tools.assets.parts import Box, Inertial, Link, Mesh, Paint, Robot, Shape, Vector3, diagonal
from tools.assets.simple_meshes import Corner, blocks, lathe, stretched, textured_box

WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0))
RIM = 0.25
"""How wide the rim of the concave box is [m]."""
FLOOR: tuple[Corner, Corner] = ((-1.0, -1.0, -0.1), (1.0, 1.0, 0.0))
RIMS: tuple[tuple[Corner, Corner], ...] = (
    ((-1.0, -1.0, 0.0), (1.0, RIM - 1.0, 0.1)),
    ((-1.0, 1.0 - RIM, 0.0), (1.0, 1.0, 0.1)),
    ((-1.0, RIM - 1.0, 0.0), (RIM - 1.0, 1.0 - RIM, 0.1)),
    ((1.0 - RIM, RIM - 1.0, 0.0), (1.0, 1.0 - RIM, 0.1)),
)
BRICK_PITCH, BRICK_STUD, BRICK_HEIGHT, BRICK_TOP = 0.159, 0.048, 0.19, 0.23
"""Between studs, radius of a stud, heights of the brick without and with studs, in units of its file."""


def concave_box_mesh() -> ObjMesh:
    """A slab with a basin in it."""
    return blocks((FLOOR, *RIMS))


def _box(low: Corner, high: Corner) -> Shape:
    (x0, y0, z0), (x1, y1, z1) = low, high
    middle: Vector3 = ((x0 + x1) / 2.0, (y0 + y1) / 2.0, (z0 + z1) / 2.0)
    return Shape(Box((x1 - x0, y1 - y0, z1 - z0)), middle)


def concave_box() -> Robot:
    """A slab with a basin in it, which touches as its floor and its rims do."""
    touching = tuple(_box(low, high) for low, high in (FLOOR, *RIMS))
    contact: dict[str, float | None] = {"rolling_friction": 0.001, "spinning_friction": 0.001}
    inertial = Inertial(0.0, tensor=diagonal(1.0, 1.0, 1.0))
    seen = (Shape(Mesh("concave_box.obj"), paint=WHITE),)
    return Robot(
        "urdf_robot", "A slab with a basin.", (Link("base_link", inertial, seen, touching, contact),)
    )


def cube() -> ObjMesh:
    """A block to put through a square hole."""
    return blocks([((-0.2319, 0.0405, -0.1219), (-0.1446, 0.1278, -0.0565))])


def _column(corners: int) -> ObjMesh:
    """An upright prism without normals."""
    prism = lathe([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], corners)
    return ObjMesh(prism.vertices, prism.faces)


def cylinder() -> ObjMesh:
    """A block to put through a round hole."""
    return stretched(_column(24), (-0.2912, -0.0121, 0.1655), (-0.2142, 0.1034, 0.2233))


def prism() -> ObjMesh:
    """A block to put through a three-cornered hole."""
    return stretched(_column(3), (-0.2336, -0.1036, -0.0571), (-0.1494, -0.0392, 0.0609))


def shape_sorter() -> ObjMesh:
    """A box of 40 cm with holes through its lid."""
    out, wall = 0.2, 0.02
    walls: list[tuple[Corner, Corner]] = [
        ((-out, -out, -out), (out, out, wall - out)),
        ((-out, -out, wall - out), (out, wall - out, out)),
        ((-out, out - wall, wall - out), (out, out, out)),
        ((-out, wall - out, wall - out), (wall - out, out - wall, out)),
        ((out - wall, wall - out, wall - out), (out, out - wall, out)),
    ]
    bars: list[tuple[Corner, Corner]] = [
        ((wall - out, y - wall, out - wall), (out - wall, y + wall, out)) for y in (-0.06, 0.06)
    ]
    return blocks([*walls, *bars])


def jenga_brick() -> ObjMesh:
    """A cube of edge 1, which scripts stretch to a brick."""
    return textured_box(("jenga", "jenga.mtl"))


def domino_tile() -> ObjMesh:
    """A tile that stands on its short edge and is thin along y."""
    return stretched(blocks([((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))]), *_bounds(0.0127, 0.003175, 0.0254))


def _bounds(x: float, y: float, z: float) -> tuple[Corner, Corner]:
    return (-x, -y, -z), (x, y, z)


def _brick_parts() -> list[ObjMesh]:
    """The brick and its studs, y upwards."""
    pitch, stud = BRICK_PITCH, BRICK_STUD
    studs = [
        stretched(_standing(12), (x - stud, BRICK_HEIGHT, z - stud), (x + stud, BRICK_TOP, z + stud))
        for x in (0.5 * pitch, 1.5 * pitch)
        for z in (-1.5 * pitch, -0.5 * pitch)
    ]
    return [blocks([((0.0, 0.0, -2.0 * pitch), (2.0 * pitch, BRICK_HEIGHT, 0.0))]), *studs]


def _standing(corners: int) -> ObjMesh:
    """A column along y."""
    column = _column(corners)
    x, y, z = np.asarray(column.vertices).T
    return ObjMesh(np.column_stack((y, z, x)), column.faces)


def lego_brick() -> ObjMesh:
    """A brick of two by two studs."""
    return together(_brick_parts())


def lego_hulls() -> ObjParts:
    """What it touches with, each part a hull."""
    return ObjParts(_brick_parts())


def motor() -> ObjMesh:
    """The flat motor of a walking robot, about z."""
    return stretched(_column(32), *_bounds(0.043, 0.043, 0.0065))
