"""Meshes with few corners: squares of floor, textured boxes, balls, and an open tray."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from tools.assets.fields import Points
from tools.assets.obj_mesh import ObjMesh, ObjParts


def square(half: float, tiles: float, material: tuple[str, str]) -> ObjMesh:
    """A horizontal square of floor, its texture repeated `tiles` times along each edge."""
    corners = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
    vertices = np.column_stack(((2.0 * corners - 1.0) * half, np.zeros(4)))
    normals = np.tile((0.0, 0.0, 1.0), (4, 1))
    return ObjMesh(vertices, [(0, 1, 2), (0, 2, 3)], normals, corners * tiles, material)


def textured_box(material: tuple[str, str]) -> ObjMesh:
    """A cube of edge 1 around the origin that shows the whole texture on each face."""
    vertices, normals, texture, faces = [], [], [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal, across, upwards = np.zeros(3), np.zeros(3), np.zeros(3)
            normal[axis], upwards[(axis + 2) % 3] = sign, 1.0
            across = np.cross(upwards, normal)
            first = len(vertices)
            for s, t in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)):
                vertices.append(0.5 * normal + (s - 0.5) * across + (t - 0.5) * upwards)
                normals.append(normal)
                texture.append((s, t))
            faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return ObjMesh(np.array(vertices), faces, np.array(normals), np.array(texture), material)


Corner = tuple[float, float, float]


def blocks(corners: Sequence[tuple[Corner, Corner]], decimals: int = 4) -> ObjMesh:
    """Cuboids side by side, each given by its lowest and highest corner; flat-shaded."""
    unit = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    vertices = np.vstack([np.where(unit == 1, high, low) for low, high in corners])
    faces = [tuple(8 * i + corner for corner in side) for i in range(len(corners)) for side in sides]
    return ObjMesh(vertices, faces, decimals=decimals)


def stretched(mesh: ObjMesh, low: Corner, high: Corner) -> ObjMesh:
    """A mesh without normals, moved and stretched along the axes until it spans the given bounds."""
    least, most = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    share = (mesh.vertices - least) / (most - least)
    return ObjMesh(low + share * np.subtract(high, low), mesh.faces, decimals=mesh.decimals)


def globe(radius: float, meridians: int, parallels: int, material: tuple[str, str] | None = None) -> ObjMesh:
    """A ball cut along meridians and parallels, textured by longitude and latitude if at all."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, meridians + 1), np.linspace(0.0, 1.0, parallels + 1))
    longitude, latitude = 2.0 * np.pi * u.ravel(), np.pi * (v.ravel() - 0.5)
    outward = np.column_stack(
        (np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude))
    )
    row = meridians + 1
    faces: list[tuple[int, ...]] = []
    for j in range(parallels):
        for i in range(meridians):
            corner = j * row + i
            if j > 0:
                faces.append((corner, corner + 1, corner + row + 1))
            if j < parallels - 1:
                faces.append((corner, corner + row + 1, corner + row))
    texture = np.column_stack((u.ravel(), v.ravel())) if material else None
    return ObjMesh(radius * outward, faces, outward, texture, material)


def ellipsoids(middles_and_halves: Sequence[tuple[Corner, Corner]]) -> ObjParts:
    """Ellipsoids along the axes, each a hull, by their middles and half lengths."""
    return ObjParts(
        [
            stretched(globe(1.0, 12, 8), *(tuple(np.add(c, np.multiply(s, r)).tolist()) for s in (-1.0, 1.0)))
            for c, r in middles_and_halves
        ]
    )


def sheet(
    half: float, cells: int, *, upright: bool = False, material: tuple[str, str] | None = None
) -> ObjMesh:
    """A square around the origin, cut into cells of two triangles; its normal is z, or y if it is upright.

    With a material its texture lies as on PyBullet's cloth.
    """
    along = np.linspace(-half, half, cells + 1)
    y, x = np.meshgrid(along, along, indexing="ij")
    row = cells + 1
    faces: list[tuple[int, ...]] = []
    for corner in (j * row + i for j in range(cells) for i in range(cells)):
        faces += [(corner, corner + 1, corner + row + 1), (corner, corner + row + 1, corner + row)]
    flat = np.zeros(x.size)
    places = (x.ravel(), flat, -y.ravel()) if upright else (x.ravel(), y.ravel(), flat)
    texture = None
    if material is not None:
        texture = 0.5 + np.column_stack((0.476 * x.ravel(), -1.17 * y.ravel())) / half
    return ObjMesh(np.column_stack(places) + 0.0, faces, texture=texture, material=material)


