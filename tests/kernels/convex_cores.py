"""Cores for kernels that are tested by themselves, and what geometry by brute force says of them."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations, product
from typing import Any

import numpy as np
import warp as wp
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from carom.kernels.shapes.cores import Core
from carom.kernels.types import Int32, Matrix3, Vector3
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, HULL, SPHERE, TRIANGLES

NO_VERTICES = np.zeros((0, 3))
POLYTOPES = (SPHERE, CAPSULE, BOX, HULL, TRIANGLES)
"""Kinds of cores that are hulls of finitely many points."""


@dataclass(frozen=True)
class Solid:
    """A convex set without rounding.

    Attributes:
        kind: As `Core.kind`.
        size: Likewise.
        points: Vertices of a hull in its own frame (n, 3), or corners of a triangle counted from `position`.
        position: Its origin in world axes [m].
        frame: Its axes, the columns of a rotation matrix.
    """

    kind: int
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    points: np.ndarray = field(default_factory=lambda: NO_VERTICES)
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))
    frame: np.ndarray = field(default_factory=lambda: np.eye(3))

    def core(self, first_vertex: int = 0) -> Any:
        """What kernels see of it, with the vertices of a hull from `first_vertex` on."""
        core = Core()
        core.kind = Int32(self.kind)
        core.size = Vector3(*self.size)
        core.position = Vector3(*self.position)
        axes = self.points.T if self.kind == TRIANGLES else self.frame
        core.frame = Matrix3(*axes.ravel())
        core.first_vertex = Int32(first_vertex)
        core.vertex_count = Int32(len(self.points))
        return core

    def corners(self) -> np.ndarray:
        """The points whose hull it is, in world axes (n, 3); a cylinder is none of finitely many."""
        x, y, z = self.size
        local = {
            SPHERE: lambda: np.zeros((1, 3)),
            CAPSULE: lambda: np.array([[0.0, 0.0, y], [0.0, 0.0, -y]]),
            BOX: lambda: np.array(list(product((-x, x), (-y, y), (-z, z)))),
            HULL: lambda: self.points,
            TRIANGLES: lambda: self.points,
        }[self.kind]()
        return self.position + (local if self.kind == TRIANGLES else local @ self.frame.T)

    def farthest(self, direction: np.ndarray) -> float:
        """Height of its farthest point along a direction."""
        if self.kind != CYLINDER:
            return float((self.corners() @ direction).max())
        local = self.frame.T @ direction
        radius, half = self.size[:2]
        rim = radius * np.hypot(local[0], local[1])
        return float(self.position @ direction + rim + half * abs(local[2]))

    def holds(self, point: np.ndarray, tolerance: float) -> bool:
        """Whether a point is in it, or as near as `tolerance` [m]."""
        offset = point - self.position
        if self.kind == CYLINDER:
            x, y, z = self.frame.T @ offset
            radius, half = self.size[:2]
            return bool(np.hypot(x, y) <= radius + tolerance and abs(z) <= half + tolerance)
        return hull_distance(self.corners() - point) <= tolerance


def point() -> Solid:
    return Solid(SPHERE)


def segment(half: float) -> Solid:
    return Solid(CAPSULE, (0.0, half, 0.0))


def box(*half: float) -> Solid:
    x, y, z = half
    return Solid(BOX, (x, y, z))


def cylinder(radius: float, half: float) -> Solid:
    return Solid(CYLINDER, (radius, half, 0.0))


def hull(points: np.ndarray) -> Solid:
    return Solid(HULL, points=points)


def triangle(corners: np.ndarray) -> Solid:
    return Solid(TRIANGLES, points=corners)


def moved(solid: Solid, position: Any, rotation: Rotation | None = None) -> Solid:
    """The same elsewhere; a triangle keeps its axes."""
    frame = solid.frame if rotation is None else rotation.as_matrix()
    return Solid(solid.kind, solid.size, solid.points, np.asarray(position, dtype=float), frame)


def random_polytope(random: np.random.Generator, kind: int) -> Solid:
    """A point, segment, box, hull or triangle of about 0.2 m, turned about its origin."""
    size = random.uniform(0.05, 0.3, 3)
    solid = {
        SPHERE: point,
        CAPSULE: lambda: segment(size[1]),
        BOX: lambda: box(*size),
        HULL: lambda: hull(random.normal(size=(8, 3)) * size),
        TRIANGLES: lambda: triangle(random.normal(size=(3, 3)) * size),
    }[kind]()
    return moved(solid, np.zeros(3), Rotation.from_quat(random.normal(size=4)))


def differences(a: Solid, b: Solid) -> np.ndarray:
    """Differences of the corners of two polytopes (n, 3): their hull is that of all differences of points."""
    return (a.corners()[:, None] - b.corners()[None]).reshape(-1, 3)


def hull_distance(points: np.ndarray) -> float:
    """Distance of the origin from the hull of points: the least from all simplices of up to three of them.

    It is 0 if the hull has an inside and the origin is there.
    """
    has_inside = len(points) > 3 and np.linalg.matrix_rank(points - points[0], tol=1e-9) == 3
    if has_inside and (ConvexHull(points).equations[:, 3] <= 0.0).all():
        return 0.0
    best = np.linalg.norm(points, axis=1).min()
    if len(points) > 1:
        i, j = np.array(list(combinations(range(len(points)), 2))).T
        a, edge = points[i], points[j] - points[i]
        share = np.clip(-(a * edge).sum(1) / np.maximum((edge * edge).sum(1), 1e-300), 0.0, 1.0)
        best = min(best, np.linalg.norm(a + edge * share[:, None], axis=1).min())
    if len(points) > 2:
        i, j, k = np.array(list(combinations(range(len(points)), 3))).T
        a, b, c = points[i], points[j], points[k]
        normal = np.cross(b - a, c - a)
        inside = [(np.cross(p, q) * normal).sum(1) >= 0.0 for p, q in ((a, b), (b, c), (c, a))]
        over = np.logical_and.reduce([*inside, (normal * normal).sum(1) > 1e-24])
        if over.any():
            normal, a = normal[over], a[over]
            heights = np.abs((a * normal).sum(1)) / np.linalg.norm(normal, axis=1)
            best = min(best, heights.min())
    return float(best)


def vertex_array(*solids: Solid) -> Any:
    """The vertices of hulls, one after the other, as kernels see them."""
    points = [solid.points for solid in solids if solid.kind == HULL]
    return wp.array(np.concatenate([NO_VERTICES, *points]), dtype=Vector3, device="cpu")


def cores_of(a: Solid, b: Solid) -> tuple[Any, Any, Any]:
    """Both cores, and the vertices of those that are hulls."""
    return a.core(), b.core(len(a.points) if a.kind == HULL else 0), vertex_array(a, b)
