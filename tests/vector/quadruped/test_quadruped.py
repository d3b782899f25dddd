"""The quadruped: it stands, its terms measure what they say, and the curriculum moves worlds."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import carom.vector  # noqa: F401  # registers the environments
from carom.vector.managers import Observation
from carom.vector.quadruped import terms
from carom.vector.quadruped.quadruped import Quadruped
from carom.vector.quadruped.terrain import LEVELS

COUNT = 4
STILL = np.zeros((COUNT, 12))


@pytest.fixture
def env() -> Quadruped:
    made = Quadruped(COUNT)
    made.reset(seed=0)
    return made


def test_gymnasium_knows_it():
    check_env(gymnasium.make("carom/QuadrupedWalk-v0").unwrapped, skip_render_check=True)
    many: Any = gymnasium.make_vec("carom/QuadrupedWalk-v0", num_envs=2).unwrapped
    assert many.max_episode_steps == 500


def test_noise_of_observations_is_as_large_as_what_sensors_have():
    """Commands, actions and the clock are known exactly."""
    env = Quadruped(128)
    seen, _ = env.reset(seed=1)
    found, first = {}, 0
    for name, term in env.task.observations.items():
        assert isinstance(term, Observation)
        truth = np.asarray(term.function(env))
        least, most = term.clip or (-np.inf, np.inf)
        part = seen[:, first : (first := first + truth.shape[1])]
        off = part / np.asarray(term.scale) - np.clip(truth, least, most)
        found[name] = float(np.abs(off).max())
    expected = {
        "velocity": 0.1, "rates": 0.2, "gravity": 0.05, "positions": 0.01, "rotation": 1.0, "scan": 0.02,
    }  # fmt: skip
    assert found == pytest.approx({name: expected.get(name, 0.0) for name in found}, rel=0.05, abs=1e-6)


def test_without_a_command_it_stands(env: Quadruped):
    env.levels[:] = 0
    env.reset()
    env.commands["velocity"][:] = 0.0
    for _ in range(100):
        _, _, terminations, _, _ = env.step(STILL)
        assert not terminations.any()
    assert env.touching.all()
    assert not env.bumping.any()
    assert (np.abs(env.trunks[:, 2] - env.ground.mean(axis=1) - 0.27) < 0.03).all()
    assert (np.abs(env.foot_heights) < 0.01).all()
    assert (env.gravity[:, 2] < -0.98).all()


def test_without_actions_it_treads_on_the_spot(env: Quadruped):
    env.levels[:] = 0
    env.reset()
    env.commands["velocity"][:] = 0.5, 0.0, 0.0
    start = env.trunks[:, :2].copy()
    heights, matches = [], []
    for _ in range(100):
        _, _, terminations, _, _ = env.step(STILL)
        assert not terminations.any()
        heights.append(env.foot_heights)
        matches.append(terms.trot(env))
    assert (np.max(heights, axis=0) > 0.015).all()
    assert np.mean(matches) > 0.6
    assert (np.abs(env.trunks[:, :2] - start) < 0.5).all()


def test_velocities_are_those_in_the_axes_of_the_trunk(env: Quadruped):
    ahead = np.array([[1.0, 0.5, 0.0, 0.0, 0.0, 0.7]])
    for world, turn in enumerate((0.0, 0.5 * np.pi, np.pi, -1.0)):
        env.stand(np.array([world]), np.zeros((1, 2)), np.array([turn]))
        cosine, sine = np.cos(turn), np.sin(turn)
        turned = ahead.copy()
        turned[0, :2] = cosine * 1.0 - sine * 0.5, sine * 1.0 + cosine * 0.5
        env.robot.set_base_velocities(turned, where=[world])
    env.measure()
    np.testing.assert_allclose(env.velocities, np.tile([1.0, 0.5, 0.0], (COUNT, 1)), atol=1e-12)
    np.testing.assert_allclose(env.rates, np.tile([0.0, 0.0, 0.7], (COUNT, 1)), atol=1e-12)
    env.commands["velocity"][:] = 1.0, 0.5, 0.7
    np.testing.assert_allclose(terms.follow_velocity(env), 1.0)
    np.testing.assert_allclose(terms.follow_turn(env), 1.0)
    env.commands["velocity"][:] = 0.5, 0.5, 0.2
    np.testing.assert_allclose(terms.follow_velocity(env), np.exp(-1.0))
    np.testing.assert_allclose(terms.follow_turn(env), np.exp(-1.0))


def test_a_robot_on_its_back_has_fallen(env: Quadruped):
    poses = env.robot.base_inertial_poses[[1]]
    env.robot.set_base_inertial_poses(poses[:, :3], (1.0, 0.0, 0.0, 0.0), where=[1])
    env.measure()
    assert terms.fallen(env).tolist() == [False, True, False, False]


def test_what_is_randomised_differs_between_worlds(env: Quadruped):
    for link, name in (("trunk", "mass"), ("FR_toe", "lateral_friction"), ("RL_toe", "lateral_friction")):
        assert len(np.unique(env.robot.dynamics(link)[name])) == COUNT
    assert len(np.unique(env.stiffness)) == len(np.unique(env.damping)) == COUNT


def test_what_is_randomised_stays_near_what_it_is_without(env: Quadruped):
    for seed in range(4):
        env.reset(seed=seed)
        shares = {
            "mass": env.robot.dynamics("trunk")["mass"] / env.trunk_mass,
            "stiffness": env.stiffness / 30.0,
            "damping": env.damping / 0.8,
        }
        for name, most in (("mass", 0.2), ("stiffness", 0.1), ("damping", 0.1)):
            assert (np.abs(shares[name] - 1.0) <= most).all(), name
        friction = env.robot.dynamics("FR_toe")["lateral_friction"]
        assert (friction >= 0.5).all() and (friction <= 1.2).all()


def test_pushes_change_the_horizontal_velocity(env: Quadruped):
    before = env.robot.base_velocities
    terms.push(env, np.array([2]))
    change = env.robot.base_velocities - before
    assert change[2, :2].all()
    assert not np.delete(change, 2, axis=0).any()
    assert not change[2, 2:].any()


def test_who_walks_climbs_and_who_does_not_descends(env: Quadruped):
    env.levels[:] = 1, 1, 0, LEVELS - 1
    env.asked[:] = 4.0
    env.walked[:] = 3.5, 1.0, 1.0, 4.0
    terms.climb(env, np.arange(COUNT))
    assert env.levels[:3].tolist() == [2, 0, 0]
    assert 0 <= env.levels[3] < LEVELS


def test_who_walks_some_of_the_way_stays_on_its_level(env: Quadruped):
    env.levels[:] = 1
    env.asked[:] = 4.0
    env.walked[:] = 0.4 * 4.0, 2.0, 2.875, 0.75 * 4.0
    terms.climb(env, np.arange(COUNT))
    assert env.levels.tolist() == [1, 1, 1, 1]


def test_who_was_asked_to_walk_a_metre_at_most_does_not_climb(env: Quadruped):
    env.levels[:] = 1
    env.asked[:] = 1.0, 1.0625, 0.0, 0.5
    env.walked[:] = env.asked
    terms.climb(env, np.arange(COUNT))
    assert env.levels.tolist() == [1, 2, 1, 1]


def test_the_distance_walked_is_that_along_the_command(env: Quadruped):
    env.commands["velocity"][:] = 0.5, 0.0, 0.0
    env.walked[:] = env.asked[:] = 0.0
    env.robot.set_base_velocities((0.0, 0.0, 3.0, 0.0, 0.0, 0.0))
    velocities = np.zeros((COUNT, 6))
    velocities[:, 2] = 3.0
    facing = env.trunks.copy()
    before = env.robot.base_inertial_poses[:, :2].copy()
    for world in range(COUNT):
        x, y, z, w = facing[world, 3:]
        velocities[world, :2] = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)
    env.robot.set_base_velocities(velocities)
    env.simulate()
    moved = np.sqrt(np.square(env.robot.base_inertial_poses[:, :2] - before).sum(axis=1))
    np.testing.assert_allclose(env.walked, moved, rtol=1e-2)
    np.testing.assert_allclose(env.asked, 0.01)


def test_a_robot_outside_is_cut_off(env: Quadruped):
    far = env.terrain.half[None] - 0.5
    env.stand(np.array([3]), far, np.zeros(1))
    _, _, terminations, truncations, infos = env.step(STILL)
    assert truncations.tolist() == [False, False, False, True]
    assert not terminations.any()
    assert infos["terminations"]["outside"].tolist() == truncations.tolist()


def test_diagonal_pairs_of_feet_are_wanted_in_the_air_in_turn(env: Quadruped):
    env.commands["velocity"][:] = 1.0, 0.0, 0.0
    env.commands["velocity"][3] = 0.0
    env.episode_steps[:] = 5
    wanted = env.wanted_touching()
    assert wanted[:3].tolist() == [[True, False, False, True]] * 3
    assert wanted[3].all()
    env.episode_steps[:] = 20
    assert env.wanted_touching()[0].tolist() == [False, True, True, False]
