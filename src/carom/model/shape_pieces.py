"""Conversion of collision shapes to the pieces that collision detection supports: `ShapePiece`."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from functools import lru_cache
from threading import RLock
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.description import ConvexHull, Geometry, Heightfield, Mesh, SignedDistanceField, TriangleMesh
from carom.description.geometry import Primitive
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.geometry.corner_order import Grid, corner_order
from carom.geometry.hull import SMALLEST, convex_hull, extreme_points, gridded_hull
from carom.geometry.hull_graph import CLIMBED, packed_graph, spread_first
from carom.geometry.joined_faces import joined_by_direction
from carom.geometry.polyhedron import Polyhedron, polyhedron_of_loops, polyhedron_of_triangles
from carom.layouts.codes import ELLIPSOID_FACETS, ROUNDED, WITH_GRAPH, ShapeKind
from carom.layouts.contacts import MARGIN
from carom.meshes import MeshPart, read_mesh
from carom.native.digest import blake2b

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.geometry.triangle_hierarchy import TriangleHierarchy

MAX_HULL_VERTICES = 512
"""Most vertices of a hull; hulls of finer meshes are simplified."""

MAX_COMPLETE_VERTICES = 8192
"""Most vertices of a hull that keeps all its corners."""

HULL_TOLERANCE = 1e-4
"""Points outside a hull by less than this fraction of its size (half a cell of the grid) are left out."""

MAX_HULLS = 8192
"""Most hulls that are kept, by the points they are of."""

MAX_KEPT_VERTICES = 2048 * MAX_HULL_VERTICES
"""Most vertices of these hulls together: 120 MB."""

_CACHED = 1024

MeshGeometry = ConvexHull | TriangleMesh


class ShapePiece(NamedTuple):
    """One convex shape, one triangle mesh or one height field.

    Attributes:
        kind: The kind of shape.
        size: Sizes [m], or the normal of a plane; `ShapeKind` lists them for each kind.
        margin: Bullet's collision margin [m]: the radius of a sphere or capsule, the radius of the rounded
            edges of a box or cylinder, or the distance of the surface of a hull or mesh from its vertices.
        center: Centre of the bounds in the shape frame; half their size is `size` for polyhedra.
        polyhedron: Vertices and faces, if it has any.
        columns: Points in one row of a height field; `ROUNDED` for a hull whose margin is a part of it,
            `ELLIPSOID_FACETS` for one that stands for an ellipsoid, `WITH_GRAPH` for one with a graph.
        hierarchy: Boxes over the faces of a triangle mesh.
        graph: Of a hull of many vertices, which are beside each other, see `geometry.hull_graph`.
    """

    kind: ShapeKind
    size: Vector3
    margin: float = 0.0
    center: Vector3 = (0.0, 0.0, 0.0)
    polyhedron: Polyhedron | None = None
    columns: int = 0
    hierarchy: TriangleHierarchy | None = None
    graph: NDArray[np.float64] | None = None


_hulls: OrderedDict[bytes, ShapePiece] = OrderedDict()
_kept_vertices = [0]
# The thread that holds it may come again: a signal handler or a finalizer can load files.
_hulls_lock = RLock()


def shape_pieces(geometry: Geometry, *, implicit_cylinder: bool) -> Sequence[ShapePiece]:
    """The pieces of a shape for collision detection; all of them share the frame of the shape.

    There is one piece, or one for each group of an OBJ file; none for a signed distance field, which nothing
    collides with. Unless cylinders are implicit, they are hulls of 32 sides.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    match geometry:
        case ConvexHull():
            return (_hull_of(geometry),)
        case TriangleMesh():
            return (_triangles_of(geometry),)
        case Heightfield():
            return (_heightfield_piece(geometry),)
        case Mesh():
            pieces = (
                shape_pieces(it, implicit_cylinder=implicit_cylinder) for it in mesh_geometries(geometry)
            )
            return tuple(piece for several in pieces for piece in several)
        case SignedDistanceField():
            return ()
        case _:
            core = geometry.core(implicit_cylinder=implicit_cylinder)
            return (_faceted(geometry) if core is None else ShapePiece(*core),)


