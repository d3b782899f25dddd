"""Coriolis matrices, momenta, energies, motions of links and regressors: identities, central differences."""

from __future__ import annotations

import numpy as np
import pytest
from tests.algorithms.moving_robots import (
    ROBOTS,
    STEP,
    Motion,
    Vector,
    by_position,
    by_vector,
    is_close,
    load,
    motion_of,
    moved,
    rotation,
)
from tests.algorithms.test_dynamics_derivatives import forces

from carom import World, algorithms
from carom.algorithms import CentroidalDynamics, LinkMotions
from carom.algorithms.regressor import joint_torque_regressors


@pytest.fixture(scope="module", params=ROBOTS)
def motion(request: pytest.FixtureRequest) -> Motion:
    return motion_of(request.param)


def as_vector(v: Vector, motion: Motion) -> Vector:
    """Accelerations for which the components of the velocities are constant."""
    result = np.zeros(len(v))
    if motion.free:
        result[3:6] = np.cross(v[:3], v[3:6])
    return result


def mass_matrix(motion: Motion, q: Vector) -> Vector:
    return algorithms.mass_matrix(motion.body, q[7:] if motion.free else q)


def centroidal(motion: Motion, q: Vector, v: Vector, a: Vector) -> CentroidalDynamics:
    return algorithms.centroidal_dynamics(motion.body, q, v, a)


def velocity_and_acceleration(motions: LinkMotions) -> tuple[Vector, Vector]:
    """Of the one link, linear before angular."""
    parts = [part[0] for part in motions]
    return np.concatenate(parts[:2]), np.concatenate(parts[2:])


def test_the_coriolis_matrix_gives_the_bias_forces(motion: Motion):
    body, q, v = motion.body, motion.q, motion.v
    matrix = algorithms.compute_coriolis_matrix(body, q, v)
    gravity = algorithms.gravity_forces(body, q)
    expected = forces(motion, q, v, as_vector(v, motion))
    assert is_close(matrix @ v + gravity, expected, 1e-12)
    assert is_close(algorithms.bias_forces(body, q, v), expected, 1e-12)
    assert is_close(gravity, forces(motion, q, 0.0 * v, 0.0 * v), 1e-12)


def test_the_rate_of_the_mass_matrix_minus_twice_coriolis_is_skew(motion: Motion):
    rate = (
        mass_matrix(motion, moved(motion.body, motion.q, STEP * motion.v))
        - mass_matrix(motion, moved(motion.body, motion.q, -STEP * motion.v))
    ) / (2.0 * STEP)
    matrix = algorithms.compute_coriolis_matrix(motion.body, motion.q, motion.v)
    skew = rate - 2.0 * matrix
    assert np.abs(matrix).max() > 0.1
    assert is_close(skew, -skew.T, 1e-7)


def test_the_centre_of_mass_moves_by_its_jacobian(motion: Motion):
    body, q = motion.body, motion.q
    found = algorithms.jacobian_center_of_mass(body, q)
    assert is_close(found, by_position(motion, lambda q: algorithms.center_of_mass(body, q)), 1e-8)


def test_the_centre_of_mass_is_that_of_the_links_that_move(motion: Motion):
    body, q = motion.body, motion.q
    motion.body.update_link_poses()
    if motion.free:
        x, y, z, *turn = q[:7].tolist()
        body.set_inertial_pose((x, y, z), tuple(turn))
    joints = q[7:] if motion.free else q
    frames = algorithms.forward_kinematics(body, joints, [-1, *range(body.joint_count)])
    masses, centres = [], []
    for link, frame in zip(range(-1, body.joint_count), frames, strict=True):
        above, moves = link, motion.free > 0
        while above >= 0:
            moves = moves or body.velocity_count[above] > 0
            above = body.spec.links[above].parent
        masses.append(body.dynamics(link).mass if moves else 0.0)
        own = np.array(body.link_inertial_frame(link).position)
        centres.append(np.array(frame.position) + rotation(np.array(frame.orientation)) @ own)
    expected = np.array(masses) @ np.array(centres) / sum(masses)
    assert is_close(algorithms.center_of_mass(body, q), expected, 1e-12)
    found = algorithms.centroidal_dynamics(body, q)
    assert found.mass == pytest.approx(sum(masses), rel=1e-13)
    assert algorithms.potential_energy(body, q) == pytest.approx(
        -sum(masses) * np.array(body.world.gravity) @ expected, rel=1e-12
    )


