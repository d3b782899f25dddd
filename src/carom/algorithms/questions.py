"""Questions of functions of this package: one native call if the arguments are plain, checks otherwise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.sweeps import Sweeps, Views, sweeps_of
from carom.layouts.codes import BASE_POSITIONS
from carom.native.gates import gated
from carom.native.kernel_builtins import Asker
from carom.native.kernels import Kernel

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray

Question = Callable[..., Any]
"""What `sweep_question` makes."""

_POSE = int(BASE_POSITIONS)
_ARGUMENTS = "positions", "velocities", "changes"


def held_pose(body: BodyCore) -> memoryview[float]:
    """Position and quaternion of the base's inertial frame, as memory of the world."""
    first = body.first_position
    return body.world.position_memory[first : first + _POSE]


def asker_of(body: BodyCore, make: Callable[[BodyCore], Asker]) -> Asker:
    """What `make` makes for a body as it is now; cached as `sweeps_of`."""
    ask = body.derived.get(make)
    if ask is None:
        with body.world.call_lock:
            ask = body.derived[make] = make(body)
    return ask


def sweep_question(
    kernel: Kernel, size: Callable[[Sweeps], int], views: Views, number: Callable[[Sweeps], int] = lambda _: 0
) -> Question:
    """A function that asks a kernel that takes a `SweepTable` about the motion of a body.

    Args:
        kernel: The kernel.
        size: Length of its answer.
        views: What to return of an answer, of which copies are made: one without axes becomes a number.
        number: The kernel's number between its structs and `first_world`.

    Returns:
        The function. It takes a body, positions, and velocities and changes, which may be left out, all as
            `Sweeps.ask`, which has the errors. It returns new arrays, or numbers: one, or a tuple.
    """

    def made(body: BodyCore) -> Asker:
        sweeps = sweeps_of(body)
        return sweeps.asker(kernel, size(sweeps), number(sweeps), views=views)

    @gated("world.call_lock")
    def checked(body: BodyCore, *asked: Any) -> Any:
        sweeps = sweeps_of(body)
        names = dict(zip(_ARGUMENTS, asked, strict=True))
        answer = sweeps.ask(kernel, size(sweeps), number(sweeps), **names)
        found = [view.copy() if view.ndim else view.item() for view in views(answer, sweeps)]
        return tuple(found) if len(found) > 1 else found[0]

    def ask(
        body: BodyCore,
        positions: Numbers,
        velocities: Numbers | None = None,
        changes: Numbers | None = None,
    ) -> Any:
        asker = body.derived.get(made) or asker_of(body, made)
        held = held_pose(body) if body.fixed_base else None
        answer = asker(body.world.parameters.gravity, held, positions, velocities, changes)
        return checked(body, positions, velocities, changes) if answer is None else answer

    return ask