def _polyhedral(
    kind: ShapeKind,
    polyhedron: Polyhedron,
    margin: float,
    columns: int = 0,
    hierarchy: TriangleHierarchy | None = None,
) -> ShapePiece:
    low, high = polyhedron.bounds()
    half_x, half_y, half_z = (0.5 * (high - low)).tolist()
    x, y, z = (0.5 * (high + low)).tolist()
    return ShapePiece(kind, (half_x, half_y, half_z), margin, (x, y, z), polyhedron, columns, hierarchy)


def _hull_piece(
    points: NDArray[np.float64],
    margin: float = MARGIN,
    uses: NDArray[np.int32] | None = None,
    *,
    keeps_all: bool = False,
) -> ShapePiece:
    """The hull of points, once made for the same ones: files and scripts bring the same again and again."""
    content = np.append(points.astype(np.float64), margin).tobytes()
    if uses is not None:
        content += uses.tobytes()
    if keeps_all:
        content += b"all"
    key = blake2b(content, digest_size=20).digest()
    with _hulls_lock:
        known = _hulls.pop(key, None)
        if known is not None:
            _hulls[key] = known
            return known
    made = _made_hull(points, margin, uses, keeps_all)
    with _hulls_lock:
        # Another thread may have made it, too.
        if (other := _hulls.pop(key, None)) is not None:
            _kept_vertices[0] -= _vertices(other)
        _hulls[key] = made
        _kept_vertices[0] += _vertices(made)
        while len(_hulls) > MAX_HULLS or (_kept_vertices[0] > MAX_KEPT_VERTICES and len(_hulls) > 1):
            _kept_vertices[0] -= _vertices(_hulls.popitem(last=False)[1])
    return made


def _vertices(piece: ShapePiece) -> int:
    return 0 if piece.polyhedron is None else len(piece.polyhedron.vertices)


def _made_hull(
    points: NDArray[np.float64], margin: float, uses: NDArray[np.int32] | None, keeps_all: bool
) -> ShapePiece:
    try:
        if keeps_all:
            hull = convex_hull(points, most_vertices=MAX_COMPLETE_VERTICES, coplanar=0.0)
            return _complete_piece(hull, margin)
        elif _has_a_grid(points, margin):
            hull = gridded_hull(points, uses, tolerance=HULL_TOLERANCE, most_vertices=MAX_HULL_VERTICES)
        else:
            hull = convex_hull(points, tolerance=HULL_TOLERANCE, most_vertices=MAX_HULL_VERTICES)
    except ValueError as problem:
        # The points are too far apart, or flat and so far apart that rounding removes the added thickness.
        raise DescriptionError(f"its points make no convex hull: {problem}") from problem
    return _polyhedral(ShapeKind.HULL, hull, margin)


def _complete_piece(fine: Polyhedron, margin: float) -> ShapePiece:
    """A hull with all its vertices, with the faces of MuJoCo's meshes."""
    joined = joined_by_direction(fine)
    if len(fine.vertices) <= CLIMBED:
        return _polyhedral(ShapeKind.HULL, joined, margin)
    fine, joined = spread_first(fine, joined)
    graph = packed_graph(fine, joined)
    return _polyhedral(ShapeKind.HULL, joined, margin, WITH_GRAPH)._replace(graph=graph)


@lru_cache(_CACHED)
def _faceted(geometry: Primitive) -> ShapePiece:
    facets = geometry.facets()
    assert facets is not None, "what is no kind of the engine has facets"
    points, ranks = facets.points, None
    if facets.on_grid:
        if min(geometry.lengths()) < SMALLEST:
            return _hull_piece(points, facets.margin)
        # Wheels roll from corner to corner: with corners off by 1e-4 of the radius, they would drift from
        # PyBullet's.
        grid = Grid(points)
        _, ranks = corner_order(points, grid)
        points = grid.places(grid.cells(points))
    # Made without `convex_hull`, which would leave out corners of round ones.
    corners = np.array([corner for face in facets.faces for corner in face], dtype=np.int32)
    counts = np.array([len(face) for face in facets.faces], dtype=np.int32)
    polyhedron = polyhedron_of_loops(points, corners, counts, ranks)
    piece = _polyhedral(ShapeKind.HULL, polyhedron, facets.margin, 0 if facets.on_grid else ROUNDED)
    if facets.half_axes is None:
        return piece
    return piece._replace(size=facets.half_axes, center=(0.0, 0.0, 0.0), columns=ELLIPSOID_FACETS)


