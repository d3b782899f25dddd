"""Writing to the coordinates and velocities of a body, by one call in which nobody sees it half done."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, ClassVar

from carom.native.builtins import new_builtin
from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from carom.scene.handles import world_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

Numbers = Sequence[float] | None


class StateWriter:
    """What writes to the state of bodies.

    Attributes:
        write: Writes to a joint, or with None to the base, of a body. Its arguments are the body, its world
            and its number there, the joint, coordinates and velocities. These are lists or tuples with all
            numbers that there are, or None, which keeps them. Poses of links follow, and contacts of a base
            start cold.
    """

    write: ClassVar[Callable[[BodyCore, WorldCore, int, int | None, Numbers, Numbers], object]]


def write_state(
    body: BodyCore, _world: WorldCore, _id: int, joint: int | None, position: Numbers, velocity: Numbers
) -> None:
    """Write in Python, where there are no builtins; with them, if addresses for poses are not known yet.

    Raises:
        ValueError: The body is no longer in its world.
    """
    coordinates, rates = array("d", position or ()), array("d", velocity or ())
    with body.world.call_lock, uninterrupted:
        world, change = world_of(body), Change()
        world.prepare_poses()
        if coordinates:
            first = body.first_position if joint is None else body.position_index[joint]
            change.write_numbers(world.position_memory[first : first + len(coordinates)], coordinates)
        if rates:
            first = body.first_velocity if joint is None else body.velocity_index[joint]
            change.write_numbers(world.velocity_memory[first : first + len(rates)], rates)
        if coordinates or joint is not None:
            world.note_link_poses(change, body)
        if coordinates and joint is None:
            change.run_record(world.quick.cold_start, world.quick)
        change.commit()


def _find(
    body: BodyCore, world: WorldCore, number: int, joint: int | None, position: Numbers, velocity: Numbers
) -> None:
    """Write for the first time: the library has been loaded then, and may have a builtin that does it."""
    from carom.native.host import host

    native = host and new_builtin("write_state", host.symbols.carom_write_state, write_state)
    StateWriter.write = native or write_state
    StateWriter.write(body, world, number, joint, position, velocity)


StateWriter.write = _find
