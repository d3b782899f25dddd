"""Worlds with rigid contacts that the tests of this folder share."""

from __future__ import annotations

import numpy as np

from carom import World
from carom.scene.body import Body

STEP = 1.0 / 240.0
GRAVITY = 9.81


def rigid_world(slope: float = 0.0, heading: float = 0.0) -> World:
    """A world with rigid contacts, with gravity as on a slope that falls along a heading [rad]."""
    down = GRAVITY * np.array(
        [np.sin(slope) * np.cos(heading), np.sin(slope) * np.sin(heading), -np.cos(slope)]
    )
    return World(gravity=down.tolist(), contact="rigid")


def tower(world: World, count: int, offset: float = 0.005, masses: list[float] | None = None) -> list[Body]:
    """Boxes of 20 cm on each other on a plane, each up to `offset` off centre along both axes [m]."""
    world.add_plane()
    offsets = np.random.default_rng(0).uniform(-offset, offset, (count, 2))
    return [
        world.add_box(
            (0.1, 0.1, 0.1),
            (*offsets[i], 0.1 + 0.2 * i),
            mass=masses[i] if masses else 1.0,
            name=f"box{i}",
        )
        for i in range(count)
    ]


def centres(bodies: list[Body]) -> np.ndarray:
    """Positions of the bases of bodies, (n, 3) [m]."""
    return np.array([body.pose.position for body in bodies])


def speed(body: Body) -> np.ndarray:
    """Linear velocity of the base of a body [m/s]."""
    return np.array(body.links[-1].velocity.linear)