def grid_corners(hull: ConvexHull) -> NDArray[np.float64]:
    """The corners (n, 3) that PyBullet has of a hull [m], in its order: those of all points on the grid.

    Moving points may make other ones corners. Hulls without a margin are on no grid.

    Raises:
        ValueError: There are no points, or one is not finite.
    """
    points = np.asarray(hull.points, dtype=np.float64).reshape(-1, 3)
    if not np.isfinite(points).all() or not _has_a_grid(points, hull.margin, flat=True):
        return extreme_points(points)
    grid = Grid(points)
    corners, _ = corner_order(points, grid, hull.uses)
    return grid.places(grid.cells(points[corners]))


def _has_a_grid(points: NDArray[np.float64], margin: float, *, flat: bool = False) -> bool:
    """Whether PyBullet makes the hull of points on a grid. `flat`: also where they have no extent."""
    if not margin > 0.0 or not len(points):
        return False
    extent = points.max(axis=0) - points.min(axis=0)
    return bool(((extent > SMALLEST) | (flat & (extent == 0.0))).all())


@lru_cache(_CACHED)
def _hull_of(geometry: ConvexHull) -> ShapePiece:
    return _hull_piece(geometry.points, geometry.margin, geometry.uses, keeps_all=geometry.keeps_all)


@lru_cache(_CACHED)
def _triangles_of(geometry: TriangleMesh) -> ShapePiece:
    surface = polyhedron_of_triangles(geometry.vertices, geometry.triangles)
    if not len(surface.planes):
        raise DescriptionError("no triangle of the mesh has an area")
    from carom.geometry.triangle_hierarchy import triangle_hierarchy

    hierarchy = triangle_hierarchy(surface)
    return _polyhedral(ShapeKind.TRIANGLES, hierarchy.surface, geometry.margin, hierarchy=hierarchy)


@lru_cache(_CACHED)
def _heightfield_piece(geometry: Heightfield) -> ShapePiece:
    from carom.geometry.heightfield import heightfield_surface

    surface = heightfield_surface(geometry.heights, geometry.scale, geometry.middle)
    return _polyhedral(ShapeKind.HEIGHTFIELD, surface, 0.0, geometry.heights.shape[1])


def mesh_geometries(mesh: Mesh) -> tuple[MeshGeometry, ...]:
    """A hull for each group of an OBJ file, one for any other file; one triangle mesh if it is concave.

    They are scaled. Raises `DescriptionError` if the file cannot be used.
    """
    # For an unchanged file, `read_mesh` returns the same part objects.
    return _geometries_of_parts(mesh, tuple(read_mesh(mesh.path)))


@lru_cache(_CACHED)
def _geometries_of_parts(mesh: Mesh, parts: tuple[MeshPart, ...]) -> tuple[MeshGeometry, ...]:
    if mesh.concave:
        return (TriangleMesh(*joined_parts(parts, mesh.scale), scale=mesh.scale),)
    scale = np.array(mesh.scale)
    is_compound = mesh.path.suffix.lower() == ".obj"
    groups = [[part] for part in parts] if is_compound else [list(parts)]
    return tuple(
        ConvexHull(
            np.concatenate([part.vertices for part in group]) * scale,
            mesh.scale,
            mesh.margin,
            uses=np.concatenate([_uses(part) for part in group]),
        )
        for group in groups
    )


def _uses(part: MeshPart) -> NDArray[np.int32]:
    """How often PyBullet has each vertex, (n,): once for each triangle it is a corner of."""
    return np.bincount(part.triangles.reshape(-1), minlength=len(part.vertices)).astype(np.int32)


def joined_parts(parts: Sequence[MeshPart], scale: Vector3) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Scaled vertices (n, 3) and triangles (m, 3) of all parts; those of mirrored meshes are reversed."""
    vertices = np.concatenate([part.vertices for part in parts]) * np.array(scale)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    triangles = np.concatenate(
        [part.triangles + start for part, start in zip(parts, starts, strict=False)]
    ).astype(np.int32)
    return vertices, triangles[:, ::-1] if np.prod(scale) < 0.0 else triangles
