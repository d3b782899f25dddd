"""Copies of worlds."""

from __future__ import annotations

from copy import deepcopy
from typing import TYPE_CHECKING, Any, TypeVar

from carom.native.change import Change
from carom.render.appearance import copy_appearance
from carom.scene.bodies import Bodies
from carom.scene.core.body_core import COMPUTED_HANDLES

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

W = TypeVar("W", bound="WorldCore")


def copy_world(world: W) -> W:
    """Copy a world; see `World.copy`."""
    other = type(world)()
    other.island_threads = world.island_threads
    # Specifications of bodies are never changed, so copies share them.
    memo: dict[int, Any] = {id(world): other}
    memo.update((id(body.spec), body.spec) for body in world.bodies.values())
    other.parameters = deepcopy(world.parameters)
    other.parameters_set = world.parameters_set
    other.law_of_contacts = world.law_of_contacts
    other.bodies = Bodies((number, _copy_body(body, other, memo)) for number, body in world.bodies.items())
    other.listing.update({number: other.bodies[number] for number in world.listing})
    arrays, contact_arrays = deepcopy(world.arrays, memo), deepcopy(world.contact_arrays, memo)
    other.joint_constraints = deepcopy(world.joint_constraints, memo)
    other.user_constraints = deepcopy(world.user_constraints, memo)
    change = Change()
    other.take_arrays(change, arrays, contact_arrays)
    change.commit()
    other.user_data = deepcopy(world.user_data, memo)
    other.free_ids, other.next_id = world.free_ids.copy(), world.next_id
    other.links_loaded = world.links_loaded
    other.time, other.unspent_time = world.time, world.unspent_time
    copy_appearance(world, other)
    if any(body.spec.sensors for body in other.bodies.values()):
        from carom.scene.sensors.changes import switch_on

        switch_on(other, list(other.bodies.values()))
    return other


def _copy_body(body: BodyCore, world: WorldCore, memo: dict[int, Any]) -> BodyCore:
    # `copy` would pickle the handle, with its world.
    other = memo[id(body)] = object.__new__(type(body))
    other.__dict__.update({name: it for name, it in body.__dict__.items() if name not in COMPUTED_HANDLES})
    other.world = world
    other.rows = deepcopy(body.rows, memo)
    other.derived = {}
    other._dynamics = deepcopy(body._dynamics, memo)
    return other
