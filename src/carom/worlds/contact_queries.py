"""Contacts of bodies in many worlds: the part of `Worlds` that answers questions about them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple, cast

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.queries.nearest_pair import NearestFinder
from carom.layouts.magnitudes import MAX_DISTANCE
from carom.native.gates import gated
from carom.scene.bodies import Bodies
from carom.scene.body import Body
from carom.scene.link import Link
from carom.scene.shapes import BodyShape
from carom.world.contacts import OF_SHAPES
from carom.world.world import World
from carom.worlds.body import BodyBatch
from carom.worlds.chosen import Mask
from carom.worlds.contacts import ContactFinder, ContactList, ContactSummary, contact_list
from carom.worlds.parts.links import LinkBatch
from carom.worlds.parts.shapes import ShapeBatch
from carom.worlds.soft_contacts import Side, SoftTouches, soft_touches


class NearnessBatch(NamedTuple):
    """The nearest points of two bodies or links in each world.

    Attributes:
        found: Whether they are within the distance asked for, (count,).
        distance: [m]; negative where they overlap, inf where nothing is found, (count,).
        point_on_a: In world axes [m], (count, 3); NaN where nothing is found.
        point_on_b: Likewise.
        normal: Unit normal on `b` towards `a`, likewise.
    """

    found: Mask
    distance: Array
    point_on_a: Array
    point_on_b: Array
    normal: Array


AnyBody = Body | BodyBatch | int | str
"""A body by its handle, in the original world or in all, by its number, or by its name."""


AnyLink = Link | LinkBatch
"""A link by its handle, in the original world or in all."""


def _body_and_link(it: AnyBody | AnyLink, link: int | str | None) -> tuple[AnyBody, int | str | None]:
    """A body, and the link that is asked for, None for any."""
    if isinstance(it, Link):
        return it.body, it.index
    if isinstance(it, LinkBatch):
        return it._batch._body.id, it.index
    if isinstance(it, BodyShape | ShapeBatch):
        raise TypeError(OF_SHAPES)
    return it, link


class ContactQueries:
    """Base class of `Worlds`: its bodies, what they touch, and with which forces."""

    _scene: World
    _engine: Engine
    _bodies: Bodies[BodyBatch]

    def __getitem__(self, body: AnyBody) -> BodyBatch:
        """A body in all worlds.

        Args:
            body: Its name, its number, or the body in the original world; what this returns gives itself.

        Raises:
            KeyError: That world had no such body.
        """
        return self._bodies.find(body.id if isinstance(body, Body) else body)

    @gated("_scene.call_lock", section=True)
    def detect_collisions(self) -> None:
        """Find the contacts of all worlds for their present coordinates, without a step."""
        if self._engine.can_collide:
            self._engine.detect()

    @gated("_scene.call_lock")
    def contacts(
        self,
        a: AnyBody | AnyLink,
        b: AnyBody | AnyLink | None = None,
        *,
        link: int | str | None = None,
        other_link: int | str | None = None,
        now: bool = False,
    ) -> ContactSummary:
        """Contacts of a body or link with another, or with anything, in each world, as of the last step.

        Contacts of soft bodies with shapes are found for one world after the other; those of two soft bodies
        are not included.

        Args:
            a: The body, or one of its links, in the original world or in all.
            b: The other body, or one of its links; None for any.
            link: Link of `a` by index (-1 is the base) or name, instead of its handle; None for any.
            other_link: Link of `b` likewise.
            now: Find them for the present coordinates first, without a step.
        """
        if now:
            self.detect_collisions()
        body, link = _body_and_link(a, link)
        other: AnyBody | None = None
        if b is not None:
            other, other_link = _body_and_link(b, other_link)
        first, second = self[body], None if other is None else self[other]
        if second is None and other_link is not None:
            raise ValueError("other_link needs other")
        found = self._contact_finder.summary(
            first._link_rows(link),
            None if second is None else second._link_rows(other_link),
            self._scene.parameters.substep_time,
        )
        if self._is_soft(body, other):
            found.include(self._soft_touches(body, link, other, other_link))
        return found

    @gated("_scene.call_lock")
    def nearest(
        self, a: AnyBody | AnyLink, b: AnyBody | AnyLink, max_distance: float = MAX_DISTANCE
    ) -> NearnessBatch:
        """The nearest points of two bodies or links in each world, for the present coordinates.

        Edges are sharp, as for sensors of distances; `World.nearest` has those that Bullet's margin rounds.

        Args:
            a: A body, its name or number, or a link.
            b: Likewise.
            max_distance: How far apart they may be [m].

        Raises:
            KeyError: That world had no such body.
        """
        first, second = self._shape_rows(a), self._shape_rows(b)
        found = self._nearest_finder(first, second, min(max_distance, MAX_DISTANCE))
        is_none = ~found.found[:, np.newaxis]
        points = (
            np.where(is_none, np.nan, each) for each in (found.on_first, found.on_second, found.normals)
        )
        return NearnessBatch(found.found, np.where(found.found, found.distances, np.inf), *points)

    def _shape_rows(self, it: AnyBody | AnyLink) -> list[int]:
        body, link = _body_and_link(it, None)
        shapes = self._scene.contact_arrays.shapes
        found = (shapes.shapes_of(int(row)) for row in self[body]._link_rows(link))
        return [row for each in found for row in range(each.start, each.stop)]

    @cached_property
    def _nearest_finder(self) -> NearestFinder:
        return NearestFinder(self._engine)

    @gated("_scene.call_lock")
    def links_in_contact(self, body: AnyBody, other: AnyBody, other_link: int | str | None = None) -> Mask:
        """Which links of a body have a contact point with another body, as of the last step.

        Points that do not touch yet count as well, as in `ContactSummary.number`. For soft bodies, see
        `contacts`.

        Args:
            body: The body.
            other: The other body.
            other_link: Link of the other body by index (-1 is the base) or name; None for any.

        Returns:
            (count, links + 1) booleans, the base first.
        """
        found = self._contact_finder.links(self[body]._link_rows(None), self[other]._link_rows(other_link))
        if self._is_soft(body, other):
            for world, touches in self._soft_touches(body, None, other, other_link):
                found[world, np.unique(touches.links) + 1] = True
        return found

    @gated("_scene.call_lock")
    def contact_forces(
        self,
        body: AnyBody,
        links: Sequence[int | str] | None = None,
        other: AnyBody | None = None,
        *,
        other_link: int | str | None = None,
    ) -> Array:
        """Forces on links of a body by its contacts with another, or with anything, as of the last step.

        Friction is included. For soft bodies, see `contacts`.

        Args:
            body: The body.
            links: Its links by index (-1 is the base) or name; None for all but the base.
            other: The other body; None for any.
            other_link: Link of the other body by index (-1 is the base) or name; None for any.

        Returns:
            The force on each link in world axes [N], (count, links, 3).
        """
        own, second = self[body], None if other is None else self[other]
        if second is None and other_link is not None:
            raise ValueError("other_link needs other")
        numbers = range(len(own._link_names)) if links is None else [own._link_index(link) for link in links]
        rows = np.array([own._link_rows(link)[0] for link in numbers], dtype=np.int64)
        others = None if second is None else second._link_rows(other_link)
        found = self._contact_finder.forces(rows, others, self._scene.parameters.substep_time)
        if self._is_soft(body, other):
            for world, touches in self._soft_touches(body, None, other, other_link):
                for place, link in enumerate(numbers):
                    found[world, place] += touches.forces[touches.links == link].sum(axis=0)
        return found

    @gated("_scene.call_lock")
    def force_between(self, a: AnyBody | AnyLink, b: AnyBody | AnyLink | None = None) -> Array:
        """The force on a body or link by its contacts with another, or with anything, in the last step.

        Args:
            a: The body, its name or number, or a link.
            b: What it touches, likewise; None for anything.

        Returns:
            In world axes [N], friction included, (count, 3).
        """
        (first, link), (second, other_link) = _body_and_link(a, None), (b, None)
        if b is not None:
            second, other_link = _body_and_link(b, None)
        links = range(-1, len(self[first]._link_names)) if link is None else [link]
        return self.contact_forces(first, links, cast("Any", second), other_link=other_link).sum(axis=1)

    @gated("_scene.call_lock")
    def contact_list(self, body: AnyBody, other: AnyBody | None = None) -> ContactList:
        """All contact points of a body with another, or with anything, as of the last step.

        Those of soft bodies are not included.

        Args:
            body: The body; a point between two of its links is listed once for each of them.
            other: The other body; None for any.

        Returns:
            The points of all worlds, one after the other, sorted by world.
        """
        rows = self[body]._link_rows(None)
        others = None if other is None else self[other]._link_rows(None)
        time = self._scene.parameters.substep_time
        return contact_list(self._engine, rows, others, self._scene.link_places, time)

    def _is_soft(self, body: AnyBody, other: AnyBody | None) -> bool:
        """Whether contacts of bodies, None for any, can be contacts of soft bodies."""
        soft = {item.rows.first["link"] for item in self._scene.contact_arrays.soft.bodies}
        asked = [body] if other is None else [body, other]
        return bool(soft) and (
            other is None or any(self[one]._body_rows.first["link"] in soft for one in asked)
        )

    def _soft_touches(
        self, body: AnyBody, link: int | str | None, other: AnyBody | None, other_link: int | str | None
    ) -> Sequence[tuple[int, SoftTouches]]:
        first, second = self._side(body, link), self._side(other, other_link)
        return soft_touches(self._scene, self._engine, first, second)

    def _side(self, body: AnyBody | None, link: int | str | None) -> Side:
        if body is None:
            return Side.of(None, None)
        return Side.of(self[body].id, None if link is None else self[body]._link_index(link))

    @cached_property
    def _contact_finder(self) -> ContactFinder:
        return ContactFinder(self._engine)
