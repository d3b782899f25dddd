"""The contacts of a world as records, with the bodies and links that touch."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.checks import Array
from carom.layouts.contacts import THERE
from carom.model.body_spec import BASE
from carom.scene.body import Body
from carom.scene.link import Link

if TYPE_CHECKING:
    from carom.engine.queries.queries import Queries
    from carom.scene.core.world_core import WorldCore
    from carom.scene.shapes import BodyShape

_ANY_BODY, _ANY_LINK = -1, -2
OF_SHAPES = (
    "contacts are asked of bodies and links, not of shapes; records say which shapes touch: "
    "[contact for contact in world.contacts(shape.link) if contact.shape_a == shape]"
)
"""What is said to those who ask for the contacts of a shape."""


class Contact(NamedTuple):
    """Where two links touch, or nearly do, as the last step left it.

    Attributes:
        a: A link; the one that was asked for, if any was.
        b: The other link.
        point_on_a: Point on the surface of `a` [m], world axes, shape (3,).
        point_on_b: Point on the surface of `b`.
        normal: Unit normal on `b` towards `a`, shape (3,).
        distance: [m]; negative where they penetrate.
        normal_force: Along the normal [N], at least 0.
        friction: Force of friction on `a` [N], world axes, shape (3,).
        shape_a: The collision shape of `a`; None of soft bodies.
        shape_b: The collision shape of `b`.
    """

    a: Link
    b: Link
    point_on_a: Array
    point_on_b: Array
    normal: Array
    distance: float
    normal_force: float
    friction: Array
    shape_a: BodyShape | None = None
    shape_b: BodyShape | None = None

    def __repr__(self) -> str:
        a, b = (f"{link.body.name}/{link.name}" for link in (self.a, self.b))
        place, force = (np.array2string(part, precision=4) for part in (self.position, self.force))
        return f"<Contact of {a!r} and {b!r} at {place}: distance {self.distance:.3g}, force {force}>"

    @property
    def position(self) -> Array:
        """The point in the middle between both surfaces [m], world axes, shape (3,)."""
        return 0.5 * (self.point_on_a + self.point_on_b)

    @property
    def body_a(self) -> Body:
        """The body of `a`."""
        return self.a.body

    @property
    def body_b(self) -> Body:
        """The body of `b`."""
        return self.b.body

    @property
    def force(self) -> Array:
        """The whole force on `a` [N], world axes, shape (3,); that on `b` is opposite."""
        return self.normal_force * self.normal + self.friction


def contacts_of(
    queries: Queries,
    bodies: Mapping[int, Body],
    a: Body | Link | None,
    b: Body | Link | None,
    substep_time: float,
) -> list[Contact]:
    """The contacts of `a` with `b`; None stands for anything. The caller has the lock of the world."""
    found = queries.contact_columns(*_sought(a), *_sought(b), substep_time)
    rows = [*islice(zip(*found.columns, strict=False), found.found)]
    if not rows:
        return []
    shapes = ShapesInContact(bodies[rows[0][0]].world)
    return [_record(bodies, row, shapes) for row in rows]


class ShapesInContact:
    """Which shapes touch at the contacts of a world, by their links and points, and in which order."""

    def __init__(self, world: WorldCore) -> None:
        self._world = world
        self._shapes = world.contact_arrays.shapes
        table = world.contact_arrays.contacts.numpy
        count = int(table["count_contacts"][0, THERE])
        self._found: dict[tuple[Any, ...], list[tuple[int, int, float]]] = {}
        columns = (table[f"contact_{name}"][0, :count].tolist() for name in ("shapes", "point_a", "point_b"))
        for (a, b, link_a, link_b), on_a, on_b in zip(*columns, strict=True):
            self._found.setdefault((link_a, link_b, *on_a, *on_b), []).append((a, b, 1.0))
            self._found.setdefault((link_b, link_a, *on_b, *on_a), []).append((b, a, -1.0))

    def of(self, a: Link, b: Link, on_a: Any, on_b: Any) -> tuple[float, BodyShape | None, BodyShape | None]:
        """The sign of forces of friction, and the shapes, of a contact of two links; each is told once.

        Friction is told as a force on the link that the contact has first, whichever was asked for.
        """
        rows = [link.body.first_link + 1 + link.index for link in (a, b)]
        found = self._found.get((*rows, *on_a, *on_b))
        if not found:
            return 1.0, None, None
        first, second, sign = found.pop(0)
        return sign, self._shape(a, rows[0], first), self._shape(b, rows[1], second)

    def _shape(self, link: Link, link_row: int, row: int) -> BodyShape | None:
        number = next((each for each, place in self._shapes.rows_of_collisions(link_row) if place == row), -1)
        return next((shape for shape in link.shapes if shape.number == number), None)


def force_on(contacts: list[Contact]) -> Array:
    """The sum of the forces of contacts on their first links [N], shape (3,)."""
    return sum((contact.force for contact in contacts), np.zeros(3))


def _sought(it: Body | Link | None) -> tuple[int, int]:
    """Number of a body and of its link, as queries take them."""
    if it is None:
        return _ANY_BODY, _ANY_LINK
    return (it.id, _ANY_LINK) if isinstance(it, Body) else (it.body.id, it.index)


def _record(bodies: Mapping[int, Body], row: tuple[Any, ...], shapes: ShapesInContact) -> Contact:
    body_a, body_b, link_a, link_b, on_a, on_b, normal, distance, force, force1, axis1, force2, axis2 = row
    a, b = bodies[body_a].links[max(link_a, BASE)], bodies[body_b].links[max(link_b, BASE)]
    sign, shape_a, shape_b = shapes.of(a, b, on_a, on_b)
    return Contact(
        a,
        b,
        np.array(on_a),
        np.array(on_b),
        np.array(normal),
        distance,
        force,
        sign * (force1 * np.array(axis1) + force2 * np.array(axis2)),
        shape_a,
        shape_b,
    )
