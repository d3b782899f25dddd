"""A rubber duck and a mug."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from tools.assets.envelope import Envelope
from tools.assets.fields import Field, ball, blend, rod
from tools.assets.obj_mesh import ObjMesh, ObjParts, together
from tools.assets.parts import Cylinder, Inertial, Link, Mesh, Paint, Robot, Shape
from tools.assets.simple_meshes import blocks, ellipsoids, globe, lathe
from tools.assets.surface import mesh_of
from tools.assets.textures import Colours

DUCK_UNITS = 20.0
"""The duck's mesh is drawn this much larger than the duck, as scripts scale it themselves."""
DUCK_BOUNDS = Envelope(
    (-0.05235860635241, 0.0007033553629088, -0.03123124908571),
    (0.03837644635241, 0.08605880463709, 0.03479364908571),
)
MUG_BOUNDS = Envelope(
    (-0.04400000113249, -0.04400000033593, -0.003000000745058),
    (0.04400000113249, 0.08363300033593, 0.1030000007451),
)
WALLS = 12
"""Hulls of the mug's wall."""
HULL_MARGIN = 0.002
"""A cylinder touches as a hull, whose bounds PyBullet widens by this [m]."""
MIDDLE = 0.0018
"""Where the duck's plane of symmetry is along z [m]."""

YELLOW, ORANGE, BLACK = 1.0 / 6.0, 0.5, 5.0 / 6.0
"""Texture coordinates of the duck's three colours."""

DUCK_PAINT = Paint("yellow", (1.0, 1.0, 1.0, 1.0), (0.5, 0.5, 0.5))
RED = Paint("mug", (0.9, 0.16, 0.14, 1.0), (0.6, 0.6, 0.6))
CONTACT: dict[str, float | None] = {
    "lateral_friction": 1.0,
    "rolling_friction": 0.0,
    "contact_cfm": 0.0,
    "contact_erp": 1.0,
}


def duck_palette() -> Colours:
    """The duck's colours side by side: plumage, beak, eyes."""
    colours = np.array(((1.0, 0.83, 0.1), (0.95, 0.45, 0.08), (0.06, 0.06, 0.08)))
    return np.tile(np.repeat(colours, 8, axis=0)[None], (8, 1, 1))


def _plumage() -> Field:
    wings = [
        rod((0.0, 0.036, MIDDLE + side * 0.024), (0.022, 0.042, MIDDLE + side * 0.019), 0.01, 0.006)
        for side in (-1.0, 1.0)
    ]
    return blend(
        rod((0.009, 0.031, MIDDLE), (-0.012, 0.031, MIDDLE), 0.0285, 0.026),
        rod((0.012, 0.035, MIDDLE), (0.031, 0.049, MIDDLE), 0.016, 0.0055),
        ball((-0.021, 0.0628, MIDDLE), 0.0215),
        *wings,
        width=0.01,
    )


def _beak() -> Field:
    return blend(
        rod((-0.036, 0.0605, MIDDLE), (-0.046, 0.0595, MIDDLE - 0.004), 0.006, 0.0045),
        rod((-0.036, 0.0605, MIDDLE), (-0.046, 0.0595, MIDDLE + 0.004), 0.006, 0.0045),
        width=0.006,
    )


def _coloured(mesh: ObjMesh, colour: float) -> ObjMesh:
    texture = np.tile((colour, 0.5), (len(mesh.vertices), 1))
    return ObjMesh(mesh.vertices, mesh.faces, mesh.normals, texture)


def _moved(mesh: ObjMesh, by: tuple[float, float, float]) -> ObjMesh:
    return ObjMesh(mesh.vertices + np.array(by), mesh.faces, mesh.normals, mesh.texture)


def duck_mesh() -> ObjMesh:
    """The duck, y upwards, looking along -x, in its own large units."""
    low, high = np.array((-0.056, -0.002, -0.038)), np.array((0.042, 0.09, 0.042))
    eyes = [
        _coloured(_moved(globe(0.0032, 8, 5), (-0.0365, 0.0705, MIDDLE + side * 0.0125)), BLACK)
        for side in (-1.0, 1.0)
    ]
    parts = [
        _coloured(mesh_of(_plumage(), low, high, 0.0075), YELLOW),
        _coloured(mesh_of(_beak(), low, high, 0.004), ORANGE),
        *eyes,
    ]
    whole = together(parts, ("duck", "duck.mtl"))
    return ObjMesh(DUCK_UNITS * whole.vertices, whole.faces, whole.normals, whole.texture, whole.material)