def test_momentum_is_linear_in_velocities(motion: Motion):
    body, q, v = motion.body, motion.q, motion.v
    found = algorithms.centroidal_momentum(body, q, v)
    assert is_close(algorithms.compute_centroidal_map(body, q) @ v, found, 1e-12)
    mass = algorithms.centroidal_dynamics(body, q).mass
    assert is_close(mass * algorithms.jacobian_center_of_mass(body, q) @ v, found[:3], 1e-12)


def test_the_rate_of_momentum_is_its_derivative_in_time(motion: Motion):
    """Also against the forces on a free body: gravity, and those of inverse dynamics on the base."""
    q, v, a = motion.q, motion.v, motion.a
    change = a - as_vector(v, motion)

    def at(time: float) -> Vector:
        later = moved(motion.body, q, time * v + 0.5 * time**2 * change)
        return centroidal(motion, later, v + time * change, a).momentum

    found = centroidal(motion, q, v, a)
    assert is_close(found.momentum_rate, (at(STEP) - at(-STEP)) / (2.0 * STEP))
    if motion.free:
        tau = forces(motion, q, v, a)
        turn = rotation(q[3:7])
        force = turn @ tau[3:6]
        torque = turn @ tau[:3] - np.cross(found.center_of_mass - q[:3], force)
        gravity = found.mass * np.array(motion.body.world.gravity)
        assert is_close(found.momentum_rate, np.concatenate([force + gravity, torque]), 1e-11)


def test_derivatives_of_momentum_and_its_rate(motion: Motion):
    q, v, a = motion.q, motion.v, motion.a
    found = centroidal(motion, q, v, a)
    assert is_close(found.dh_dq, by_position(motion, lambda q: centroidal(motion, q, v, a).momentum))
    rates = by_position(motion, lambda q: centroidal(motion, q, v, a).momentum_rate)
    assert is_close(found.drate_dq, rates)
    dofs = len(v)
    rates = by_vector(dofs, lambda change: centroidal(motion, q, v + change, a).momentum_rate)
    assert is_close(found.drate_dv, rates)
    rates = by_vector(dofs, lambda change: centroidal(motion, q, v, a + change).momentum_rate)
    assert is_close(found.dh_dv, rates)


def test_kinetic_energy_is_that_of_the_mass_matrix(motion: Motion):
    q, v = motion.q, motion.v
    expected = 0.5 * v @ mass_matrix(motion, q) @ v
    assert algorithms.kinetic_energy(motion.body, q, v) == pytest.approx(expected, rel=1e-12)


def test_gravity_forces_are_derivatives_of_potential_energy(motion: Motion):
    body, q = motion.body, motion.q
    slope = by_position(motion, lambda q: np.array([algorithms.potential_energy(body, q)]))[0]
    assert is_close(algorithms.gravity_forces(body, q), slope)


@pytest.mark.parametrize("place", [-1, 0, 3, "last"])
def test_motions_of_links_and_their_derivatives(motion: Motion, place: int | str):
    body, q, v, a = motion.body, motion.q, motion.v, motion.a
    link = body.joint_count - 1 if isinstance(place, str) else place
    change, dofs = a - as_vector(v, motion), len(v)

    def at(q: Vector, v: Vector, a: Vector) -> tuple[Vector, Vector]:
        return velocity_and_acceleration(algorithms.link_motions(body, q, v, a, [link]))

    velocity, acceleration = at(q, v, a)
    found = algorithms.link_motion_derivatives(body, link, q, v, a)
    assert is_close(found.dv_dv @ v, velocity, 1e-12)
    later, earlier = (moved(body, q, t * v + 0.5 * t**2 * change) for t in (STEP, -STEP))
    rate = (at(later, v + STEP * change, a)[0] - at(earlier, v - STEP * change, a)[0]) / (2.0 * STEP)
    assert is_close(acceleration, rate)
    assert is_close(found.dv_dq, by_position(motion, lambda q: at(q, v, a)[0]))
    assert is_close(found.da_dq, by_position(motion, lambda q: at(q, v, a)[1]))
    assert is_close(found.da_dv, by_vector(dofs, lambda change: at(q, v + change, a)[1]))
    assert is_close(found.dv_dv, by_vector(dofs, lambda change: at(q, v, a + change)[1]))


