"""The contacts of a world as records, with the bodies and links that touch."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.checks import Array
from carom.model.body_spec import BASE
from carom.scene.body import Body
from carom.scene.link import Link

if TYPE_CHECKING:
    from carom.queries.queries import Queries

_ANY_BODY, _ANY_LINK = -1, -2


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
    """

    a: Link
    b: Link
    point_on_a: Array
    point_on_b: Array
    normal: Array
    distance: float
    normal_force: float
    friction: Array

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
    return [_record(bodies, row) for row in islice(zip(*found.columns, strict=False), found.found)]


def force_on(contacts: list[Contact]) -> Array:
    """The sum of the forces of contacts on their first links [N], shape (3,)."""
    return sum((contact.force for contact in contacts), np.zeros(3))


def _sought(it: Body | Link | None) -> tuple[int, int]:
    """Number of a body and of its link, as queries take them."""
    if it is None:
        return _ANY_BODY, _ANY_LINK
    return (it.id, _ANY_LINK) if isinstance(it, Body) else (it.body.id, it.index)


def _record(bodies: Mapping[int, Body], row: tuple[Any, ...]) -> Contact:
    body_a, body_b, link_a, link_b, on_a, on_b, normal, distance, force, force1, axis1, force2, axis2 = row
    return Contact(
        bodies[body_a].links[max(link_a, BASE)],
        bodies[body_b].links[max(link_b, BASE)],
        np.array(on_a),
        np.array(on_b),
        np.array(normal),
        distance,
        force,
        force1 * np.array(axis1) + force2 * np.array(axis2),
    )
