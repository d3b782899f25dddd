"""What the joints and the links of a body in many worlds have in common: its rows, and writing to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom.closed import Closed
from carom.engine.engine import Engine
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.scene.body import Body
from carom.world.world import World
from carom.worlds.chosen import Chosen, choose
from carom.worlds.poses import PoseFinder


class Batch(Closed):
    """Base class of `BodyBatch`: where the rows of a body are, by which names, and how to write to them."""

    def __init__(self, body: Body, scene: World, engine: Engine, threads: int) -> None:
        self._body = body
        self._scene = scene
        self._engine = engine
        self._threads = threads
        self._state = engine.arrays.state.numpy
        self._take = engine.take
        self._count = engine.arrays.world_count
        self._poses = PoseFinder(engine, body.rows.tree)
        self.rows = body.rows
        self.name: str = body.name
        self.joint_names: list[str] = [link.joint_name for link in body.spec.links]
        self.link_names: list[str] = [link.name for link in body.spec.links]
        self._base_name = body.spec.base.name
        self._dofs = _following(body.first_velocity + BASE_VELOCITIES, sum(body.velocity_count))
        self._coordinates = _following(body.first_position + BASE_POSITIONS, sum(body.position_count))
        self._links = _following(body.first_link + 1, body.joint_count)
        self._nodes = _following(body.rows.first["node"], body.rows.count["node"])
        self._actuators = _following(body.rows.first["actuator"], body.rows.count["actuator"])
        self._close()

    def link_rows(self, link: int | str | None) -> np.ndarray:
        """Rows of a link in the arrays of the engine; None stands for the base and all links."""
        first = self._body.first_link
        if link is None:
            return np.arange(first, self._links.stop)
        return np.array([first + 1 + self.link_index(link)])

    def link_index(self, link: int | str) -> int:
        """The index of a link by index (-1 is the base) or name.

        Raises:
            IndexError, KeyError: There is no such link.
        """
        if link in (-1, self._base_name):
            return -1
        return choose("link", self.link_names, link)

    def _chosen(self, where: ArrayLike | None = None) -> Chosen:
        return Chosen(self._take(where), self._count)

    @contextmanager
    def _rows_of_dofs(self, worlds: Chosen, *fields: str) -> Iterator[list[Any]]:
        """The rows of the joints in fields of the state, in some worlds, to write to.

        Whatever is written becomes the state at the end, unless there is an error.
        """
        place = worlds.rows, self._dofs
        parts = [self._state[field][place].copy() for field in fields]
        yield parts
        assign(*((self._state[field], place, part) for field, part in zip(fields, parts, strict=True)))


def assign(*writes: tuple[Any, Any, Any]) -> None:
    """Write to arrays: arrays, indices and values. Ctrl-C in a section comes before all or after all."""
    to_the_end(lambda: [array.__setitem__(place, values) for array, place, values in writes])


def to_the_end(write: Callable[[], object]) -> None:
    """Do what can be repeated, in a section: Ctrl-C comes before or after it."""
    try:
        write()
    except BaseException:
        write()
        raise


def _following(first: int, count: int) -> slice:
    return slice(first, first + count)
