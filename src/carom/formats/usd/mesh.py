"""`Mesh` of USD: its triangles, and what collides in their place by `physics:approximation`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description import Box, ConvexHull, Geometry, Pose, Sphere, TriangleMesh
from carom.errors import CaromError
from carom.files.budget import charge
from carom.formats.usd.stage import Matrix, Points, Stage, Triangles


def read_surface(stage: Stage, prim: Any, matrix: Matrix) -> tuple[Points, Triangles] | None:
    """Points of a mesh in the frame of a link [m], and its faces as triangles; None if it has none.

    Raises:
        DescriptionError: Its faces do not fit its points.
    """
    points = np.array(stage.value(prim, "points", ()), np.float64).reshape(-1, 3)
    counts = np.array(stage.value(prim, "faceVertexCounts", ()), np.int64)
    corners = np.array(stage.value(prim, "faceVertexIndices", ()), np.int64)
    charge("vertices", len(points) + len(corners), file=stage.file)
    holes = np.array(stage.value(prim, "holeIndices", ()), np.int64)
    if not len(points) or not len(counts):
        stage.leave_out(prim, "it has no shape", "a mesh without points or faces")
        return None
    if (
        counts.min() < 0
        or counts.sum() != len(corners)
        or (len(corners) and not 0 <= corners.min() <= corners.max() < len(points))
    ):
        raise stage.error(prim, "faceVertexCounts, faceVertexIndices and points do not fit each other")
    if not np.isfinite(points).all():
        raise stage.error(prim, "a point is not finite")
    triangles = _triangles(counts, corners, holes)
    is_left = str(stage.value(prim, "orientation", "rightHanded")) == "leftHanded"
    if is_left != (np.linalg.det(matrix[:3, :3]) < 0.0):
        triangles = triangles[:, ::-1]
    if not len(triangles):
        stage.leave_out(prim, "it has no shape", "its faces have fewer than three corners")
        return None
    return points @ matrix[:3, :3].T + matrix[:3, 3], np.ascontiguousarray(triangles, np.int32)


def _triangles(counts: NDArray[np.int64], corners: NDArray[np.int64], holes: NDArray[np.int64]) -> Triangles:
    """Fans of all faces that are no holes."""
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    keep = counts >= 3
    keep[holes[(holes >= 0) & (holes < len(counts))]] = False
    fans = []
    for size in np.unique(counts[keep]):
        start = first[keep & (counts == size)]
        for k in range(1, size - 1):
            fans.append(np.stack([corners[start], corners[start + k], corners[start + k + 1]], axis=1))
    return np.concatenate(fans).astype(np.int32) if fans else np.zeros((0, 3), np.int32)


def approximated(
    stage: Stage, prim: Any, points: Points, triangles: Triangles, *, moves: bool
) -> list[tuple[Geometry, Pose]]:
    """What collides for a mesh; what differs from what the file asks for is reported."""
    wanted = str(stage.value(prim, "physics:approximation", "none"))
    used = np.unique(triangles)
    hull: list[tuple[Geometry, Pose]] = [(ConvexHull(points[used], margin=0.0), Pose())]
    if wanted == "convexHull":
        return hull
    if wanted == "convexDecomposition":
        return _pieces(stage, prim, points, triangles) or hull
    lower, upper = points[used].min(axis=0), points[used].max(axis=0)
    x, y, z = (0.5 * (lower + upper)).tolist()
    if wanted == "boundingSphere":
        reach = float(np.linalg.norm(points[used] - (x, y, z), axis=1).max())
        return [(Sphere(reach), Pose((x, y, z)))]
    if wanted == "boundingCube":
        a, b, c = (0.5 * (upper - lower)).tolist()
        return [(Box((a, b, c)), Pose((x, y, z)))]
    if wanted not in ("none", "meshSimplification"):
        consequence = f"its convex hull collides instead of {wanted}" if moves else "its triangles collide"
        stage.leave_out(prim, consequence, "this approximation is not built", "physics:approximation")
    elif moves:
        stage.leave_out(
            prim, "its convex hull collides", "triangles of bodies that move do not", "physics:approximation"
        )
    return hull if moves else [(TriangleMesh(points, triangles), Pose())]


def _pieces(stage: Stage, prim: Any, points: Points, triangles: Triangles) -> list[tuple[Geometry, Pose]]:
    try:
        pieces = stage.solids.pieces(points, triangles)
    except CaromError:
        reason = "convex pieces need CoACD: pip install 'carom[decompose]'"
        stage.leave_out(prim, "its convex hull collides", reason, "physics:approximation")
        return []
    return [(ConvexHull(vertices, margin=0.0), Pose()) for vertices in pieces]
