"""The joint-space inertia against inverse dynamics, kinetic energy and closed forms."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.robots import (
    coordinates,
    free_body,
    joint_coordinates,
    let_go,
    pendulum,
    put_in_motion,
    random_tree,
)

from carom import World
from carom.algorithms import inverse_dynamics, mass_matrix
from carom.model.body_spec import BASE


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
@pytest.mark.parametrize("seed", range(3))
def test_columns_are_the_forces_of_unit_accelerations(seed, fixed_base):
    world = World()
    world.load(random_tree(100, 4, fixed_base=True))
    body = world.load(random_tree(seed, 4 + 3 * seed, fixed_base=fixed_base))
    put_in_motion(body, np.random.default_rng(seed))
    joints, rates = joint_coordinates(body)
    matrix = mass_matrix(body, joints)
    base = [] if fixed_base else [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    size = len(rates) if fixed_base else 6 + len(rates)
    assert matrix.shape == (size, size)
    for column, unit in enumerate(np.eye(size)):
        force = inverse_dynamics(body, [*base, *joints], np.zeros(size), unit)
        if not fixed_base:
            # Inverse dynamics gives the force on the base before the moment; rates are the other way.
            force[:6] = np.roll(force[:6], 3)
        assert_allclose(matrix[:, column], force, rtol=0, atol=1e-12)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_it_is_symmetric_and_positive_definite(fixed_base):
    body = World().load(random_tree(9, 25, fixed_base=fixed_base))
    put_in_motion(body, np.random.default_rng(9))
    matrix = mass_matrix(body, joint_coordinates(body)[0])
    np.testing.assert_array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_its_inverse_is_the_response_of_a_step():
    world = World(time_step=1.0)
    body = world.load(random_tree(12, 9, fixed_base=True))
    let_go(body)
    put_in_motion(body, np.random.default_rng(12), speed=0.0)
    joints, rates = joint_coordinates(body)
    matrix = mass_matrix(body, joints)
    torque = np.random.default_rng(1).normal(size=len(rates))
    world.joint_torque[body.first_velocity + 6 :][: len(torque)] = torque
    world.step()
    assert_allclose(matrix @ rates, torque, rtol=0, atol=1e-11)


def test_a_double_pendulum():
    body = World().load(pendulum(2))
    m, length, bend = 2.0, 1.0, 0.7
    own = m * length**2 / 12.0
    elbow = own + m * length**2 / 4.0
    row = elbow + m * length * (length / 2.0) * math.cos(bend)
    shoulder = elbow + own + m * length**2 / 4.0 + m * length**2 + m * length**2 * math.cos(bend)
    expected = [[shoulder, row], [row, elbow]]
    assert_allclose(mass_matrix(body, [0.3, bend]), expected, rtol=1e-14)


def test_a_body_without_joints():
    body = World().load(free_body(mass=2.5, inertia=(0.1, 0.2, 0.3)))
    assert_allclose(mass_matrix(body, []), np.diag([0.1, 0.2, 0.3, 2.5, 2.5, 2.5]), rtol=1e-15)


def test_it_follows_changes_of_mass_and_of_the_base():
    body = World().load(pendulum())
    body.change_dynamics(0, mass=4.0, inertia=(1.0, 1.5, 2.0))
    assert_allclose(mass_matrix(body, [0.0]), [[1.5 + 4.0 * 0.25]], rtol=1e-15)
    body.change_dynamics(BASE, mass=3.0, inertia=(1.0, 1.0, 1.0))
    matrix = mass_matrix(body, [0.0])
    assert matrix.shape == (7, 7)
    assert_allclose(np.diag(matrix)[3:6], 7.0, rtol=1e-15)
    assert len(coordinates(body)[1]) == 7
