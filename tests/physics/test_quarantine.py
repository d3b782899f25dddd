"""A state that is not finite never leaves the step it arose in."""

import math

import numpy as np
import pytest
from tests.physics.robots import coordinates, let_go, pendulum, put_in_motion, random_tree

from carom import Body, World
from carom.errors import SimulationError
from carom.model.body_spec import BASE


def world_of_two(substeps: int = 0) -> tuple[World, Body, Body]:
    world = World()
    world.parameters.substeps = substeps
    world.gravity = (0.0, 0.0, -9.81)
    arm, tree = world.load(pendulum(2)), world.load(random_tree(3, 4, fixed_base=False))
    for body in (arm, tree):
        put_in_motion(body, np.random.default_rng(body.id))
    world.step(5)
    return world, arm, tree


def spoil_rate(body: Body) -> None:
    coordinates(body)[1][7] = math.nan


def spoil_position(body: Body) -> None:
    coordinates(body)[0][7] = math.inf


def spoil_orientation(body: Body) -> None:
    coordinates(body)[0][4] = math.nan


def twist_without_end(body: Body) -> None:
    body.world.joint_torque[body.first_velocity + 7] = -math.inf


def push_without_end(body: Body) -> None:
    body.world.link_force[body.first_link + 1] = math.inf


def lose_mass(body: Body) -> None:
    body.change_dynamics(0, mass=math.nan)


SPOILERS = [spoil_rate, spoil_position, spoil_orientation, twist_without_end, push_without_end, lose_mass]


@pytest.mark.parametrize("substeps", [0, 3])
@pytest.mark.parametrize("at_fault", ["pendulum", "random3"])
@pytest.mark.parametrize("spoil", SPOILERS)
def test_the_body_is_named_and_nothing_moves(spoil, at_fault, substeps):
    world, *bodies = world_of_two(substeps)
    body = next(body for body in bodies if body.name == at_fault)
    spoil(body)
    position, velocity, time = world.position.copy(), world.velocity.copy(), world.time
    with pytest.raises(SimulationError, match=rf'body {body.id} \("{at_fault}"\)'):
        world.step(4)
    np.testing.assert_array_equal(world.position, position)
    np.testing.assert_array_equal(world.velocity, velocity)
    assert world.time == time
    assert not world.joint_torque.any()
    assert not world.link_force.any()


def test_the_world_goes_on_once_the_cause_is_gone():
    spoiled, arm, tree = world_of_two()
    spared = world_of_two()[0]
    push_without_end(arm)
    with pytest.raises(SimulationError):
        spoiled.step()
    spoiled.step(20)
    spared.step(20)
    for body in (arm, tree):
        for values, expected in zip(coordinates(body), coordinates(spared.bodies[body.id]), strict=True):
            np.testing.assert_array_equal(values, expected)


def runaway_rod() -> Body:
    """A rod whose rate grows with every step until it overflows."""
    body = World(time_step=1.0).load(pendulum())
    let_go(body)
    body.change_dynamics(BASE, max_joint_velocity=math.inf)
    body.change_dynamics(0, joint_damping=-1e30)
    coordinates(body)[1][6] = 1.0
    return body


def test_steps_before_the_fault_count():
    together, apart = runaway_rod(), runaway_rod()
    with pytest.raises(SimulationError):
        together.world.step(100)
    done = 0
    with pytest.raises(SimulationError):
        for _ in range(100):
            apart.world.step()
            done += 1
    assert done > 2
    assert together.world.time == apart.world.time == done
    for values, expected in zip(coordinates(together), coordinates(apart), strict=True):
        np.testing.assert_array_equal(values, expected)
    assert abs(coordinates(together)[1][6]) > 1e60


def test_a_removed_body_is_no_longer_at_fault():
    world, arm, _tree = world_of_two()
    spoil_rate(arm)
    with pytest.raises(SimulationError):
        world.step()
    world.remove(arm.id)
    world.step(10)
    assert np.isfinite(world.position).all()
