"""Scaling the shapes of a body."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from pybullet._calls.arguments import Vector, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import BASE

if TYPE_CHECKING:
    from carom.description import Collision
    from carom.scene.body import Body

__all__ = ["unsupportedChangeScaling"]

_WRONG = "scaling needs a 3 coordinates [x,y,z]."
# The shapes of a base before they were scaled for the first time.
_unscaled: WeakKeyDictionary[Body, tuple[Collision, ...]] = WeakKeyDictionary()


@exported
def unsupportedChangeScaling(bodyUniqueId: int, scaling: Vector, physicsClientId: int = 0) -> None:
    """Scales the collision shapes of a body's base, relative to the size at loading.

    Mass, inertia, joints, other links and visual shapes do not change. Spheres use the factor of x, capsules
    those of y and z. A body that does not exist is no error.

    Args:
        bodyUniqueId: The body.
        scaling: Factors along x, y and z, greater than 0.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, the factors are not three finite numbers greater than 0, or a shape
            cannot be scaled by them: cylinders have to stay round, heightfields cannot be scaled, and no
            shape may become greater than 1e15 m.

    Examples:
        >>> p.unsupportedChangeScaling(cube, [2, 2, 2])
        >>> p.unsupportedChangeScaling(cube, [1, 1, 1])
    """
    client = client_of(physicsClientId)
    body = client.body(bodyUniqueId)
    factors = vector3(scaling, _WRONG, "scaling")
    if min(factors) <= 0.0:
        fail(_WRONG, f"The factors have to be greater than 0, not {factors}.")
    if body is None:
        return

    from carom.layouts.flags import LoadFlags
    from carom.model.link_dynamics import LinkDynamics
    from carom.model.scaled_shapes import scaled_collisions

    shapes = client.world.contact_arrays.shapes
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    with client.call_lock, uninterrupted:
        change = Change()
        base = body.spec.base
        unscaled = _unscaled.setdefault(body, base.collisions)
        try:
            # A copy, because bodies from the same file share their specification.
            base = replace(base, collisions=scaled_collisions(unscaled, base.inertial_frame, factors))
            shapes.replace_pieces(change, body.first_link, base, implicit_cylinder=implicit)
        except ValueError as reason:
            fail("unsupportedChangeScaling failed.", f"Body {body.id} ({body.name}): {reason}.")
        change.set(body, "spec", replace(body.spec, base=base))
        change.set(body.dynamics(BASE), "collision_margin", LinkDynamics.of(base).collision_margin)
        change.set(body, "derived", {})
        client.bodies.forget(body.id)
        # As in PyBullet the base has no contacts until the next step, and getLinkState returns current poses.
        client.world.contact_arrays.part(change, [body.first_link])
        client.world.note_link_poses(change, body)
        change.commit()