def test_velocities_of_links_are_those_of_the_simulation():
    motion = motion_of("laikago")
    body, q, v = motion.body, motion.q, motion.v
    turn = rotation(q[3:7])
    x, y, z, *orientation = q[:7].tolist()
    body.set_inertial_pose((x, y, z), tuple(orientation))
    body.set_base_velocity(tuple((turn @ v[3:6]).tolist()), tuple((turn @ v[:3]).tolist()))
    at, dof = 7, 6
    for joint in range(body.joint_count):
        positions, rates = body.position_count[joint], body.velocity_count[joint]
        body.set_joint_state(joint, tuple(q[at : at + positions]), tuple(v[dof : dof + rates]))
        at, dof = at + positions, dof + rates
    found = algorithms.link_motions(body, q, v, 0.0 * v)
    frames = [
        (rotation(np.array(pose.orientation)), np.array(body.link_inertial_frame(link).position))
        for link, pose in enumerate(algorithms.forward_kinematics(body, q[7:]))
    ]
    for link in range(body.joint_count):
        own, (turn, offset) = body.links[link].velocity, frames[link]
        at_centre = np.cross(found.angular_velocities[link], turn @ offset)
        assert np.allclose(found.linear_velocities[link] + at_centre, own.linear, rtol=0, atol=1e-11)
        assert np.allclose(found.angular_velocities[link], own.angular, rtol=0, atol=1e-11)


def test_links_that_are_not_there_are_refused():
    motion = motion_of("panda")
    arguments = (motion.q, motion.v, motion.a)
    with pytest.raises(IndexError, match="no link 99"):
        algorithms.link_motions(motion.body, *arguments, [99])
    with pytest.raises(IndexError, match="no link -2"):
        algorithms.link_motion_derivatives(motion.body, -2, *arguments)


def test_the_regressor_times_the_parameters_are_the_forces(motion: Motion):
    body, q, v, a = motion.body, motion.q, motion.v, motion.a
    regressor = algorithms.joint_torque_regressor(body, q, v, a)
    parameters = algorithms.inertial_parameters(body).ravel()
    armature = np.concatenate(
        [
            np.zeros(motion.free),
            *(
                np.full(count, body.dynamics(link).joint_armature)
                for link, count in enumerate(body.velocity_count)
            ),
        ]
    )
    assert is_close(regressor @ parameters + armature * a, forces(motion, q, v, a), 1e-11)
    assert np.linalg.matrix_rank(regressor) == len(v)


def test_regressors_of_many_states_are_those_of_each():
    world = World()
    world.gravity = (0.4, -0.2, -9.81)
    load(world, "laikago")
    arm = load(world, "panda")
    q, v, a = np.random.default_rng(3).uniform(-1.0, 1.0, (3, 4, sum(arm.velocity_count)))
    many = joint_torque_regressors(arm, q, v, a)
    for found, *state in zip(many, q, v, a, strict=True):
        assert is_close(found, algorithms.joint_torque_regressor(arm, *state), 1e-12)


def test_accelerations_by_mass_and_inertia():
    motion = motion_of("humanoid")
    body, link, tau = motion.body, 4, motion.tau
    before = algorithms.inertial_parameters(body)
    mass, inertia = body.dynamics(link).mass, np.array(body.dynamics(link).inertia)
    found = algorithms.forward_dynamics_derivatives(body, motion.q, motion.v, tau)
    regressor = algorithms.joint_torque_regressor(body, motion.q, motion.v, found.accelerations)
    by_parameters = -found.da_dtau @ regressor

    def changed(factor: float) -> Vector:
        x, y, z = (factor * inertia).tolist()
        body.change_dynamics(link, mass=factor * mass, inertia=(x, y, z))
        return algorithms.forward_dynamics(body, motion.q, motion.v, tau)

    # A link that is heavier by a factor has all of its parameters times this factor.
    slope = (changed(1.0 + STEP) - changed(1.0 - STEP)) / (2.0 * STEP)
    assert np.abs(slope).max() > 0.1
    assert is_close(by_parameters[:, 10 * (1 + link) :][:, :10] @ before[1 + link], slope)


def test_the_regressor_is_the_derivative_by_mass_and_inertia():
    motion = motion_of("laikago")
    body, link = motion.body, 2
    regressor = algorithms.joint_torque_regressor(body, motion.q, motion.v, motion.a)
    before, forces_before = algorithms.inertial_parameters(body), forces(motion, motion.q, motion.v, motion.a)
    body.change_dynamics(link, mass=3.0 * body.dynamics(link).mass, inertia=(0.3, 0.4, 0.5))
    change = (algorithms.inertial_parameters(body) - before).ravel()
    assert np.flatnonzero(change).min() >= 10 * (1 + link)
    after = forces(motion, motion.q, motion.v, motion.a)
    assert is_close(regressor @ change, after - forces_before, 1e-11)
