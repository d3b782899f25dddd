"""Keyframes of bodies in a single world: adding them, and resets to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.keyframe import BodyKeyframe
from carom.errors import DescriptionError
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.handles import world_of
from carom.scene.keyframes.state import captured, changes, check_keyframe, keyframe_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@gated("world.call_lock")
def add_keyframe(body: BodyCore, keyframe: BodyKeyframe | str) -> None:
    """Add a keyframe to a body, as `Body.add_keyframe` does."""
    world = world_of(body)
    if isinstance(keyframe, str):
        keyframe = captured(body, keyframe, world.time)
    check_keyframe(body, keyframe)
    if not keyframe.name or any(other.name == keyframe.name for other in body.spec.keyframes):
        raise DescriptionError(f"keyframe {keyframe.name!r}: each one of a body needs a name of its own")
    # One assignment.
    body.spec = replace(body.spec, keyframes=(*body.spec.keyframes, keyframe))


def reset(bodies: Sequence[BodyCore], name: str, *, with_time: bool) -> None:
    """Reset bodies of a world to their keyframes of a name, and if asked for its time, all at once."""
    world = world_of(bodies[0])
    with world.call_lock, uninterrupted:
        change = Change()
        for body in bodies:
            keyframe = keyframe_of(body, name)
            check_keyframe(body, keyframe)
            state = change.arrays(world_of(body).arrays.state.numpy)
            for part in changes(body, keyframe):
                state[part.field][0, part.rows] = part.values
            world.note_link_poses(change, body)
            world.note_link_velocities(change, body)
            if with_time:
                world.note_time(change, keyframe.time)
        change.run_record(world.quick.cold_start, world.quick)
        change.commit()
