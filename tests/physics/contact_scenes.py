"""Bodies of one simple shape, and what their contacts say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from tests.physics.robots import box_inertia

from carom import Body, World
from carom.description import Pose
from carom.description.geometry import Box, Geometry, Sphere
from carom.description.link import Collision, ContactParameters
from carom.model.body_spec import BASE, BodySpec, LinkSpec

HALF = 0.1
"""Half the edge of boxes and the radius of balls [m]."""
GRAVITY = 9.81
WEIGHT = GRAVITY
"""Of the bodies, whose mass is 1 kg [N]."""


def earth(**parameters: float) -> World:
    """A world with gravity and nothing else."""
    world = World(contact="bullet")
    for name, value in parameters.items():
        setattr(world.parameters, name, value)
    world.gravity = (0.0, 0.0, -GRAVITY)
    return world


def _add(
    world: World,
    shape: Geometry,
    inertia: tuple[float, float, float],
    position: Sequence[float],
    **surface: float,
) -> Body:
    link = LinkSpec(
        name="base",
        mass=1.0,
        inertia=inertia,
        collisions=(Collision(shape),),
        contact=_contact(surface),
    )
    body = world.load(BodySpec(type(shape).__name__, link), position)
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    return body


def add_box(world: World, position: Sequence[float], **surface: float) -> Body:
    """A box of 1 kg that may move."""
    edge = 2.0 * HALF
    return _add(world, Box((HALF, HALF, HALF)), box_inertia(1.0, (edge, edge, edge)), position, **surface)


def add_ball(world: World, position: Sequence[float], **surface: float) -> Body:
    """A ball of 1 kg that may move."""
    moment = 0.4 * HALF**2
    return _add(world, Sphere(HALF), (moment, moment, moment), position, **surface)


def add_floor(world: World, **surface: float) -> Body:
    """A fixed block whose upper side is at height 0."""
    block = Collision(Box((20.0, 20.0, 1.0)))
    link = LinkSpec(name="floor", collisions=(block,), contact=_contact(surface))
    return world.load(BodySpec("floor", link, fixed_base=True), (0.0, 0.0, -1.0))


def add_plate_on_a_stand(world: World) -> Body:
    """A plate of 1 kg fixed to the world, whose joint can measure; its upper side is at height 1."""
    block = Collision(Box((3.0 * HALF, 3.0 * HALF, HALF)))
    plate = LinkSpec(
        name="plate",
        mass=1.0,
        inertia=(0.01, 0.01, 0.01),
        joint_frame=Pose((0.0, 0.0, 1.0 - HALF)),
        collisions=(block,),
    )
    return world.load(BodySpec("stand", LinkSpec("base"), [plate], fixed_base=True))


def _contact(surface: dict[str, float]) -> ContactParameters:
    return replace(ContactParameters(), **surface)


def place(body: Body) -> np.ndarray:
    """Position of the base, shape (3,)."""
    return body.world.position[body.first_position : body.first_position + 3].copy()


def motion(body: Body) -> np.ndarray:
    """Velocity and spin of the base, in the engine's order, shape (6,)."""
    return body.world.velocity[body.first_velocity : body.first_velocity + 6].copy()


def impulses(world: World) -> np.ndarray:
    """Normal and two friction impulses of each contact [N s], shape (contacts, 3)."""
    return world.contact_arrays.contacts.numpy["contact_impulse"][
        0, : world.contact_arrays.contact_count
    ].copy()
