"""Same calls, same bits."""

import numpy as np
from tests.physics.robots import coordinates, put_in_motion, random_tree

from carom import World
from carom.layouts.codes import MOTOR_KP, MOTOR_POSITION, MOTOR_VELOCITY


def busy_world() -> World:
    """Several moving, driven bodies under gravity."""
    world = World(contact="bullet")
    world.gravity = (0.0, 0.1, -9.81)
    for seed, fixed_base in ((0, True), (1, False), (2, True)):
        body = world.load(random_tree(seed, 8, fixed_base=fixed_base))
        put_in_motion(body, np.random.default_rng(seed), speed=0.3)
    rng = np.random.default_rng(3)
    count = world.arrays.used["dof"]
    world.motor[:count, MOTOR_VELOCITY] = rng.normal(size=count)
    world.motor[:count, MOTOR_POSITION] = 0.1 * rng.normal(size=count)
    world.motor[:count, MOTOR_KP] = 0.1
    return world


def state(world: World) -> np.ndarray:
    return np.concatenate([np.concatenate(coordinates(body)) for body in world.bodies.values()])


def test_two_runs_are_equal_bit_for_bit():
    runs = []
    for _ in range(2):
        world = busy_world()
        world.step(100)
        runs.append(state(world))
    assert np.isfinite(runs[0]).all()
    np.testing.assert_array_equal(runs[0], runs[1])


def test_steps_one_by_one_and_all_at_once_are_equal():
    together, apart = busy_world(), busy_world()
    together.step(30)
    for _ in range(30):
        apart.step()
    np.testing.assert_array_equal(state(together), state(apart))
    assert together.time == apart.time


def test_other_worlds_do_not_matter():
    alone = busy_world()
    alone.step(30)
    others = [busy_world() for _ in range(5)]
    among = busy_world()
    for n in range(30):
        others[n % 5].step()
        among.step()
    np.testing.assert_array_equal(state(among), state(alone))


def test_queries_between_steps_do_not_matter():
    from carom.algorithms import inverse_dynamics, jacobian, mass_matrix

    quiet, asked = busy_world(), busy_world()
    for _ in range(10):
        quiet.step()
        asked.step()
        body = asked.bodies[0]
        q, v = coordinates(body)
        inverse_dynamics(body, q[7:], v[6:], np.zeros(len(v) - 6))
        mass_matrix(body, q[7:])
        jacobian(body, 3, (0.1, 0.2, 0.3), q[7:])
        body.update_link_poses()
        body.update_link_velocities()
        asked.analytics()
    np.testing.assert_array_equal(state(asked), state(quiet))


def test_a_state_written_back_goes_on_the_same_way():
    world = busy_world()
    world.step(20)
    saved = [tuple(values.copy() for values in coordinates(body)) for body in world.bodies.values()]
    world.step(20)
    expected = state(world)
    for body, values in zip(world.bodies.values(), saved, strict=True):
        for view, old in zip(coordinates(body), values, strict=True):
            view[:] = old
    world.step(20)
    np.testing.assert_array_equal(state(world), expected)
