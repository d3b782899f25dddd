"""Keyframes of bodies in a single world: adding them, and resets to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.keyframe import BodyKeyframe
from carom.errors import DescriptionError
from carom.native.gates import alone
from carom.scene.handles import world_of
from carom.scene.keyframes.state import captured, changes, check_keyframe, keyframe_of

if TYPE_CHECKING:
    from carom.scene.body import Body


@alone("world.lock")
def add_keyframe(body: Body, keyframe: BodyKeyframe | str) -> None:
    """Add a keyframe to a body, as `Body.add_keyframe` does."""
    world = world_of(body)
    if isinstance(keyframe, str):
        keyframe = captured(body, keyframe, world.time)
    check_keyframe(body, keyframe)
    if not keyframe.name or any(other.name == keyframe.name for other in body.spec.keyframes):
        raise DescriptionError(f"keyframe {keyframe.name!r}: each one of a body needs a name of its own")
    body.spec = replace(body.spec, keyframes=(*body.spec.keyframes, keyframe))


def reset(bodies: Sequence[Body], name: str) -> float:
    """Reset bodies of a world to their keyframes of a name.

    Returns:
        The time of the keyframes.
    """
    time = 0.0
    for body in bodies:
        keyframe = keyframe_of(body, name)
        check_keyframe(body, keyframe)
        world, time = world_of(body), keyframe.time
        state = world.arrays.state.numpy
        for change in changes(body, keyframe):
            state[change.field][0, change.rows] = change.values
        world.contact_arrays.forget_warm_start()
        body.update_link_poses()
        body.update_link_velocities()
    return time
