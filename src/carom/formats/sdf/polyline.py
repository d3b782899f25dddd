"""`<polyline>`: outlines that are extruded along z, cut into convex pieces."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from carom.description import ConvexHull, TriangleMesh
from carom.files.xml_element import Element
from carom.formats.sdf.context import SdfContext

Point = tuple[float, float]
_MOST_POINTS = 2000


def read_outline(context: SdfContext, owner: Element, shape: Element) -> tuple[list[Point], float]:
    """The corners of an outline, counter-clockwise, and its height [m]; raises `DescriptionError`.

    Only the first outline of a shape counts; the others, which may be holes, are reported.
    """
    geometry = owner.first("geometry") or shape
    for other in geometry.children:
        if other is not shape:
            context.leave_out(other, "only the first outline counts", "shapes have no holes")
    outline: list[Point] = []
    for element in shape.all("point"):
        numbers = context.values(element)
        if len(numbers) != 2:
            raise context.error(element, "a point needs two numbers")
        point = (numbers[0] * context.scale, numbers[1] * context.scale)
        if not outline or point != outline[-1]:
            outline.append(point)
    if len(outline) > 1 and outline[0] == outline[-1]:
        outline.pop()
    if len(outline) < 3:
        raise context.error(shape, "an outline needs three points or more")
    if len(outline) > _MOST_POINTS:
        raise context.error(shape, f"an outline has at most {_MOST_POINTS} points")
    height = 1.0 if shape.first("height") is None else context.non_negative(shape, "height")
    area = sum(_cross(outline[0], a, b) for a, b in pairwise(outline))
    if area == 0.0:
        raise context.error(shape, "the outline encloses no area")
    return (outline if area > 0.0 else outline[::-1]), height * context.scale


def prism(outline: list[Point], height: float) -> TriangleMesh:
    """The surface of an extruded outline, from z = 0 to its height."""
    count = len(outline)
    vertices = [(x, y, z) for z in (0.0, height) for x, y in outline]
    caps = triangles(outline)
    faces = [(c, b, a) for a, b, c in caps] + [(a + count, b + count, c + count) for a, b, c in caps]
    for k in range(count):
        after = (k + 1) % count
        faces += [(k, after, after + count), (k, after + count, k + count)]
    return TriangleMesh(np.array(vertices), np.array(faces, np.int32))


def pieces(outline: list[Point], height: float) -> list[ConvexHull]:
    """Convex prisms that together are an extruded outline."""
    return [
        ConvexHull(np.array([(*outline[k], z) for z in (0.0, height) for k in polygon]), margin=0.0)
        for polygon in _merged(outline, triangles(outline))
    ]


def triangles(outline: list[Point]) -> list[tuple[int, int, int]]:
    """A counter-clockwise outline cut into triangles, by its ears."""
    left, found = list(range(len(outline))), list[tuple[int, int, int]]()
    while len(left) > 3:
        for place in range(len(left)):
            a, b, c = left[place - 1], left[place], left[(place + 1) % len(left)]
            if _is_ear(outline, left, a, b, c):
                break
        else:
            # The outline crosses itself; what is left is cut anyhow.
            place = 1
            a, b, c = left[0], left[1], left[2]
        found.append((a, b, c))
        del left[place]
    return [*found, (left[0], left[1], left[2])]


def _is_ear(outline: list[Point], left: list[int], a: int, b: int, c: int) -> bool:
    first, tip, last = outline[a], outline[b], outline[c]
    if _cross(first, tip, last) < 0.0:
        return False
    for other in left:
        point = outline[other]
        if other in (a, b, c) or point in (first, tip, last):
            continue
        sides = (_cross(first, tip, point), _cross(tip, last, point), _cross(last, first, point))
        if min(sides) >= 0.0:
            return False
    return True


def _merged(outline: list[Point], cut: list[tuple[int, int, int]]) -> list[list[int]]:
    """Triangles put together, by their common sides, while the result is convex."""
    polygons = [list(triangle) for triangle in cut]
    place = 0
    while place < len(polygons):
        for other in range(place + 1, len(polygons)):
            joined = _joined(outline, polygons[place], polygons[other])
            if joined is not None:
                polygons[place] = joined
                del polygons[other]
                break
        else:
            place += 1
    return polygons


def _joined(outline: list[Point], one: list[int], other: list[int]) -> list[int] | None:
    """Two polygons as one, if they have a side in common and the result is convex."""
    for k, a in enumerate(one):
        b = one[(k + 1) % len(one)]
        for j, c in enumerate(other):
            if c == b and other[(j + 1) % len(other)] == a:
                rest = [other[(j + 1 + n) % len(other)] for n in range(1, len(other) - 1)]
                joined = [*one[: k + 1], *rest, *one[k + 1 :]]
                points = [outline[n] for n in joined]
                turns = (_cross(points[n - 2], points[n - 1], points[n]) for n in range(len(points)))
                return joined if min(turns) >= 0.0 else None
    return None


def _cross(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a triangle, positive if it is counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