def ring(radius: float, thickness: float, segments: int, sides: int) -> ObjMesh:
    """A closed torus about y, smooth-shaded.

    Args:
        radius: From the middle to that of the tube [m].
        thickness: Radius of the tube [m].
        segments: Facets around the axis.
        sides: Facets around the tube.
    """
    around, across = np.meshgrid(np.arange(segments), np.arange(sides), indexing="ij")
    turn, tilt = 2.0 * np.pi * around.ravel() / segments, 2.0 * np.pi * across.ravel() / sides
    normals = np.column_stack((np.cos(turn) * np.cos(tilt), np.sin(tilt), -np.sin(turn) * np.cos(tilt)))
    middles = radius * np.column_stack((np.cos(turn), np.zeros(turn.size), -np.sin(turn)))
    faces: list[tuple[int, ...]] = []
    for i in range(segments):
        for j in range(sides):
            here, beyond = i * sides, (i + 1) % segments * sides
            after = (j + 1) % sides
            faces.append((here + j, beyond + j, beyond + after, here + after))
    return ObjMesh(middles + thickness * normals, faces, normals)


def lathe(profile: list[tuple[float, float]], segments: int) -> ObjMesh:
    """A body of revolution about z, smooth-shaded.

    Args:
        profile: (radius, height) of points along the outline, the body on its left; its ends lie on the axis.
        segments: Facets around the axis.
    """
    outline = np.array(profile)
    along = np.gradient(outline, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    angle = 2.0 * np.pi * np.arange(segments) / segments
    across = np.column_stack((np.cos(angle), np.sin(angle)))
    vertices, normals = (
        np.concatenate([np.column_stack((across * r, np.full(segments, z))) for r, z in rows])
        for rows in (outline, np.column_stack((along[:, 1], -along[:, 0])))
    )
    faces: list[tuple[int, ...]] = []
    for row in range(len(outline) - 1):
        for i in range(segments):
            here, after = row * segments + i, row * segments + (i + 1) % segments
            if row == 0:
                faces.append((here, after + segments, here + segments))
            elif row == len(outline) - 2:
                faces.append((here, after, here + segments))
            else:
                faces.append((here, after, after + segments, here + segments))
    return ObjMesh(vertices, faces, normals)


Rectangle = tuple[float, float, float, float]
"""Low x, low y, high x, high y [m]."""


def tray(floor: Rectangle, rim: Rectangle, heights: tuple[float, float], wall: float) -> ObjMesh:
    """An open tray with slanting sides, flat-shaded.

    Args:
        floor: Outline of the underside.
        rim: Outline of the top.
        heights: z of the underside and of the rim [m].
        wall: Thickness of floor and sides [m].
    """
    low, high = heights
    rings = (_ring(floor, low), _ring(rim, high), _ring(rim, high, wall), _ring(floor, low + wall, wall))
    faces: list[tuple[int, ...]] = [(3, 2, 1, 0), (12, 13, 14, 15)]
    for level in range(3):
        for i in range(4):
            here, after = 4 * level + i, 4 * level + (i + 1) % 4
            faces.append((here, after, after + 4, here + 4))
    return ObjMesh(np.vstack(rings), faces)


def tray_hulls(floor: Rectangle, rim: Rectangle, heights: tuple[float, float], wall: float) -> ObjParts:
    """What such a tray touches with: its floor and its four sides, each a hull, so that things lie in it."""
    whole = tray(floor, rim, heights, wall)
    sides = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    corners = [
        (0, 1, 2, 3, 12, 13, 14, 15),
        *((i, j, 4 + j, 4 + i, 12 + i, 12 + j, 8 + j, 8 + i) for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))),
    ]
    return ObjParts([ObjMesh(whole.vertices[list(part)], sides) for part in corners])


def _ring(outline: Rectangle, height: float, inset: float = 0.0) -> Points:
    low_x, low_y, high_x, high_y = (
        outline[0] + inset,
        outline[1] + inset,
        outline[2] - inset,
        outline[3] - inset,
    )
    corners = ((low_x, low_y), (high_x, low_y), (high_x, high_y), (low_x, high_y))
    return np.array([(x, y, height) for x, y in corners])
