"""Random objects to grasp and to clear away: tapered beams that cross, of the sizes of PyBullet's.

The sizes are measured ones, of bounds and volumes; the shapes are drawn by lot.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from tools.assets.obj_mesh import ObjMesh, ObjParts
from tools.assets.parts import Inertial, Link, Mesh, Paint, Robot, Shape, Vector3, diagonal
from tools.assets.random_objects.solids import Part

SIZES = Path(__file__).with_name("sizes.csv")
COUNT = 200
"""How many objects there are."""
UNITS = 1000
"""Corners are whole numbers: so many of them span the bounds along each axis."""
FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
"""Of a beam: its two ends, then its sides."""


@dataclass(frozen=True)
class Wanted:
    """What an object is to measure, and the arrangement of beams that was found for it.

    Attributes:
        low: Least coordinates of its bounds [m].
        high: Greatest ones [m].
        fill: Share of the bounds that it fills.
        hull: Share of the bounds that its convex hull fills.
        alone: It is one convex part.
        lot: Seed of the arrangement.
        thick: How thick its beams are, of their greatest widths.
    """

    low: Vector3
    high: Vector3
    fill: float
    hull: float
    alone: bool
    lot: int
    thick: float


@dataclass(frozen=True)
class Beam:
    """A beam along an axis of the unit cube: where it begins and ends, and what it is like across."""

    axis: int
    span: tuple[float, float]
    centre: tuple[float, float]
    widths: tuple[float, float]
    taper: float


@cache
def wanted() -> tuple[Wanted, ...]:
    """The sizes of all objects, by number."""
    rows = np.loadtxt(SIZES, delimiter=",", skiprows=1)
    return tuple(
        Wanted((x0, y0, z0), (x1, y1, z1), fill, hull, parts == 1, int(lot), thick)
        for _, parts, x0, y0, z0, x1, y1, z1, fill, hull, lot, thick in rows.tolist()
    )


def parts(number: int) -> list[Part]:
    """The beams of an object, with whole numbers from 0 to `UNITS` as coordinates."""
    goal = wanted()[number]
    return arranged(drawn(goal.lot, alone=goal.alone), goal.thick)


def arranged(beams: list[Beam], thick: float) -> list[Part]:
    """Beams so thick, of their greatest widths, on whole numbers, so that they span the bounds exactly."""
    shape = [part_of(beam, thick) for beam in beams]
    return [Part(np.rint(UNITS * part.corners), part.faces) for part in shape]


def drawn(lot: int, *, alone: bool = False) -> list[Beam]:
    """One beam through the whole cube along each axis, and up to three that reach half through it.

    One that is alone is as thick as the cube at its wider end.
    """
    random = np.random.default_rng(lot)
    if alone:
        axis, beam = int(random.integers(3)), _beam(random, 0, (0.0, 1.0))
        return [Beam(axis, beam.span, beam.centre, (1.0, 1.0), beam.taper)]
    beams = [_beam(random, axis, (0.0, 1.0)) for axis in range(3)]
    for _ in range(int(random.integers(4))):
        end = float(random.uniform(0.4, 0.7))
        span = (0.0, end) if random.random() < 0.5 else (1.0 - end, 1.0)
        beams.append(_beam(random, int(random.integers(3)), span))
    return beams


def _beam(random: np.random.Generator, axis: int, span: tuple[float, float]) -> Beam:
    across, along, first, second = random.uniform(0.0, 1.0, 4).tolist()
    wide, narrow = random.uniform(0.35, 1.0, 2).tolist()
    taper = float(random.uniform(0.05, 1.0))
    return Beam(axis, span, (_apart(across, first), _apart(along, second)), (wide, narrow), taper)


def _apart(place: float, lot: float) -> float:
    """A third of all beams lie against the low side, a third against the high one."""
    return 0.0 if lot < 1.0 / 3.0 else 1.0 if lot < 2.0 / 3.0 else place


def part_of(beam: Beam, thick: float) -> Part:
    """A beam as a polyhedron within the unit cube."""
    edges: list[tuple[float, float]] = []
    for centre, width in zip(beam.centre, beam.widths, strict=True):
        whole = min(1.0, width * thick)
        low = (1.0 - whole) * centre
        edges.append((low, low + whole))
    (x0, x1), (y0, y1) = edges
    base = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    narrowed = 1.0 - (1.0 - beam.taper) * max(0.0, 1.0 - thick / 2.0)
    middle = (x0 + (x1 - x0) * beam.centre[0], y0 + (y1 - y0) * beam.centre[1])
    top = [tuple(m + narrowed * (c - m) for c, m in zip(corner, middle, strict=True)) for corner in base]
    rings = zip(beam.span, (base, top), strict=True)
    corners = np.array([[*corner, end] for end, ring in rings for corner in ring])
    return Part(np.roll(corners, beam.axis + 1, axis=1), FACES)


def mesh(number: int) -> ObjParts:
    """The OBJ file of an object, a hull for each beam."""
    goal = wanted()[number]
    low = np.rint(np.array(goal.low) / scale_of(goal))
    return ObjParts([ObjMesh(part.corners + low, part.faces) for part in parts(number)])


def scale_of(goal: Wanted) -> Vector3:
    """What corners in whole numbers are to be multiplied by [m].

    Bounds then have the edges that they should, and lie where they should within half of it. An origin in the
    URDF file would place them exactly, but PyBullet widens the bounds of shapes that have one.
    """
    x, y, z = ((np.array(goal.high) - np.array(goal.low)) / UNITS).tolist()
    return x, y, z


def robot(number: int) -> Robot:
    """The URDF file of an object."""
    name = f"{number:03d}"
    shape = Shape(Mesh(f"{name}.obj", scale_of(wanted()[number])))
    seen = Shape(shape.geometry, paint=Paint("lot", (*_colour(number), 1.0)))
    inertial = Inertial(0.1, tensor=diagonal(1.0, 1.0, 0.0))
    contact: dict[str, float | None] = {"lateral_friction": 1.0, "inertia_scaling": 3.0}
    link = Link(f"random_obj_{name}", inertial, (seen,), (shape,), contact)
    return Robot(f"blob{name}", "An object to grasp and to clear away.", (link,))


def _colour(number: int) -> tuple[float, float, float]:
    red, green, blue = np.random.default_rng((number, 1)).uniform(0.0, 1.0, 3).round(2).tolist()
    return red, green, blue
