"""Writing a shape of a link as a prim."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import Collision, ConvexHull, Geometry, Mesh, Pose, TriangleMesh, Visual
from carom.description.shapes.shape import Measure
from carom.description.transform import compose
from carom.meshes.reader import read_mesh

# Sides of circles, where a round shape is written as a mesh.
_SEGMENTS = 24

if TYPE_CHECKING:
    from carom.formats.usd.stage import Points, Triangles
    from carom.formats.usd.target import Target


def write_shape(target: Target, path: str, shape: Collision | Visual) -> Any | None:
    """Write a shape with its frame; None for one that USD has not, which is reported.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    geometry = shape.geometry
    frame, collides = shape.frame, isinstance(shape, Collision)
    match geometry:
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
        case _ if geometry.usd:
            return _primitive(target, path, geometry, frame)
        case _ if geometry.facets() is not None:
            target.leave_out(
                "shape", "its facets collide, by their hull", "USD has no such shape", "geometry"
            )
            surface = geometry.surface(_SEGMENTS)
            points, triangles = surface.positions.astype(np.float64), surface.triangles.astype(np.int32)
            prim = _mesh(target, path, points, triangles, concave=False, collides=collides)
        case _:
            kind = type(geometry).__name__
            target.leave_out("shape", f"there is no {kind}", "USD has no such shape", "geometry")
            return None
    target.values.place(prim.GetPrim(), frame)
    return prim.GetPrim()


def _primitive(target: Target, path: str, geometry: Geometry, frame: Pose) -> Any:
    """A shape that lengths describe: along z, or a cube of size 2 with a scale."""
    pxr = target.pxr
    prim = getattr(pxr.UsdGeom, geometry.usd).Define(target.stage, path)
    for it in geometry.parameters:
        name, default = it.usd
        if it.measure is Measure.LENGTHS:
            getattr(prim, f"Create{name}Attr")(default)
            target.values.place(prim.GetPrim(), frame)
            scale = pxr.UsdGeom.Xformable(prim).AddScaleOp(pxr.UsdGeom.XformOp.PrecisionDouble)
            scale.Set(pxr.Gf.Vec3d(*getattr(geometry, it.field)))
            return prim.GetPrim()
        if name:
            getattr(prim, f"Create{name}Attr")(getattr(geometry, it.field))
    if len(geometry.parameters) > 1 or geometry.is_unbounded:
        prim.CreateAxisAttr("Z")
    if geometry.is_unbounded:
        frame = compose(frame, Pose(orientation=geometry.own_turn()))
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
