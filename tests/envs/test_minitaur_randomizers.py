"""What makes Minitaurs differ, pushes them, and puts blocks in their way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pybullet
from pybullet_envs.minitaur.envs import MinitaurAlternatingLegsEnv, MinitaurReactiveEnv
from pybullet_envs.minitaur.envs.env_randomizers import minitaur_env_randomizer_config as configurations
from pybullet_envs.minitaur.envs.env_randomizers.minitaur_alternating_legs_env_randomizer import (
    MinitaurAlternatingLegsEnvRandomizer,
)
from pybullet_envs.minitaur.envs.env_randomizers.minitaur_env_randomizer import MinitaurEnvRandomizer
from pybullet_envs.minitaur.envs.env_randomizers.minitaur_env_randomizer_from_config import (
    MinitaurEnvRandomizerFromConfig,
)
from pybullet_envs.minitaur.envs.env_randomizers.minitaur_push_randomizer import MinitaurPushRandomizer
from pybullet_envs.minitaur.envs.env_randomizers.minitaur_terrain_randomizer import (
    MinitaurTerrainRandomizer,
    PoissonDisc2D,
    TerrainType,
)


@pytest.fixture
def env() -> Any:
    env = MinitaurReactiveEnv()
    yield env
    env.close()


def masses(env: Any) -> list[float]:
    links = (*env.minitaur.chassis_link_ids, *range(1, 26))
    return [env.pybullet_client.getDynamicsInfo(env.minitaur.quadruped, link)[0] for link in links]


def test_masses_differ_by_a_fifth_at_most(env: Any) -> None:
    usual = masses(env)
    env.add_env_randomizer(MinitaurEnvRandomizer())
    env.reset(seed=1)
    shares = np.divide(masses(env), usual)
    assert (np.abs(shares - 1.0) <= 0.2 + 1e-9).all()
    chassis = len(env.minitaur.chassis_link_ids)
    assert shares[:chassis] == pytest.approx([shares[0]] * chassis)
    assert shares.std() > 0.05
    assert 14.8 <= env.minitaur._motor_model.get_voltage() <= 16.8


def test_all_that_a_configuration_lists_is_drawn(env: Any) -> None:
    env.add_env_randomizer(MinitaurEnvRandomizerFromConfig())
    env.reset(seed=2)
    robot, ranges = env.minitaur, configurations.all_params()
    drawn = {
        "mass": masses(env)[0] / robot.GetBaseMassesFromURDF()[0],
        "inertia": env.pybullet_client.getDynamicsInfo(robot.quadruped, -1)[2][0]
        / robot.GetBaseInertiasFromURDF()[0][0],
        "motor friction": robot._motor_model.get_viscous_dampling(),
        "control step": env.control_time_step,
        "latency": robot.GetControlLatency(),
        "lateral friction": env.pybullet_client.getDynamicsInfo(robot.quadruped, robot._foot_link_ids[0])[1],
        "battery": robot._motor_model.get_voltage(),
    }
    for name, value in drawn.items():
        assert ranges[name][0] <= value <= ranges[name][1], name
    assert len(set(robot._motor_model._strength_ratios)) == 8
    for _ in range(2):
        env.step(np.zeros(8))
        env.reset()
        assert env.pybullet_client.getPhysicsEngineParameters()["fixedTimeStep"] == env._time_step == 0.001


@pytest.mark.parametrize("config", ["some_params", "PARAM_RANGE"])
def test_there_is_no_such_configuration(config: str) -> None:
    with pytest.raises(ValueError, match=f"Config {config} is not found"):
        MinitaurEnvRandomizerFromConfig(config)


def test_a_configuration_with_something_unknown_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(configurations, "mine", lambda: {"mood": (0.0, 1.0)}, raising=False)
    with pytest.raises(ValueError, match="mood"):
        MinitaurEnvRandomizerFromConfig("mine")


def test_legs_are_bent() -> None:
    env = MinitaurAlternatingLegsEnv(env_randomizer=MinitaurAlternatingLegsEnvRandomizer(0.05, 0.2, 0.03))
    env.reset(seed=1)
    assert 0.0 < np.abs(env._offset[:4]).max() <= 0.05 < np.abs(env._offset[4:]).max() <= 0.2
    assert 0.0 < abs(env.desired_pitch) <= 0.03
    env.close()


def speeds(env: Any, steps: int) -> list[float]:
    env.reset(seed=1)
    found = []
    for _ in range(steps):
        env.step(np.zeros(8))
        velocity, _ = env.pybullet_client.getBaseVelocity(env.minitaur.quadruped)
        found.append(float(np.hypot(*velocity[:2])))
    return found


def test_pushes_begin_and_end(env: Any) -> None:
    left_alone = speeds(env, 9)
    env.add_env_randomizer(MinitaurPushRandomizer(2, 4, 2, (150.0, 150.0), (1.0, 1.0)))
    pushed = speeds(env, 9)
    # Steps 0 and 1 are before the start, 4, 5 and 8 are within pushes.
    assert pushed[:4] == left_alone[:4]
    assert pushed[4] < pushed[5] > pushed[7]
    assert pushed[5] > left_alone[5] + 0.1


@given(st.integers(0, 1000), st.floats(0.4, 3.0))
def test_random_points_are_apart_and_leave_no_gaps(seed: int, radius: float) -> None:
    points = np.array(PoissonDisc2D(6.0, 4.0, radius, 30, np.random.default_rng(seed)).generate())
    assert (points >= 0.0).all()
    assert (points < (6.0, 4.0)).all()
    distances = np.linalg.norm(points[:, None] - points[None], axis=-1)
    assert (distances + 10.0 * np.eye(len(points)) >= radius).all()
    places = np.stack(np.meshgrid(np.linspace(0, 6, 13), np.linspace(0, 4, 9)), axis=-1).reshape(-1, 1, 2)
    assert np.linalg.norm(places - points, axis=-1).min(axis=1).max() < 2.0 * radius


def test_blocks_are_laid_anew_for_each_episode(env: Any) -> None:
    env.add_env_randomizer(MinitaurTerrainRandomizer(TerrainType.RANDOM_BLOCKS))
    counts, places = [], []
    for seed in (1, 2, 1):
        env.reset(seed=seed)
        bullet = env.pybullet_client
        counts.append(bullet.getNumBodies())
        blocks = {bullet.getBodyUniqueId(number) for number in range(counts[-1])} - env._loaded_bodies
        places.append(sorted(bullet.getBasePositionAndOrientation(block)[0] for block in blocks))
    assert min(counts) > 100
    assert places[0] == places[2] != places[1]
    assert all(max(abs(x), abs(y)) >= 1.0 and 0.0 < z < 0.03 for x, y, z in places[0])
    env.step(np.zeros(8))


def test_hills_take_the_place_of_the_ground(env: Any) -> None:
    env.add_env_randomizer(MinitaurTerrainRandomizer())
    for _ in range(2):
        env.reset(seed=1)
        assert env.pybullet_client.getNumBodies() == 2
        assert env.pybullet_client.getCollisionShapeData(env.ground_id, -1)[0][2] == pybullet.GEOM_MESH
        env.step(np.zeros(8))