def duck_hulls() -> ObjParts:
    """What the duck touches with as hulls, in the units of its mesh: body, tail, head and beak."""
    middles_and_halves = (
        ((-0.05, 0.62, 0.036), (0.6, 0.526, 0.58)),
        ((0.45, 0.85, 0.036), (0.238, 0.25, 0.3)),
        ((-0.42, 1.22, 0.036), (0.4, 0.421, 0.4)),
        ((-0.82, 1.19, 0.036), (0.147, 0.12, 0.22)),
    )
    return ellipsoids(middles_and_halves)


def duck() -> Robot:
    """It touches with a body, a head and a beak; its mesh has y upwards, so it loads lying on its back."""
    room = DUCK_BOUNDS
    scale = 1.0 / DUCK_UNITS
    touching = (
        room.capsule("x", room.width("z") / 2.0, y="low", z="low", start=-0.03),
        room.capsule("y", 0.0222, x=-0.021, z=MIDDLE, start=0.03),
        room.box(x=(None, -0.03), y=(0.054, 0.066), z=(MIDDLE - 0.009, MIDDLE + 0.009)),
    )
    seen = (Shape(Mesh("duck.obj", (scale, scale, scale)), paint=DUCK_PAINT),)
    link = Link("baseLink", Inertial(0.1, (0.0, 0.02, 0.0)), seen, touching, CONTACT)
    return Robot("cube.urdf", "A rubber duck of 100 g.", (link,))


def mug_mesh() -> ObjMesh:
    """A mug with a handle along y."""
    handle = blend(
        rod((0.0, 0.044, 0.079), (0.0, 0.064, 0.077), 0.0055),
        rod((0.0, 0.064, 0.077), (0.0, 0.0745, 0.05), 0.0055),
        rod((0.0, 0.0745, 0.05), (0.0, 0.062, 0.025), 0.0055),
        rod((0.0, 0.062, 0.025), (0.0, 0.044, 0.021), 0.0055),
        width=0.012,
    )
    low, high = np.array((-0.012, 0.03, 0.01)), np.array((0.012, 0.085, 0.09))
    outside = [(0.0, 0.0), (0.034, 0.0), (0.0375, 0.0008), (0.04, 0.0035), (0.041, 0.007), (0.041, 0.0965)]
    rim = [(0.0404, 0.0988), (0.039, 0.1), (0.0375, 0.0988), (0.037, 0.0965)]
    inside = [(0.037, 0.012), (0.036, 0.009), (0.033, 0.0075), (0.03, 0.007), (0.0, 0.007)]
    return together([lathe([*outside, *rim, *inside], 28), mesh_of(handle, low, high, 0.0047)])


def mug_hulls() -> ObjParts:
    """What the mug touches with as hulls: floor, wall and handle, so that things go into it."""
    outer, inner, bottom, top = 0.041, 0.037, 0.007, 0.1
    turns = 2.0 * np.pi * np.arange(WALLS + 1) / WALLS
    walls = [
        [
            (radius * np.cos(turn), radius * np.sin(turn), height)
            for height in (0.0, top)
            for turn, radius in ((first, inner), (first, outer), (second, outer), (second, inner))
        ]
        for first, second in pairwise(turns)
    ]
    sides = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    floor = lathe([(0.0, 0.0), (inner, 0.0), (inner, bottom), (0.0, bottom)], WALLS)
    bars = (
        ((-0.006, 0.039, 0.072), (0.006, 0.076, 0.083)),
        ((-0.006, 0.069, 0.026), (0.006, 0.0806, 0.076)),
        ((-0.006, 0.039, 0.017), (0.006, 0.07, 0.028)),
    )
    return ObjParts(
        [
            ObjMesh(floor.vertices, floor.faces),
            *(ObjMesh(np.array(corners), sides) for corners in walls),
            *(blocks([bar]) for bar in bars),
        ]
    )


def mug() -> Robot:
    """It touches as a full cylinder with a handle of three bars."""
    bar = 0.008
    room = MUG_BOUNDS
    upper, lower = ((0.072, 0.082), (0.02, 0.03))
    touching = (
        Shape(
            Cylinder(room.width("x") / 2.0 - HULL_MARGIN, room.width("z") - 2.0 * HULL_MARGIN),
            (0.0, 0.0, 0.05),
        ),
        room.box(x=(-bar, bar), y=(0.03, 0.076), z=upper),
        room.box(x=(-bar, bar), y=(0.03, 0.076), z=lower),
        room.box(x=(-bar, bar), y=(0.07, None), z=(0.03, 0.072)),
    )
    link = Link(
        "base_link",
        Inertial(1.0),
        (Shape(Mesh("mug.obj"), paint=RED),),
        touching,
        {"lateral_friction": 1.0},
    )
    return Robot("mug", "A mug of 1 kg.", (link,))
