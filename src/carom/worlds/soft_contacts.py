"""Contacts of soft bodies with shapes in each of many worlds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from carom.engine.engine import Engine
from carom.world.world import World
from carom.worlds.lone import copy_coordinates
from carom.worlds.parts.sizes import SizesOfWorlds

_ANY_BODY, _ANY_LINK = -1, -2


class Side(NamedTuple):
    """What contacts are asked for on one side.

    Attributes:
        body: Number of the body; negative for any.
        link: Its link, -1 for the base; less for any.
    """

    body: int
    link: int

    @classmethod
    def of(cls, body: int | None, link: int | None) -> Side:
        """A side from a body and a link that may each be None for any."""
        return cls(_ANY_BODY if body is None else body, _ANY_LINK if link is None else link)


class SoftTouches(NamedTuple):
    """Contacts of one world that have a soft body on one side.

    Attributes:
        links: Links of the first body, (n,).
        points: Points on the first body [m], (n, 3).
        distances: Distances [m], (n,).
        pushes: Normal forces [N], (n,).
        forces: Forces on the first body [N], (n, 3).
    """

    links: np.ndarray
    points: np.ndarray
    distances: np.ndarray
    pushes: np.ndarray
    forces: np.ndarray


def soft_touches(
    scene: World, engine: Engine, first: Side, second: Side
) -> Sequence[tuple[int, SoftTouches]]:
    """The worlds in which nodes of soft bodies touch shapes, and these contacts.

    The state of each world is copied to a scene, whose queries find the touches: steps do not keep them.
    """
    found = []
    with SizesOfWorlds(scene, engine) as sizes:
        for world in range(engine.arrays.world_count):
            copy_coordinates(engine, world, scene)
            sizes.take(world)
            pushes = engine.arrays.state.numpy["node_push"][world]
            scene.arrays.state.numpy["node_push"][0, : len(pushes)] = pushes
            count, columns = scene.queries().soft_contacts(*first, *second, scene.parameters.substep_time)
            if count:
                found.append((world, _touches(*(np.array(list(column)[:count]) for column in columns))))
    return found


def _touches(
    body_a: np.ndarray,
    body_b: np.ndarray,
    link_a: np.ndarray,
    link_b: np.ndarray,
    point_a: np.ndarray,
    point_b: np.ndarray,
    normal: np.ndarray,
    distance: np.ndarray,
    push: np.ndarray,
    first_force: np.ndarray,
    first_direction: np.ndarray,
    second_force: np.ndarray,
    second_direction: np.ndarray,
) -> SoftTouches:
    """From the columns of `carom.engine.queries.contact_search.ContactColumns`."""
    forces = push[:, None] * normal + first_force[:, None] * first_direction
    return SoftTouches(link_a, point_a, distance, push, forces + second_force[:, None] * second_direction)
