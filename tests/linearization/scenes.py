"""Worlds in motion for the tests of linearised steps."""

from __future__ import annotations

from typing import Any

import numpy as np

import pybullet_data
from carom import Body, World
from carom.layouts.codes import MOTOR_MAX_IMPULSE

ASSETS = pybullet_data.getDataPath()


def new_world(*, plane: bool = False) -> World:
    """A world whose sweeps converge, and which starts them from no impulses."""
    world = World(contact="bullet")
    world.gravity = (0.1, -0.2, -9.81)
    tighten(world)
    if plane:
        world.load_urdf(f"{ASSETS}/plane.urdf")
    return world


def tighten(world: World) -> None:
    """Let the sweeps of a world converge, from no impulses."""
    world.parameters.solver_iterations = 20000
    world.parameters.solver_residual_threshold = 1e-28
    world.parameters.contact_warm_starting = 0.0
    world.apply_parameters()


def set_velocity(body: Body, *velocity: float) -> None:
    """Set angular and linear velocity of a base."""
    first = body.first_velocity
    body.world.velocity[first : first + 6] = velocity


def excite(body: Body, seed: int = 0, share: float = 1.0) -> None:
    """Give joints and a free base random positions and velocities, joints within their limits."""
    rng = np.random.default_rng(seed)
    world = body.world
    for joint, link in zip(body.joints, body.spec.links, strict=True):
        q, count = body.position_index[joint.index], body.position_count[joint.index]
        if not count:
            continue
        if count == 4:
            turn = rng.normal(size=4)
            world.position[q : q + 4] = turn / np.linalg.norm(turn)
        elif link.lower < link.upper:
            room = 0.1 * (link.upper - link.lower)
            world.position[q] = np.clip(rng.uniform(-0.5, 0.5), link.lower + room, link.upper - room)
        else:
            world.position[q : q + count] = rng.uniform(-0.5, 0.5, count)
        dof = body.velocity_index[joint.index]
        own = slice(dof, dof + body.velocity_count[joint.index])
        world.velocity[own] = share * rng.uniform(-1.0, 1.0, own.stop - own.start)
    if not body.fixed_base:
        set_velocity(body, *(share * rng.uniform(-1.0, 1.0, 6)))


def motors_off(body: Body) -> None:
    """Switch all motors off."""
    first = body.first_velocity
    count = 6 + sum(body.velocity_count)
    body.world.arrays.state.numpy["dof_motor"][0, first : first + count, MOTOR_MAX_IMPULSE] = 0.0


def assert_exact(world: World, atol: float = 1e-6, **arguments: Any) -> Any:
    """Compare with central differences, relative to the greatest entry; returns the exact result."""
    before = world.position.copy(), world.velocity.copy(), world.time
    exact = world.linearize(method="exact", **arguments)
    near = world.linearize(method="differences", **arguments)
    for name in ("A", "B", "E"):
        found, wanted = getattr(exact, name), getattr(near, name)
        assert found.shape == wanted.shape
        bound = atol * max(1.0, np.abs(wanted).max(initial=0.0))
        assert np.abs(found - wanted).max(initial=0.0) < bound, name
    # The world is as it was.
    assert (world.position == before[0]).all() and (world.velocity == before[1]).all()
    assert world.time == before[2]
    return exact


def statuses(step: Any) -> dict[str, list[str]]:
    """The status of all rows by what they are of."""
    found: dict[str, list[str]] = {}
    for name, status in step.rows:
        found.setdefault(name, []).append(status)
    return found
