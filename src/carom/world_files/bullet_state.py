"""Restoring bodies from a file that PyBullet wrote: poses, velocities and joints, matched as PyBullet does.

Bodies with reduced coordinates are matched by their order, those with maximal coordinates by the order in
which they were created. Contacts, constraints, motors and parameters in the file are not used; contacts are
found at the next step.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from carom.errors import DescriptionError, StateError
from carom.formats.bullet import BulletState, MultiBodyState, RigidBodyState, is_bullet, read_bullet_state
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.core.soft_core import SoftCore

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# Rows of the state arrays with their new content: positions, then velocities.
_Rows = tuple[int, tuple[float, ...]]


def refuse_to_load(data: bytes, path: Path) -> None:
    """Raise `DescriptionError` if the content of a file is Bullet's, which contains no complete bodies."""
    if not is_bullet(data):
        return
    state = read_bullet_state(data, path)
    raise DescriptionError(
        f"PyBullet wrote this file. It contains the state of {len(state.multi_bodies)} bodies with reduced "
        f"and of {len(state.rigid_bodies)} with maximal coordinates, but no names, colours or frames of "
        "links, so that bodies cannot be made of it. Load the same bodies from their own files, in the same "
        "order, and then restore their state from this file",
        file=path,
    )


def restore_bullet(
    world: WorldCore, data: bytes, path: Path, *, maximal: Collection[int] = (), update_poses: bool = False
) -> None:
    """Restore the state of bodies from the content of a file that PyBullet wrote.

    Args:
        world: The world with the bodies, created in the order of the world that was saved.
        data: The content.
        path: The file, for error messages.
        maximal: Numbers of the bodies that have maximal coordinates in PyBullet.
        update_poses: As in `World.restore`.

    Raises:
        DescriptionError: The file cannot be used; the world is as it was.
        StateError: The world has other bodies; it is as it was.
    """
    state = read_bullet_state(data, path)
    rows = [pair for body, saved in _matched(world, state, maximal) for pair in _rows(body, saved)]
    _put(world, rows, update_poses)


def _matched(
    world: WorldCore, state: BulletState, maximal: Collection[int]
) -> Iterator[tuple[BodyCore, MultiBodyState | RigidBodyState]]:
    bodies = [body for body in world.listing.values() if not isinstance(body, SoftCore)]
    reduced = [body for body in bodies if body.id not in maximal]
    others = sorted((body for body in bodies if body.id in maximal), key=lambda body: body.id)
    if len(reduced) != len(state.multi_bodies):
        raise StateError(
            f"the world has {len(reduced)} bodies with reduced coordinates; PyBullet saved the state of "
            f"{len(state.multi_bodies)}"
        )
    if len(others) < len(state.rigid_bodies):
        raise StateError(
            f"the world has {len(others)} bodies with maximal coordinates; PyBullet saved the state of "
            f"{len(state.rigid_bodies)}, where each link of a robot counts"
        )
    for body in others[: len(state.rigid_bodies)]:
        if body.joint_count:
            raise StateError(
                f"body {body.id} has joints and was loaded with maximal coordinates; PyBullet saves each of "
                "its links as a body without joints, from which no joint can be restored"
            )
    yield from zip(reduced, state.multi_bodies, strict=True)
    yield from zip(others, state.rigid_bodies, strict=False)


def _rows(body: BodyCore, saved: MultiBodyState | RigidBodyState) -> Iterator[tuple[_Rows, _Rows]]:
    yield (
        (body.first_position, (*saved.position, *saved.orientation)),
        (body.first_velocity, (*saved.angular, *saved.linear)),
    )
    links = saved.links if isinstance(saved, MultiBodyState) else ()
    if len(links) != body.joint_count:
        raise StateError(
            f"body {body.id} has {body.joint_count} joints; it had {len(links)} when PyBullet saved it"
        )
    for joint, link in enumerate(links):
        ours, theirs = body.position_count[joint], len(link.position)
        if not ours or not theirs:
            # As in PyBullet, a joint that is fixed in one of both keeps its state.
            continue
        if ours != theirs or body.velocity_count[joint] != len(link.velocity):
            raise StateError(
                f"joint {joint} of body {body.id} has {ours} coordinates; PyBullet saved {theirs}"
            )
        yield (body.position_index[joint], link.position), (body.velocity_index[joint], link.velocity)


@gated("call_lock")
def _put(world: WorldCore, rows: list[tuple[_Rows, _Rows]], update_poses: bool) -> None:
    with uninterrupted:
        change = Change()
        positions, velocities = world.position, world.velocity
        for (first_position, position), (first_velocity, velocity) in rows:
            change.write(positions[first_position : first_position + len(position)], position)
            change.write(velocities[first_velocity : first_velocity + len(velocity)], velocity)
        world.contact_arrays.drop_contacts(change)
        if update_poses:
            world.note_link_poses(change)
        change.commit()
