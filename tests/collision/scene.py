"""Shapes at poses, put into the engine's arrays without bodies, joints or files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom.engine.detection_capacity import scratch_capacity
from carom.geometry.hull import convex_hull
from carom.geometry.polyhedron import Polyhedron, polyhedron_of_triangles
from carom.geometry.triangle_hierarchy import TriangleHierarchy, triangle_hierarchy
from carom.layouts.codes import ShapeKind
from carom.layouts.contacts import MEETING, Contacts, Pairs, Shapes
from carom.layouts.model import ENTRY_VIEWS, Model, Scratch, Settings, State
from carom.layouts.queries import Places, Rays, Searches
from carom.layouts.status import OVERFLOW, STATUS
from carom.native.kernels import (
    abandon_step_kernel,
    begin_step_kernel,
    broad_phase_kernel,
    closest_points_kernel,
    narrow_phase_kernel,
    place_shapes_kernel,
    prepare_rays_kernel,
    rays_kernel,
)
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, ArrayTable

IDENTITY = (0.0, 0.0, 0.0, 1.0)


@dataclass
class Shape:
    """One shape, on a free body of its own."""

    kind: ShapeKind
    size: ArrayLike
    position: ArrayLike = (0.0, 0.0, 0.0)
    orientation: ArrayLike = IDENTITY
    margin: float = 0.0
    breaking: float = 0.02
    polyhedron: Polyhedron | None = None
    hierarchy: TriangleHierarchy | None = None
    columns: int = 0
    static: bool = False


def sphere(radius, **options):
    return Shape(ShapeKind.SPHERE, (radius, 0, 0), margin=radius, **options)


def box(half_extents, **options):
    return Shape(ShapeKind.BOX, half_extents, **options)


def capsule(radius, half_length, **options):
    return Shape(ShapeKind.CAPSULE, (radius, half_length, 0), margin=radius, **options)


def cylinder(radius, half_length, **options):
    return Shape(ShapeKind.CYLINDER, (radius, half_length, 0), **options)


def plane(normal=(0, 0, 1), **options):
    return Shape(ShapeKind.PLANE, normal, static=True, **options)


def hull(points, **options):
    return Shape(
        ShapeKind.HULL, (0, 0, 0), polyhedron=convex_hull(np.asarray(points, dtype=float)), **options
    )


def triangles(vertices, faces, **options):
    surface = polyhedron_of_triangles(np.asarray(vertices, dtype=float), np.asarray(faces))
    hierarchy = triangle_hierarchy(surface)
    return Shape(
        ShapeKind.TRIANGLES,
        (0, 0, 0),
        polyhedron=hierarchy.surface,
        hierarchy=hierarchy,
        static=True,
        **options,
    )


def height_field(heights, spacing=(1.0, 1.0), **options):
    """A height field over a grid centred at the origin; `heights` by row (y) and column (x)."""
    heights = np.asarray(heights, dtype=float)
    rows, columns = heights.shape
    x = (np.arange(columns) - (columns - 1) / 2) * spacing[0]
    y = (np.arange(rows) - (rows - 1) / 2) * spacing[1]
    points = np.stack([*np.meshgrid(x, y), heights], axis=-1).reshape(-1, 3)
    nothing = np.empty(0, dtype=np.int32)
    grid = Polyhedron(points, np.empty((0, 4)), nothing, nothing.copy(), nothing.copy())
    return Shape(ShapeKind.HEIGHTFIELD, (0, 0, 0), polyhedron=grid, columns=columns, static=True, **options)


NEAR = 0.04
"""Gap between bounds up to which they overlap, where nobody has set `contactBreakingThreshold` [m]."""


class Scene:
    """A world of shapes, each its own link and tree."""

    def __init__(self, shapes: Sequence[Shape], contact_room: int = 64, pair_room: int = 64) -> None:
        count = len(shapes)
        self.tables = {
            "shapes": ArrayTable(Shapes),
            "model": ArrayTable(Model),
            "state": ArrayTable(State),
            "scratch": ArrayTable(Scratch, entry_views=ENTRY_VIEWS),
            "contacts": ArrayTable(Contacts),
            "pairs": ArrayTable(Pairs),
        }
        self.tables["shapes"].reserve({"shape": count, "link": count})
        self.tables["model"].reserve({"link": count, "tree": count})
        self.tables["state"].reserve({"link": count, "tree": count})
        self.tables["scratch"].reserve({"link": count})
        self.tables["contacts"].reserve({"contact": contact_room})
        self.grow_scratch(count, pair_room)
        self.settings = Settings()
        self.settings.shape_count = count
        self.settings.near = NEAR
        self._used = {"vertex": 0, "face": 0, "corner": 0, "node": 0}
        for row, shape in enumerate(shapes):
            self._write(row, shape)

    def grow_scratch(self, count: int, pair_room: int) -> None:
        room = scratch_capacity(count, self.tables["contacts"].capacity["contact"])
        self.tables["contacts"].reserve({"overlap": pair_room})
        overlaps = self.tables["contacts"].capacity["overlap"]
        self.tables["pairs"].reserve({**room, "pair": pair_room})
        room = self.tables["pairs"].capacity["pair"]
        self.tables["pairs"].reserve({"queue": room + overlaps, "listed": 2 * room})

    def numpy(self, table: str) -> dict[str, np.ndarray]:
        return self.tables[table].numpy

    def _write(self, row: int, shape: Shape) -> None:
        arrays, model = self.numpy("shapes"), self.numpy("model")
        arrays["shape_link"][row] = row
        arrays["shape_tree"][row] = row
        arrays["shape_kind"][row] = shape.kind
        arrays["shape_size"][0, row] = shape.size
        arrays["shape_pose"][row] = (0, 0, 0, *IDENTITY)
        arrays["shape_margin"][0, row] = shape.margin
        arrays["shape_breaking"][0, row] = shape.breaking
        arrays["link_shape_count"][row] = 1
        arrays["link_made_pose"][row] = (0, 0, 0, *IDENTITY)
        model["tree_first_link"][row] = row
        arrays["link_first_shape"][row] = row
        arrays["link_group"][row] = 1
        arrays["link_mask"][row] = -1
        arrays["shape_anisotropy"][0, row] = 1.0
        arrays["shape_processing_threshold"][0, row] = np.inf
        model["link_parent"][row] = -1
        model["link_dof_count"][row] = 0 if shape.static else 6
        self.place(row, shape.position, shape.orientation)
        if shape.polyhedron is not None:
            self._write_polyhedron(row, shape, shape.polyhedron)

    def _write_polyhedron(self, row: int, shape: Shape, body: Polyhedron) -> None:
        table = self.tables["shapes"]
        nodes = 0 if shape.hierarchy is None else 2 * shape.hierarchy.leaf_count
        count = {
            "vertex": len(body.vertices),
            "face": len(body.planes),
            "corner": len(body.corners),
            "node": nodes,
        }
        first = dict(self._used)
        rows = {axis: slice(first[axis], first[axis] + count[axis]) for axis in count}
        for axis, number in count.items():
            self._used[axis] += number
        table.reserve(self._used)
        arrays = table.numpy
        arrays["shape_first_vertex"][row] = first["vertex"]
        arrays["shape_vertex_count"][row] = count["vertex"]
        arrays["shape_first_face"][row] = first["face"]
        arrays["shape_face_count"][row] = count["face"]
        arrays["shape_columns"][row] = shape.columns
        lower, upper = body.bounds()
        arrays["shape_center"][row] = (lower + upper) / 2
        arrays["shape_size"][0, row] = (upper - lower) / 2
        arrays["vertex_position"][rows["vertex"]] = body.vertices
        arrays["face_plane"][rows["face"]] = body.planes
        arrays["face_first_corner"][rows["face"]] = first["corner"] + body.first_corner
        arrays["face_corner_count"][rows["face"]] = body.corner_count
        arrays["corner_vertex"][rows["corner"]] = first["vertex"] + body.corners
        if shape.hierarchy is not None:
            arrays["shape_first_node"][row] = first["node"]
            arrays["shape_leaf_count"][row] = shape.hierarchy.leaf_count
            arrays["node_lower"][rows["node"]] = shape.hierarchy.lower
            arrays["node_upper"][rows["node"]] = shape.hierarchy.upper

    def place(self, row: int, position: ArrayLike, orientation: ArrayLike = IDENTITY) -> None:
        """Move a shape."""
        self.numpy("state")["link_pose"][0, row] = np.concatenate([position, orientation])

    def structs(self) -> dict[str, Any]:
        return {name: table.struct() for name, table in self.tables.items()}

    def collide(self) -> None:
        """Run collision detection, as the first substep of a step; what does not fit changes no contacts."""
        structs = self.structs()
        self._launch(begin_step_kernel, structs, "model", "state", "scratch", "pairs", scalars=(0,))
        arrays = "shapes", "model", "state", "scratch", "contacts", "pairs"
        self._launch(broad_phase_kernel, structs, *arrays)
        if self.status[STATUS] != OVERFLOW:
            self._launch(narrow_phase_kernel, structs, "shapes", "model", "state", "contacts", "pairs")
        if self.status[STATUS] == OVERFLOW:
            self._launch(abandon_step_kernel, structs, "model", "state", "scratch", "contacts", "pairs")

    def _launch(self, kernel, structs: dict[str, Any], *names: str, scalars: Sequence[int] = ()) -> None:
        first_world = 0
        arguments = [self.settings, *(structs[name] for name in names), *scalars, first_world]
        Launch(kernel, 1, arguments)()

    @property
    def status(self) -> np.ndarray:
        """What became of the last collision detection: columns of `carom.layouts.status`."""
        return self.numpy("state")["status_entry"][0]

    def closest(self, pairs: Sequence[tuple[int, int]], max_distance: float = 1e6) -> np.ndarray:
        """Nearest points: (n, 8) point on b, normal on b, distance, 1 if within reach."""
        structs = self.structs()
        Launch(
            place_shapes_kernel, 1, [self.settings, structs["shapes"], structs["state"], structs["pairs"]]
        )()
        count = len(pairs)
        table = ArrayTable(Searches)
        table.reserve({"search": count})
        for side, name in enumerate(("search_first", "search_second")):
            table.numpy[name][0, :count] = [pair[side] for pair in pairs]
        Launch(
            closest_points_kernel,
            1,
            [structs["shapes"], structs["pairs"], table.struct(), count, NUMPY_REAL(max_distance)],
        )()
        found = table.numpy["search_count"][0, 0]
        nearest = np.zeros((count, 8))
        rows = table.numpy["search_pair"][0, :found]
        for part, columns in (("point", np.s_[:3]), ("normal", np.s_[3:6]), ("distance", 6)):
            nearest[rows, columns] = table.numpy[f"search_found_{part}"][0, :found]
        nearest[rows, 7] = 1.0
        return nearest

    def rays(self, starts, ends, mask: int = -1, hit_number: int = 0, separation: float = 0.0):
        """Shape (-1 for none), fraction and normal of each ray's hit."""
        structs = self.structs()
        Launch(
            prepare_rays_kernel, 1, [self.settings, structs["shapes"], structs["state"], structs["pairs"], 0]
        )()
        starts, ends = (np.reshape(points, (-1, 3)) for points in (starts, ends))
        count, threads = len(starts), 2
        table = ArrayTable(Rays)
        table.reserve({"ray": count})
        table.numpy["ray_start"][:count], table.numpy["ray_end"][:count] = starts, ends
        places = ArrayTable(Places)
        places.reserve({"place": self.settings.shape_count})
        question = (0, count, threads, mask, hit_number, NUMPY_REAL(separation))
        Launch(
            rays_kernel,
            threads,
            [
                structs["shapes"],
                structs["pairs"],
                places.struct(),
                table.struct(),
                *question,
            ],
        )()
        return tuple(table.numpy[name][:count] for name in ("ray_shape", "ray_fraction", "ray_normal"))

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """The pairs that may touch, without those that are only near each other."""
        count = self.numpy("pairs")["count_pairs"][0, 0]
        pairs = self.numpy("pairs")
        rows = zip(pairs["pair_shapes"][0, :count].tolist(), pairs["pair_nearness"][0], strict=False)
        return [tuple(pair) for pair, nearness in rows if nearness == MEETING]

    def contacts(self, name: str) -> np.ndarray:
        """A field of the present contacts, without `contact_`."""
        count = self.numpy("contacts")["count_contacts"][0, 0]
        return self.numpy("contacts")["contact_" + name][0, :count]
