"""Derivatives, momenta and motions of links in all worlds are, bit for bit, those of each world alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.worlds.test_algorithms import COUNT, ROBOTS, lone, own_state, varied

from carom import World, Worlds, algorithms
from carom.scene.body import Body
from carom.worlds.body import BodyBatch

State = tuple[np.ndarray, np.ndarray, np.ndarray]
Asked = Callable[[BodyBatch, State], Any]
Alone = Callable[[Body, State], Any]
LINK = 2
# What a body of many worlds is asked, and the same of a body of a lone world: positions, rates, changes.
QUESTIONS: dict[str, tuple[Asked, Alone]] = {
    "inverse dynamics": (
        lambda batch, s: batch.algorithms.inverse_dynamics_derivatives(s[2], s[0], s[1]),
        lambda body, s: algorithms.inverse_dynamics_derivatives(body, *s),
    ),
    "forward dynamics": (
        lambda batch, s: [batch.forward_dynamics(s[2], s[0], s[1])],
        lambda body, s: [algorithms.forward_dynamics(body, *s)],
    ),
    "derivatives of forward dynamics": (
        lambda batch, s: batch.algorithms.forward_dynamics_derivatives(s[2], s[0], s[1]),
        lambda body, s: algorithms.forward_dynamics_derivatives(body, *s),
    ),
    "bias": (
        lambda batch, s: [
            batch.algorithms.coriolis_matrices(s[0], s[1]),
            batch.algorithms.gravity_forces(s[0]),
            batch.algorithms.bias_forces(s[0], s[1]),
        ],
        lambda body, s: [
            algorithms.compute_coriolis_matrix(body, s[0], s[1]),
            algorithms.gravity_forces(body, s[0]),
            algorithms.bias_forces(body, s[0], s[1]),
        ],
    ),
    "momentum": (
        lambda batch, s: batch.algorithms.centroidal_dynamics(s[2], s[0], s[1]),
        lambda body, s: algorithms.centroidal_dynamics(body, *s),
    ),
    "centre of mass": (
        lambda batch, s: [
            batch.algorithms.center_of_mass(s[0]),
            batch.algorithms.jacobian_center_of_mass(s[0]),
        ],
        lambda body, s: [
            algorithms.center_of_mass(body, s[0]),
            algorithms.jacobian_center_of_mass(body, s[0]),
        ],
    ),
    "links": (
        lambda batch, s: batch.algorithms.link_motions(s[2], s[0], s[1], [-1, LINK]),
        lambda body, s: algorithms.link_motions(body, *s, [-1, LINK]),
    ),
    "derivatives of a link": (
        lambda batch, s: batch.algorithms.link_motion_derivatives(LINK, s[2], s[0], s[1]),
        lambda body, s: algorithms.link_motion_derivatives(body, LINK, *s),
    ),
    "regressor": (
        lambda batch, s: [batch.algorithms.joint_torque_regressors(s[2], s[0], s[1])],
        lambda body, s: [algorithms.joint_torque_regressor(body, *s)],
    ),
}


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("question", QUESTIONS)
def test_answers_are_those_of_each_world_alone(robot: str, question: str):
    worlds, batch = varied(robot)
    asked, alone = QUESTIONS[question]
    bodies = [lone(worlds, number) for number in range(COUNT)]
    states = [own_state(body) for body in bodies]
    changes = np.random.default_rng(2).normal(size=(COUNT, len(states[0][1])))
    together = asked(batch, (np.array([q for q, _ in states]), np.array([v for _, v in states]), changes))
    for number, body in enumerate(bodies):
        own = alone(body, (*states[number], changes[number]))
        assert len(own) == len(together)
        for found, expected in zip(together, own, strict=True):
            np.testing.assert_array_equal(found[number], expected)
    for found in together:
        assert not (found[0] == found[1]).all()


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_present_state_is_the_default(robot: str):
    worlds, batch = varied(robot)
    states = [own_state(lone(worlds, number)) for number in range(COUNT)]
    positions, velocities = (np.array([state[part] for state in states]) for part in range(2))
    given = batch.algorithms.inverse_dynamics_derivatives(0.0, positions, velocities)
    for found, expected in zip(batch.algorithms.inverse_dynamics_derivatives(), given, strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(
        batch.algorithms.bias_forces(), batch.algorithms.bias_forces(positions, velocities), atol=1e-8
    )


def test_some_worlds_can_be_asked():
    _, batch = varied("humanoid")
    everything = batch.algorithms.forward_dynamics_derivatives(1.0)
    some = batch.algorithms.forward_dynamics_derivatives(1.0, where=[7, 3])
    for found, expected in zip(some, everything, strict=True):
        np.testing.assert_array_equal(found, expected[[7, 3]])


@pytest.mark.parametrize("threads", [1, 3])
def test_threads_change_nothing(threads: int):
    expected = varied("laikago")[1].algorithms.centroidal_dynamics(1.0)
    for one, other in zip(
        varied("laikago", threads)[1].algorithms.centroidal_dynamics(1.0), expected, strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_bad_numbers_are_refused():
    _, batch = varied("laikago")
    length = batch.joints.positions.shape[1]
    with pytest.raises(ValueError, match="positions"):
        batch.algorithms.centroidal_dynamics(positions=np.zeros(length))
    with pytest.raises(ValueError, match="quaternion"):
        batch.algorithms.centroidal_dynamics(positions=np.zeros(7 + length))
    with pytest.raises(ValueError, match="forces must be finite"):
        batch.forward_dynamics(np.nan)
    fast = np.zeros((COUNT, 6 + length))
    fast[5] = 1e200
    with pytest.raises(ValueError, match="in world 5"):
        batch.algorithms.inverse_dynamics_derivatives(velocities=fast)


def test_bodies_that_cannot_move_have_empty_answers():
    from carom.model.body_spec import BodySpec, LinkSpec

    world = World()
    stone = world.load(BodySpec("stone", LinkSpec("base", mass=1.0), fixed_base=True))
    batch = Worlds(world, 2)[stone]
    assert batch.algorithms.inverse_dynamics_derivatives().dtau_dq.shape == (2, 0, 0)
    assert batch.forward_dynamics().shape == (2, 0)
    assert batch.algorithms.center_of_mass().shape == (2, 3)
