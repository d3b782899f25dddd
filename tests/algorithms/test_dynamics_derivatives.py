"""Derivatives of inverse and forward dynamics against central differences of these."""

from __future__ import annotations

import numpy as np
import pytest
from tests.algorithms.moving_robots import ROBOTS, Motion, Vector, by_position, by_vector, is_close, motion_of

from carom import World, algorithms


@pytest.fixture(scope="module", params=ROBOTS)
def motion(request: pytest.FixtureRequest) -> Motion:
    return motion_of(request.param)


def forces(motion: Motion, q: Vector, v: Vector, a: Vector) -> Vector:
    """Forces in the order of the velocities."""
    found = algorithms.inverse_dynamics(motion.body, q, v, a)
    return found if motion.body.fixed_base else np.concatenate([found[3:6], found[:3], found[6:]])


def test_inverse_dynamics_by_positions(motion: Motion):
    found = algorithms.inverse_dynamics_derivatives(motion.body, motion.q, motion.v, motion.a)
    assert is_close(found.dtau_dq, by_position(motion, lambda q: forces(motion, q, motion.v, motion.a)))


def test_inverse_dynamics_by_velocities(motion: Motion):
    found = algorithms.inverse_dynamics_derivatives(motion.body, motion.q, motion.v, motion.a)
    expected = by_vector(len(motion.v), lambda v: forces(motion, motion.q, motion.v + v, motion.a))
    assert is_close(found.dtau_dv, expected)


def test_inverse_dynamics_by_accelerations_is_the_mass_matrix(motion: Motion):
    found = algorithms.inverse_dynamics_derivatives(motion.body, motion.q, motion.v, motion.a).dtau_da
    joints = motion.q if motion.body.fixed_base else motion.q[7:]
    assert is_close(found, algorithms.mass_matrix(motion.body, joints), 1e-13)
    assert (found == found.T).all()


def test_forward_dynamics_inverts_inverse_dynamics(motion: Motion):
    found = algorithms.forward_dynamics(motion.body, motion.q, motion.v, motion.tau)
    assert is_close(forces(motion, motion.q, motion.v, found), motion.tau, 1e-11)
    whole = algorithms.forward_dynamics_derivatives(motion.body, motion.q, motion.v, motion.tau)
    np.testing.assert_array_equal(whole.accelerations, found)


def test_forward_dynamics_by_positions(motion: Motion):
    body, v, tau = motion.body, motion.v, motion.tau
    found = algorithms.forward_dynamics_derivatives(body, motion.q, v, tau)
    assert is_close(found.da_dq, by_position(motion, lambda q: algorithms.forward_dynamics(body, q, v, tau)))


def test_forward_dynamics_by_velocities_and_forces(motion: Motion):
    body, q, v, tau = motion.body, motion.q, motion.v, motion.tau
    found = algorithms.forward_dynamics_derivatives(body, q, v, tau)
    dofs = len(v)
    by_velocity = by_vector(dofs, lambda change: algorithms.forward_dynamics(body, q, v + change, tau))
    assert is_close(found.da_dv, by_velocity)
    by_force = by_vector(dofs, lambda change: algorithms.forward_dynamics(body, q, v, tau + change))
    assert is_close(found.da_dtau, by_force, 1e-5)
    matrix = algorithms.inverse_dynamics_derivatives(body, q, v, motion.a).dtau_da
    assert is_close(found.da_dtau @ matrix, np.eye(dofs), 1e-9)


def test_forward_dynamics_is_what_a_step_does():
    """One explicit step of a falling free tree, whose velocities change by the accelerations."""
    from tests.physics.robots import coordinates, let_go, put_in_motion, random_tree

    world = World(time_step=1e-3)
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(random_tree(5, 6, fixed_base=True))
    let_go(body)
    put_in_motion(body, np.random.default_rng(3), speed=0.5)
    q, v = (values.copy() for values in coordinates(body))
    expected = algorithms.forward_dynamics(body, q[7:], v[6:], np.zeros(len(v) - 6))
    world.step()
    assert is_close((coordinates(body)[1] - v)[6:] / 1e-3, expected, 1e-9)


def test_answers_do_not_depend_on_earlier_questions(motion: Motion):
    body, q, v, a = motion.body, motion.q, motion.v, motion.a
    before = algorithms.forward_dynamics_derivatives(body, q, v, a)
    kept = [part.copy() for part in before]
    algorithms.forward_dynamics_derivatives(body, q, 2.0 * v, -a)
    again = algorithms.forward_dynamics_derivatives(body, q, v, a)
    for first, held, second in zip(before, kept, again, strict=True):
        np.testing.assert_array_equal(first, held)
        np.testing.assert_array_equal(second, held)


def test_masses_gravity_and_armature_changed_later_count():
    motion = motion_of("panda")
    body, q, v, a = motion.body, motion.q, motion.v, motion.a
    before = algorithms.inverse_dynamics_derivatives(body, q, v, a)
    body.change_dynamics(0, joint_armature=3.0)
    after = algorithms.inverse_dynamics_derivatives(body, q, v, a)
    assert after.dtau_da[0, 0] - before.dtau_da[0, 0] == pytest.approx(3.0 - 0.02)
    body.change_dynamics(6, mass=9.0)
    assert not is_close(algorithms.inverse_dynamics_derivatives(body, q, v, a).dtau_dq, after.dtau_dq)
    body.world.gravity = (0.0, 0.0, 0.0)
    at_rest = algorithms.inverse_dynamics_derivatives(body, q, 0.0 * v, 0.0 * a)
    assert (at_rest.dtau_dq == 0.0).all()


@pytest.mark.parametrize("which", range(3))
def test_bad_numbers_are_refused(which: int):
    motion = motion_of("free tree")
    good = [motion.q, motion.v, motion.a]
    for bad in (good[which][:-1], np.full(len(good[which]), np.nan)):
        arguments = [*good[:which], bad, *good[which + 1 :]]
        with pytest.raises(ValueError, match="must"):
            algorithms.inverse_dynamics_derivatives(motion.body, *arguments)
    huge = [motion.q, 1e200 * motion.v, motion.a]
    with pytest.raises(ValueError, match="finite"):
        algorithms.inverse_dynamics_derivatives(motion.body, *huge)
    flat = motion.q.copy()
    flat[3:7] = 0.0
    with pytest.raises(ValueError, match="quaternion"):
        algorithms.inverse_dynamics_derivatives(motion.body, flat, motion.v, motion.a)


def test_a_body_that_cannot_move_has_empty_answers():
    from carom.model.body_spec import BodySpec, LinkSpec

    body = World().load(BodySpec("stone", LinkSpec("base", mass=1.0), fixed_base=True))
    assert algorithms.inverse_dynamics_derivatives(body, [], [], []).dtau_dq.shape == (0, 0)
    assert algorithms.forward_dynamics(body, [], [], []).shape == (0,)
    assert algorithms.jacobian_center_of_mass(body, []).shape == (3, 0)
