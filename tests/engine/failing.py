"""A scene in which every kind of result is there, and a body whose step cannot end well."""

from __future__ import annotations

import math

import numpy as np
from tests.physics.contact_scenes import add_ball, add_box, add_floor, earth
from tests.physics.robots import pendulum, put_in_motion

from carom import Body, World, Worlds
from carom.description import Pose
from carom.layouts.codes import UserConstraintKind
from carom.layouts.flags import ActivationChange
from carom.model.body_spec import BASE

# Applied forces are dropped when a step fails. Rows beyond those in use have any values.
_DROPPED = ("link_wrench", "dof_torque")


def full_scene(substeps: int = 0) -> tuple[World, Body]:
    """A world with motors, a sensor, contacts, sleeping bodies and user constraints, and its last body."""
    world = earth(substeps=substeps)
    add_floor(world)
    arm = world.load(pendulum(3), (0.0, 3.0, 2.0))
    put_in_motion(arm, np.random.default_rng(1))
    arm.joints[1].enable_sensor()
    for height in (0.1, 0.31):
        add_box(world, (0.0, 0.0, height)).change_dynamics(
            BASE, activation_state=ActivationChange.ENABLE_SLEEPING
        )
    tied, hanging = add_ball(world, (1.0, 0.0, 0.1)), add_ball(world, (2.0, 0.0, 1.0))
    world.constrain_links(
        UserConstraintKind.POINT_TO_POINT, hanging, BASE, None, BASE, child_frame=Pose((2.0, 0.0, 1.1))
    )
    world.constrain_links(UserConstraintKind.FIXED, tied, BASE, None, BASE, child_frame=Pose((1.0, 0.0, 0.2)))
    last = add_ball(world, (5.0, 0.0, 0.5))
    world.step(30)
    return world, last


def everything(world: World) -> dict[str, np.ndarray]:
    """All that a failed step must leave alone, by name."""
    snapshot = world.snapshot()
    arrays = snapshot.state | snapshot.contacts | {"user_impulses": snapshot.user_impulses}
    return {name: array for name, array in arrays.items() if name not in _DROPPED}


def spoil(worlds: Worlds, body: Body) -> None:
    """Apply a force to a body that lets the next step of world 1, and of no other, fail."""
    worlds._engine.arrays.state.numpy["link_wrench"][1, body.first_link] = math.nan
