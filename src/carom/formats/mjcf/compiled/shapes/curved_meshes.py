"""Meshes that MJCF makes by name: hemispheres, superspheres and supertori."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import copysign, pi

import numpy as np
from numpy.typing import NDArray

from carom.files.budget import charge
from carom.native.trigonometry import cos, sin

Made = tuple[NDArray[np.float64], NDArray[np.int32]]
_Triangles = list[tuple[int, int, int]]
_MAX_DIVISIONS = 10
_QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def hemisphere(parameters: list[float]) -> Made | str:
    """The half of a ball of radius 1 above z = 0 with its flat face, or what is wrong with its parameters.

    A quarter of it is the face of an octahedron that is cut into triangles, as many times along an edge as
    the parameter says, whose corners are moved to the ball.
    """
    if len(parameters) != 1 or not 0.0 <= parameters[0] <= _MAX_DIVISIONS:
        return f"params of a hemisphere are a number of divisions from 0 to {_MAX_DIVISIONS}"
    rings = int(parameters[0]) + 1
    points = [(0.0, 0.0, 1.0)]
    triangles: _Triangles = []
    inner = [0]
    for ring in range(1, rings + 1):
        outer = range(len(points), len(points) + 4 * ring)
        for quarter in range(4):
            (ax, ay), (bx, by) = _QUARTERS[quarter], _QUARTERS[(quarter + 1) % 4]
            for place in range(ring):
                x, y = ax * (ring - place) + bx * place, ay * (ring - place) + by * place
                size = (x * x + y * y + (rings - ring) ** 2) ** 0.5
                points.append((x / size, y / size, (rings - ring) / size))
        triangles += _between(inner, outer, ring)
        inner = [*outer]
    centre = len(points)
    triangles += [(here, centre, after) for here, after in _around(inner)]
    return np.array([*points, (0.0, 0.0, 0.0)]), np.array(triangles, np.int32)


def _between(inner: list[int], outer: range, ring: int) -> Iterator[tuple[int, int, int]]:
    """The triangles between a ring, or the apex, and the next one, which has a point more in each quarter."""
    for quarter in range(4):
        within = [inner[(quarter * (ring - 1) + place) % len(inner)] for place in range(ring)]
        without = [outer[(quarter * ring + place) % len(outer)] for place in range(ring + 1)]
        for place in range(ring):
            yield within[place], without[place], without[place + 1]
            if place < ring - 1:
                yield within[place], without[place + 1], within[place + 1]


def supersphere(parameters: list[float]) -> Made | str:
    """A ball of radius 1 whose sections have exponents, or what is wrong with its parameters.

    These are the number of points around and of steps from pole to pole, and the exponents of sines and
    cosines of the longitude and of the latitude.
    """
    if len(parameters) != 3 or parameters[0] < 3 or min(parameters[1:]) < 0.0:
        return "params of a supersphere are a resolution, at least 3, and two exponents, 0 or more"
    count, across, along = int(parameters[0]), parameters[1], parameters[2]
    charge("vertices", 6 * count * count)
    points = [(0.0, 0.0, -1.0)]
    for step in range(1, count):
        latitude = pi * step / count - 0.5 * pi
        out, up = _power(cos(latitude), along), _power(sin(latitude), along)
        for place in range(count):
            longitude = 2.0 * pi * place / count - pi
            x, y = _power(cos(longitude), across), _power(sin(longitude), across)
            points.append((out * x, out * y, up))
    rings = [range(1 + count * step, 1 + count * (step + 1)) for step in range(count - 1)]
    triangles: _Triangles = [(0, after, here) for here, after in _around(rings[0])]
    for below, above in pairwise(rings):
        for (here, after), (over, further) in zip(_around(below), _around(above), strict=True):
            triangles += [(here, after, over), (after, further, over)]
    top = len(points)
    triangles += [(here, after, top) for here, after in _around(rings[-1])]
    return np.array([*points, (0.0, 0.0, 1.0)]), np.array(triangles, np.int32)


def supertorus(parameters: list[float]) -> Made | str:
    """A tube around z at a distance of 1 whose sections have exponents, or what is wrong with its parameters.

    These are the number of points around it and around the tube, the radius of the tube, and the exponents
    of sines and cosines of the angle around the tube and of that around z.
    """
    if (
        len(parameters) != 4
        or parameters[0] < 3
        or not 0.0 < parameters[1] <= 1.0
        or min(parameters[2:]) <= 0
    ):
        return (
            "params of a supertorus are a resolution, at least 3, a radius above 0 and at most 1, and two "
            "exponents above 0"
        )
    count, radius, tube, whole = int(parameters[0]), *parameters[1:]
    charge("vertices", 6 * count * count)
    angles = [2.0 * pi * place / count for place in range(count)]
    points = [
        (
            _power(cos(around), whole) * (1.0 + radius * _power(cos(within), tube)),
            _power(sin(around), whole) * (1.0 + radius * _power(cos(within), tube)),
            radius * _power(sin(within), tube),
        )
        for around in angles
        for within in angles
    ]
    rings = [range(count * ring, count * (ring + 1)) for ring in range(count)]
    triangles: _Triangles = []
    for first, second in zip(rings, [*rings[1:], rings[0]], strict=True):
        for (here, after), (beside, further) in zip(_around(first), _around(second), strict=True):
            triangles += [(here, beside, after), (beside, further, after)]
    return np.array(points), np.array(triangles, np.int32)


def _around(ring: list[int] | range) -> Iterator[tuple[int, int]]:
    """Each point of a ring, and the next one."""
    return zip(ring, [*ring[1:], ring[0]], strict=True)


def _power(number: float, exponent: float) -> float:
    """A power of the size of a number, with its sign."""
    return copysign(abs(number) ** exponent, number)


CURVED: dict[str, Callable[[list[float]], Made | str]] = {
    "hemisphere": hemisphere,
    "supersphere": supersphere,
    "supertorus": supertorus,
}
"""The functions that make them, by the names that files have."""
