"""Writing a shape of a link as a prim."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import (
    Box,
    Capsule,
    Collision,
    ConvexHull,
    Cylinder,
    Mesh,
    Plane,
    Pose,
    Sphere,
    TriangleMesh,
    Visual,
)
from carom.description.transform import compose, turn_of_z
from carom.formats.mesh.reader import read_mesh

if TYPE_CHECKING:
    from carom.formats.usd.stage import Points, Triangles
    from carom.formats.usd.target import Target


def write_shape(target: Target, path: str, shape: Collision | Visual) -> Any | None:
    """Write a shape with its frame; None for one that USD has not, which is reported.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    geom, stage, geometry = target.pxr.UsdGeom, target.stage, shape.geometry
    frame, collides = shape.frame, isinstance(shape, Collision)
    match geometry:
        case Box(half):
            prim = geom.Cube.Define(stage, path)
            prim.CreateSizeAttr(2.0)
            target.values.place(prim.GetPrim(), frame)
            geom.Xformable(prim).AddScaleOp(geom.XformOp.PrecisionDouble).Set(target.pxr.Gf.Vec3d(*half))
            return prim.GetPrim()
        case Sphere(radius):
            prim = geom.Sphere.Define(stage, path)
            prim.CreateRadiusAttr(radius)
        case Cylinder(radius, length) | Capsule(radius, length):
            prim = (geom.Capsule if isinstance(geometry, Capsule) else geom.Cylinder).Define(stage, path)
            prim.CreateRadiusAttr(radius)
            prim.CreateHeightAttr(length)
            prim.CreateAxisAttr("Z")
        case Plane(normal):
            prim = geom.Plane.Define(stage, path)
            prim.CreateAxisAttr("Z")
            frame = compose(frame, Pose(orientation=turn_of_z(normal)))
        case Mesh(file, scale, concave):
            parts = read_mesh(file)
            first = np.cumsum([0, *(len(part.vertices) for part in parts)])
            points = np.concatenate([part.vertices for part in parts]) * scale
            corners = np.concatenate(
                [part.triangles + start for part, start in zip(parts, first, strict=False)]
            )
            prim = _mesh(target, path, points, corners, concave=concave, collides=collides)
        case TriangleMesh(points, triangles):
            prim = _mesh(target, path, points, triangles, concave=True, collides=collides)
        case ConvexHull(points):
            triangles = np.array([(0, k, k + 1) for k in range(1, len(points) - 1)], np.int32)
            if isinstance(shape, Visual):
                target.leave_out(
                    "visual", "none for the dynamics: it is not seen", "a hull has no faces", "geometry"
                )
                return None
            prim = _mesh(target, path, points, triangles, concave=False, collides=True)
        case _:
            kind = type(geometry).__name__
            target.leave_out("shape", f"there is no {kind}", "USD has no such shape", "geometry")
            return None
    target.values.place(prim.GetPrim(), frame)
    return prim.GetPrim()


def _mesh(
    target: Target, path: str, points: Points, triangles: Triangles, *, concave: bool, collides: bool
) -> Any:
    pxr = target.pxr
    mesh = pxr.UsdGeom.Mesh.Define(target.stage, path)
    mesh.CreatePointsAttr(pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, np.float32)))
    mesh.CreateFaceVertexCountsAttr(pxr.Vt.IntArray([3] * len(triangles)))
    corners = np.ascontiguousarray(triangles, np.int32).reshape(-1)
    mesh.CreateFaceVertexIndicesAttr(pxr.Vt.IntArray.FromNumpy(corners))
    mesh.CreateSubdivisionSchemeAttr("none")
    if collides:
        api = pxr.UsdPhysics.MeshCollisionAPI.Apply(mesh.GetPrim())
        api.CreateApproximationAttr("none" if concave else "convexHull")
    return mesh
