"""Writing the collision shapes of bodies to rows of `Shapes`, and removing these rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from carom.description.collision_groups import FIXED_GROUP, FIXED_MASK, MOVING_GROUP, MOVING_MASK
from carom.description.shapes.bounds import Bounds
from carom.geometry.hull_graph import rows_of_graph
from carom.layouts.codes import ELLIPSOID_FACETS, ROUNDED, Part, ShapeKind
from carom.layouts.contacts import Shapes
from carom.layouts.dynamics_parameters import OF_SHAPES, SURFACE_FIELDS
from carom.layouts.flags import LoadFlags
from carom.model.body_rows import BodyRows, BodyShapeRows, TreeRows
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.inertia import collision_margin, link_bounds, widens_bounds
from carom.model.link_dynamics import LinkDynamics, Surfaces
from carom.model.pair_filters import PairFilters
from carom.model.placed_pieces import AXES, PlacedPiece, made_poses, placed_pieces, reach, row_counts
from carom.model.shape_pieces import ShapePiece
from carom.native.change import Change
from carom.native.tables import ROOM_AT_FIRST, ArrayTable, room_ahead

BREAKING_FRACTION = 0.02
"""Breaking distance of a contact, relative to the reach of the smaller shape."""

# Half extent of links with planes [m]; its square is still finite.
_UNBOUNDED = 1e18

# Fields that contain row numbers, and the axis of these rows; values are updated when rows are removed.
_INDEX_FIELDS = {
    "shape_link": "link",
    "shape_tree": "tree",
    "shape_first_vertex": "vertex",
    "shape_first_face": "face",
    "shape_first_node": "node",
    "face_first_corner": "corner",
    "corner_vertex": "vertex",
    "link_first_shape": "shape",
}


class ShapeArrays:
    """The shapes of all bodies of a world, in step with the rows of their links.

    Attributes:
        table: The arrays.
        filters: Rules for pairs of links.
        used: Rows in use, by axis.
        breaking_fraction: See `BREAKING_FRACTION`.
        changes: Number of times that the bounds of a shape have changed in its link.
        looks_ahead: Whether any shape has ever had a swept sphere for continuous collision detection.
    """

    def __init__(self) -> None:
        self.table: ArrayTable = ArrayTable(Shapes, first_capacity=ROOM_AT_FIRST, references=_INDEX_FIELDS)
        self.filters: PairFilters = PairFilters(self.table)
        self.used: dict[str, int] = dict.fromkeys(("link", *AXES), 0)
        self.breaking_fraction: float = BREAKING_FRACTION
        self.changes: int = 0
        self.looks_ahead: bool = False
        self._bodies: dict[int, BodyShapeRows] = {}
        # Whether rows that are not in use are zero.
        self._is_clear = True

    @property
    def capacity(self) -> dict[str, int]:
        """Rows there is room for, by axis."""
        return self.table.capacity

    @property
    def shape_count(self) -> int:
        """Number of shapes."""
        return self.used["shape"]

    @property
    def filter_count(self) -> int:
        """Number of pairs of links with a rule of their own."""
        return self.filters.count

    def reserve(self, needed: dict[str, int]) -> bool:
        """Make room for `needed` rows on each axis; true if arrays were replaced."""
        return self.table.reserve(needed)

    def struct(self) -> Any:
        """A C struct whose fields are views of the arrays."""
        return self.table.struct()

    def append(
        self, change: Change, spec: BodySpec, rows: TreeRows, surfaces: Sequence[LinkDynamics]
    ) -> BodyShapeRows:
        """Add the shapes of a body whose links were appended to the model just before.

        `rows` are those of its tree; this object is kept, and read again whenever the body changes.
        `surfaces` are the contact parameters of its links, the base first.

        Raises:
            DescriptionError: The file of a mesh cannot be used; nothing has changed.
        """
        links = [spec.base, *spec.links]
        implicit = bool(spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        pieces = [piece for j, link in enumerate(links) for piece in placed_pieces(link, j, implicit)]
        used = self._begin(change)
        count = row_counts([placed.piece for placed in pieces])
        body = BodyShapeRows(rows, {axis: used[axis] for axis in AXES}, count)
        body.bounds = [link_bounds(link, implicit_cylinder=implicit) for link in links]
        body.margins = [collision_margin(link) for link in links]
        body.widening = [
            widens_bounds(link, [placed.piece for placed in pieces if placed.link == j])
            for j, link in enumerate(links)
        ]
        body.collisions = tuple(placed.collision for placed in pieces)
        needed = {axis: used[axis] + body.count[axis] for axis in AXES}
        needed["link"] = used["link"] + len(links)
        self._make_room(change, needed)
        self._write_links(body, spec, links)
        self._write_pieces(body, pieces)
        for link, surface in enumerate(surfaces):
            self._write_whole_surface(change, body, link, surface)
        self._end(change, body, needed)
        return body

    def put(self, change: Change, known: BodyRows, rows: TreeRows) -> None:
        """Add the shapes of a body whose rows are known and are in the model already; see `append`."""
        used, count = self._begin(change), known.shape_count
        needed = {axis: used[axis] + number for axis, number in count.items()}
        self._make_room(change, needed)
        first = {axis: used[axis] for axis in AXES}
        body = BodyShapeRows(
            rows,
            first,
            {axis: count[axis] for axis in AXES},
            [*known.bounds],
            [*known.margins],
            [*known.widening],
            known.collisions,
        )
        first_row = {**first, "link": used["link"], "tree": rows.tree}
        self.table.row_changes.put(known.shape_rows, first_row, known.packed_shape_count)
        self._end(change, body, {**used, **needed})
        change.set(self, "changes", change.get(self, "changes") + 1)
        if self.breaking_fraction != known.breaking_fraction:
            self._write_breaking(self.table.numpy["shape_breaking"], body, self.breaking_fraction)

    def _make_room(self, change: Change, needed: dict[str, int]) -> None:
        if self.table.lacks(needed):
            change.make_room([self.table], room_ahead(needed))

    @property
    def bodies(self) -> list[BodyShapeRows]:
        """The rows of the shapes of all bodies."""
        return list(self._bodies.values())

    def body_of(self, rows: TreeRows) -> BodyShapeRows:
        """The rows of a body's shapes."""
        return self._bodies[rows.first["link"]]

    def _write_links(self, body: BodyShapeRows, spec: BodySpec, links: Sequence[LinkSpec]) -> None:
        numpy = self.table.numpy
        first = body.rows.first["link"]
        for j, link in enumerate(links):
            self.set_default_group(first + j, fixed=j == 0 and spec.fixed_base and spec.soft is None)
            for collision in link.collisions:
                if collision.group is not None:
                    numpy["link_group"][first + j] = _as_int32(collision.group)
                if collision.mask is not None:
                    numpy["link_mask"][first + j] = _as_int32(collision.mask)
        whole = slice(first, first + len(links))
        numpy["link_made_pose"][whole] = made_poses(links)
        numpy["link_self_collision"][whole] = spec.flags & LoadFlags.ANY_SELF_COLLISION
        numpy["link_first_shape"][whole] = body.first["shape"]
        numpy["link_shape_count"][whole] = 0

    def _write_pieces(self, body: BodyShapeRows, pieces: Sequence[PlacedPiece]) -> None:
        numpy = self.table.numpy
        at = dict(body.first)
        first_link = body.rows.first["link"]
        for placed in pieces:
            piece, row, link = placed.piece, at["shape"], first_link + placed.link
            numpy["shape_link"][row] = link
            numpy["shape_tree"][row] = body.rows.tree
            numpy["shape_kind"][row] = piece.kind
            numpy["shape_columns"][row] = piece.columns
            for axis in ("vertex", "face", "node"):
                numpy[f"shape_first_{axis}"][row] = at[axis]
            if numpy["link_shape_count"][link] == 0:
                numpy["link_first_shape"][link] = row
            numpy["link_shape_count"][link] += 1
            self._write_piece(numpy, body.bounds[placed.link], placed, at)
            at["shape"] += 1
        for link in {placed.link for placed in pieces}:
            self._write_link_bounds(numpy, first_link + link, body.bounds[link])

    def _write_piece(
        self, numpy: Mapping[str, np.ndarray], bounds: Bounds, placed: PlacedPiece, at: dict[str, int]
    ) -> None:
        """Write what can change in a piece, to the rows `at`; those of vertices, faces and nodes advance.

        `bounds` are those of its link.
        """
        piece, row = placed.piece, at["shape"]
        numpy["shape_pose"][row] = placed.pose
        numpy["shape_depth"][row] = placed.depth
        numpy["shape_path"][:, row] = placed.path
        numpy["shape_size"][:, row] = piece.size
        numpy["shape_margin"][:, row] = piece.margin
        numpy["shape_center"][row] = piece.center
        numpy["shape_breaking"][:, row] = self.breaking_fraction * reach(bounds)
        polyhedron, hierarchy = piece.polyhedron, piece.hierarchy
        if polyhedron is None:
            return
        counts = row_counts([piece])
        rows = {axis: slice(at[axis], at[axis] + counts[axis]) for axis in AXES}
        count = len(polyhedron.vertices)
        numpy["shape_vertex_count"][row] = count
        numpy["shape_face_count"][row] = counts["face"]
        numpy["vertex_position"][rows["vertex"]][:count] = polyhedron.vertices
        if piece.graph is not None:
            numpy["vertex_position"][rows["vertex"]][count:] = piece.graph
        numpy["face_plane"][rows["face"]] = polyhedron.planes
        numpy["face_first_corner"][rows["face"]] = polyhedron.first_corner + at["corner"]
        numpy["face_corner_count"][rows["face"]] = polyhedron.corner_count
        numpy["corner_vertex"][rows["corner"]] = polyhedron.corners + at["vertex"]
        if hierarchy is not None:
            numpy["shape_leaf_count"][row] = hierarchy.leaf_count
            numpy["node_lower"][rows["node"]] = hierarchy.lower
            numpy["node_upper"][rows["node"]] = hierarchy.upper
        for axis in ("vertex", "face", "corner", "node"):
            at[axis] += counts[axis]

    def clear_unused(self) -> None:
        """Make rows that are not in use zero: a body that was not added in the end may be in them."""
        if not self._is_clear:
            self.table.clear_beyond(self.used)
            self._is_clear = True

    def _begin(self, change: Change) -> dict[str, int]:
        """Begin to write to unused rows for a change; returns those in use by what was noted so far."""
        used: dict[str, int] = change.get(self, "used")
        if used is self.used:
            self.clear_unused()
        self._is_clear = False
        return used

    def _end(self, change: Change, body: BodyShapeRows, used: dict[str, int]) -> None:
        """Note that rows are used, in which a body has been written."""
        change.put(self._bodies, body.rows.first["link"], body)
        change.set(self, "used", used)
        change.set(self, "_is_clear", True)

    def shape_rows(self, rows: TreeRows) -> tuple[int, int]:
        """First row and number of a body's shapes."""
        body = self._bodies[rows.first["link"]]
        return body.first["shape"], body.count["shape"]

    def remove(self, change: Change, rows: TreeRows) -> None:
        """Remove a body's shapes with a change, while its tree still has rows."""
        first_link, link_count = rows.first["link"], rows.count["link"]
        body = self._bodies[first_link]
        count = {**body.count, "link": link_count}
        first = {**body.first, "link": first_link, "tree": rows.tree}
        self.table.cut(change, first, {**count, "tree": 1}, self.used)
        self.filters.remove(change, first_link, link_count)
        change.set(self, "used", {axis: self.used[axis] - number for axis, number in count.items()})
        bodies = {
            link - link_count if link > first_link else link: other
            for link, other in self._bodies.items()
            if other is not body
        }
        change.set(self, "_bodies", bodies)
        for link, other in self._bodies.items():
            if link > first_link:
                change.set(other, "first", {axis: row - count[axis] for axis, row in other.first.items()})

    def write_surface(self, link_row: int, surface: LinkDynamics) -> None:
        """Write the contact parameters of a link."""
        change = Change()
        self._write_whole_surface(change, *self._body_of(link_row), surface)
        change.commit()

    def _write_whole_surface(
        self, change: Change, body: BodyShapeRows, link: int, surface: LinkDynamics
    ) -> None:
        values = {name: getattr(surface, name) for name in SURFACE_FIELDS}
        if values["collision_margin"] == body.margins[link]:
            del values["collision_margin"]
        link_row = body.rows.first["link"] + link
        for name, value in values.items():
            if name == "collision_margin":
                self._set_margin(change, self.table.numpy, body, link, value)
            else:
                for rows in self._surface_rows(change, name, link_row, value):
                    rows[...] = value
        for rows, value in self._own_surfaces(body, link_row, surface.surfaces):
            rows[...] = value

    def note_surface(self, change: Change, link_row: int, values: Mapping[str, Any]) -> None:
        """Write some contact parameters of a link with a change."""
        for name, value in values.items():
            if name == "collision_margin":
                self._set_margin(change, change.arrays(self.table.numpy), *self._body_of(link_row), value)
            else:
                for rows in self._surface_rows(change, name, link_row, value):
                    change.write(rows, value)

    def note_own_surfaces(self, change: Change, link_row: int, surfaces: Surfaces) -> None:
        """Write with a change the surfaces of a link's shapes that are not as the link's."""
        for rows, value in self._own_surfaces(self._body_of(link_row)[0], link_row, surfaces):
            change.write(rows, value)

    def rows_of_collisions(self, link_row: int) -> Iterator[tuple[int, int]]:
        """The rows of a link's shapes, each behind the number of its collision shape."""
        return self._rows_of_collisions(self._body_of(link_row)[0], link_row)

    def _rows_of_collisions(self, body: BodyShapeRows, link_row: int) -> Iterator[tuple[int, int]]:
        shapes = self.shapes_of(link_row)
        for row in range(shapes.start, shapes.stop):
            yield body.collisions[row - body.first["shape"]], row

    def surface_places(self, name: str, link_row: int) -> list[tuple[str, int | slice]]:
        """The fields and rows that keep a contact parameter of a link, other than its margin."""
        shapes = self.shapes_of(link_row)
        places: list[tuple[str, int | slice]] = []
        if shapes.start < shapes.stop:
            places.append((SURFACE_FIELDS[name], shapes))
        if name == "lateral_friction":
            # Nodes of soft bodies that touch the link meet it at all.
            places.append(("link_node_friction", link_row))
        return places

    def _surface_rows(self, change: Change, name: str, link_row: int, value: Any) -> Iterator[np.ndarray]:
        """Where a contact parameter of a link, other than its margin, is written to."""
        if name == "ccd_swept_sphere_radius" and value > 0.0:
            change.set(self, "looks_ahead", True)
        for field, rows in self.surface_places(name, link_row):
            whole = self.table.numpy[field]
            yield whole[:, rows] if self.table.is_per_world(field) else whole[rows]

    def _own_surfaces(
        self, body: BodyShapeRows, link_row: int, surfaces: Surfaces
    ) -> Iterator[tuple[np.ndarray, Any]]:
        """Where surfaces of a link's shapes that are not as the link's are written to, and their values."""
        if not surfaces:
            return
        for place, row in self._rows_of_collisions(body, link_row):
            own = surfaces[place]
            if own is not None:
                for name in OF_SHAPES:
                    yield self.table.numpy[SURFACE_FIELDS[name]][:, row], getattr(own, name)

    def _set_margin(
        self, change: Change, numpy: Mapping[str, np.ndarray], body: BodyShapeRows, link: int, margin: float
    ) -> None:
        """Set the margin of a link [m]: that of its compound, and of all shapes in it whose radius it is not.

        As in Bullet the bounds grow by as much as the margin, whatever those of the shapes within were.
        """
        link_row = body.rows.first["link"] + link
        shapes = self.shapes_of(link_row)
        kinds = numpy["shape_kind"][shapes]
        is_round = np.isin(kinds, (ShapeKind.SPHERE, ShapeKind.CAPSULE))
        rounded = np.isin(numpy["shape_columns"][shapes], (ROUNDED, ELLIPSOID_FACETS))
        is_round |= (kinds == ShapeKind.HULL) & rounded
        numpy["shape_margin"][0, shapes][~is_round] = margin
        swept = (kinds == ShapeKind.CAPSULE) & (numpy["shape_size"][0, shapes, 2] > 0.0)
        if swept.all() and len(kinds) == 1:
            numpy["shape_size"][0, shapes, 2] = margin
        margins: list[float] = change.get(body, "margins").copy()
        if body.widening[link]:
            bounds: list[Bounds] = change.get(body, "bounds").copy()
            grown = bounds[link].grown(margin - margins[link])
            bounds[link] = grown
            change.set(body, "bounds", bounds)
            numpy["link_center"][:, link_row] = grown.center
            numpy["link_extents"][:, link_row] = np.minimum(grown.half, _UNBOUNDED)
            numpy["shape_breaking"][:, shapes] = self.breaking_fraction * reach(grown)
        margins[link] = margin
        change.set(body, "margins", margins)
        change.set(self, "changes", change.get(self, "changes") + 1)

    def set_default_group(self, link_row: int, *, fixed: bool) -> None:
        """Put a link in the group of fixed bases, which do not collide with each other, or of the rest."""
        _write_default_group(self.table.numpy, link_row, fixed)

    def note_default_group(self, change: Change, link_row: int, *, fixed: bool) -> None:
        """The same with a change."""
        _write_default_group(change.arrays(self.table.numpy), link_row, fixed)

    def set_group_and_mask(self, link_row: int, group: int, mask: int) -> None:
        """Set the collision groups a link is in, and those it collides with, as bits."""
        self.table.numpy["link_group"][link_row] = _as_int32(group)
        self.table.numpy["link_mask"][link_row] = _as_int32(mask)

    def note_group_and_mask(self, change: Change, link_row: int, group: int, mask: int) -> None:
        """The same with a change."""
        change.write(self.table.numpy["link_group"][link_row : link_row + 1], _as_int32(group))
        change.write(self.table.numpy["link_mask"][link_row : link_row + 1], _as_int32(mask))

    def set_breaking_fraction(self, change: Change, fraction: float) -> None:
        """Set the breaking distance of contacts, relative to the reach of a link's shapes, with a change."""
        if fraction == self.breaking_fraction:
            return
        change.set(self, "breaking_fraction", fraction)
        for body in self._bodies.values():
            self._write_breaking(change.arrays(self.table.numpy)["shape_breaking"], body, fraction)

    def _write_breaking(self, breaking: np.ndarray, body: BodyShapeRows, fraction: float) -> None:
        for link, bounds in enumerate(body.bounds):
            breaking[:, self.shapes_of(body.rows.first["link"] + link)] = fraction * reach(bounds)

    def bounds(self, link_row: int) -> Bounds:
        """Bounds of a link's shapes along the axes of its inertial frame, margins included."""
        body, link = self._body_of(link_row)
        return body.bounds[link]

    def replace_pieces(
        self, change: Change, link_row: int, spec: LinkSpec, *, implicit_cylinder: bool
    ) -> None:
        """Write a link's shapes again with a change of their data; the number of rows is the same.

        Raises:
            ValueError: The number of rows or a kind of shape would change; nothing has changed.
        """
        body, link = self._body_of(link_row)
        shapes = self.shapes_of(link_row)
        pieces = placed_pieces(spec, link, implicit_cylinder)
        if len(pieces) != shapes.stop - shapes.start or not all(
            self._fits(placed.piece, row) for row, placed in enumerate(pieces, start=shapes.start)
        ):
            raise ValueError(
                "its shapes would be of another kind, or have another number of parts or corners"
            )
        change.set(self, "changes", self.changes + 1)
        bounds = link_bounds(spec, implicit_cylinder=implicit_cylinder)
        for name, value in (("bounds", bounds), ("margins", collision_margin(spec))):
            values = change.get(body, name)
            change.set(body, name, [*values[:link], value, *values[link + 1 :]])
        numpy = change.arrays(self.table.numpy)
        for row, placed in enumerate(pieces, start=shapes.start):
            at = {axis: int(numpy[f"shape_first_{axis}"][row]) for axis in ("vertex", "face", "node")}
            at["corner"] = int(numpy["face_first_corner"][at["face"]]) if placed.piece.polyhedron else 0
            self._write_piece(numpy, bounds, placed, at | {"shape": row})
        if pieces:
            self._write_link_bounds(numpy, link_row, bounds)

    def _write_link_bounds(self, numpy: Mapping[str, np.ndarray], row: int, bounds: Bounds) -> None:
        """Write the bounds of a link with shapes, and whether these are in a compound."""
        shapes = self.shapes_of(row)
        alone = numpy["shape_depth"][shapes.start] == 0
        numpy["shape_part"][shapes] = Part.ALONE if alone else Part.OTHER
        if not alone:
            numpy["shape_part"][shapes.start] = Part.FIRST
        numpy["link_center"][:, row] = bounds.center
        numpy["link_extents"][:, row] = np.minimum(bounds.half, _UNBOUNDED)

    def _fits(self, piece: ShapePiece, row: int) -> bool:
        """Whether a piece has the same kind and the same numbers of rows as the piece in a row."""
        numpy = self.table.numpy
        counts = row_counts([piece])
        if numpy["shape_kind"][row] != piece.kind:
            return False
        if piece.polyhedron is None:
            return True
        if numpy["shape_columns"][row] != piece.columns:
            return False
        first = int(numpy["shape_first_vertex"][row])
        vertices = int(numpy["shape_vertex_count"][row])
        if piece.graph is not None:
            vertices += rows_of_graph(numpy["vertex_position"][first:], vertices)
        first = int(numpy["shape_first_face"][row])
        faces = slice(first, first + int(numpy["shape_face_count"][row]))
        return (
            vertices == counts["vertex"]
            and int(numpy["shape_face_count"][row]) == counts["face"]
            and int(numpy["face_corner_count"][faces].sum()) == counts["corner"]
        )

    def shapes_of(self, link_row: int) -> slice:
        """The rows of a link's shapes."""
        first = int(self.table.numpy["link_first_shape"][link_row])
        return slice(first, first + int(self.table.numpy["link_shape_count"][link_row]))

    def _body_of(self, link_row: int) -> tuple[BodyShapeRows, int]:
        """The body a link belongs to, and the index of the link in it; the base is 0."""
        body = self._bodies.get(link_row)
        if body is not None:
            return body, 0
        first = max(first for first in self._bodies if first <= link_row)
        return self._bodies[first], link_row - first


def _write_default_group(numpy: Mapping[str, np.ndarray], link_row: int, fixed: bool) -> None:
    numpy["link_group"][link_row] = FIXED_GROUP if fixed else MOVING_GROUP
    numpy["link_mask"][link_row] = FIXED_MASK if fixed else MOVING_MASK


def _as_int32(bits: int) -> int:
    """The lowest 32 bits of an integer as a signed number, the type that kernels use."""
    return int(np.uint32(bits & 0xFFFFFFFF).astype(np.int32))
