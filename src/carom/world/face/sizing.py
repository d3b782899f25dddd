"""Setting the sizes of collision shapes of a lone world, and of what shows them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import finite
from carom.description import Geometry
from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from carom.render.appearance import appearance_of
from carom.scene.dynamics.sizes import note_sizes, sides_from
from carom.scene.handles import world_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.scene.core.body_core import BodyCore


def set_size(body: BodyCore, link: int, number: int, value: ArrayLike) -> None:
    """Set the sides of a shape of a link [m]: three, or one for all of them.

    Raises:
        ValueError: There is no such shape.
    """
    world = world_of(body)
    given = finite(value, "size")
    if given.shape not in ((), (1,), (3,)):
        raise ValueError(f"size must be three lengths, or one, not an array of shape {given.shape}")
    if body.spec.soft is not None:
        raise ValueError("the size of a soft body can't be set: load it with another scale")
    x, y, z = sides_from(np.broadcast_to(given, (3,))).tolist()
    geometries: list[Geometry] = [it.geometry for it in body.link_spec(link).collisions]
    try:
        geometries[number] = geometries[number].with_sides(x, y, z)
        with world.call_lock, uninterrupted:
            resize(body, link, geometries)
    except ValueError as reason:
        raise ValueError(f"the size of a shape of {body.name!r} can't be set: {reason}") from None


def resize(body: BodyCore, link: int, geometries: Sequence[Geometry], *, keep_contacts: bool = False) -> None:
    """Give the shapes of a link, and the visible ones that show the same shapes, other sizes.

    Raises:
        ValueError: The shapes of other sizes would need other rows.
    """
    world = body.world
    world.refuse_in_step()
    change = Change()
    own = body.link_spec(link).collisions
    note_sizes(change, body, link, geometries, keep_contacts=keep_contacts)
    appearance = appearance_of(world)
    if appearance.knows(body):
        # Those of visible shapes that show the same; all others stay as they are.
        for number, geometry in enumerate(geometries):
            if geometry != own[number].geometry:
                looks = appearance.shapes(body, link)
                for place in appearance.shown_by(body, link, number, alike=True):
                    appearance.note_geometry(change, looks[place], geometry)
    change.commit()
