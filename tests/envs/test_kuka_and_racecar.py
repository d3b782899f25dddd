"""The KUKA that grasps, and the racing car, beside what PyBullet's own environments do."""

from __future__ import annotations

import importlib
import json
from typing import Any

import numpy as np
import pytest
from tests.envs.record import ON_OUR_DATA, RECORD, EvenChance, action_on_our_data

import pybullet
import pybullet_data
from pybullet_envs.bullet import KukaDiverseObjectEnv, KukaGymEnv, RacecarGymEnv
from pybullet_envs.bullet.kuka import Kuka

RECORDED = json.loads(RECORD.read_text())
TOLERANCES = {"bullet.kukaGymEnv:KukaGymEnv": (2e-6, 2e-3), "bullet.racecarGymEnv:RacecarGymEnv": (0.1, 0.02)}
"""Of observations and of rewards."""
EPISODES = [(name, discrete) for name in ON_OUR_DATA for discrete in range(len(RECORDED[name]))]


@pytest.mark.parametrize(("name", "discrete"), EPISODES)
def test_robots_move_and_are_rewarded_as_pybullets(name: str, discrete: int) -> None:
    module, _, kind = name.partition(":")
    env: Any = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)(isDiscrete=bool(discrete))
    env.np_random = EvenChance()
    observation, reward = env.reset()[0], 0.0
    seeing, rewarding = TOLERANCES[name]
    for step, (seen, rewarded) in enumerate(RECORDED[name][discrete]):
        assert observation == pytest.approx(seen, abs=seeing)
        assert reward == pytest.approx(rewarded, abs=rewarding)
        observation, reward, ended, *_ = env.step(action_on_our_data(name, bool(discrete), step))
        assert not ended
    env.close()


def test_the_kuka_stands_beside_a_table_on_the_floor() -> None:
    env: Any = KukaGymEnv()
    env.reset(seed=1)
    client = env._p
    places = [client.getBasePositionAndOrientation(body)[0] for body in range(2)]
    assert [client.getBodyInfo(body)[1] for body in range(2)] == [b"plane", b"table.urdf"]
    assert places[0] == (0.0, 0.0, -1.0)
    assert places[1][:2] == (0.5, 0.0)
    # Its top is below what lies on the tray.
    assert client.getAABB(1)[1][2] < client.getBasePositionAndOrientation(env.blockUid)[0][2]
    env.close()


def test_the_kuka_comes_down_and_grasps() -> None:
    env: Any = KukaGymEnv(actionRepeat=10)
    env.reset(seed=1)
    ended = False
    for _ in range(100):
        *_, ended, _, _ = env.step(np.zeros(3))
        if ended:
            break
    assert ended
    assert env.terminated
    env.close()


def test_diverse_objects_lie_in_the_tray_until_one_grasp_ends_the_episode() -> None:
    env: Any = KukaDiverseObjectEnv(numObjects=2, isDiscrete=True)
    first, _ = env.reset(seed=2)
    assert first.std() > 5.0
    for body in env._objectUids:
        (x, y, z), _ = env._p.getBasePositionAndOrientation(body)
        assert 0.3 < x < 0.95
        assert abs(y) < 0.4
        assert -0.2 < z < 0.0

    def wrist() -> float:
        return env._p.getLinkState(env._kuka.kukaUid, env._kuka.kukaEndEffectorIndex)[0][2]

    ended = False
    for _ in range(8):
        assert not ended
        height = wrist()
        *_, ended, _, found = env.step(0)
        assert found["grasp_success"] in (0, 1)
        if ended:
            break
        # Its height is not chosen: it comes down with each step.
        assert wrist() < height - 0.02
    assert ended
    env.close()


@pytest.mark.parametrize("discrete", [False, True])
def test_the_racecar_comes_nearer_when_it_drives_to_the_ball(discrete: bool) -> None:
    env: Any = RacecarGymEnv(isDiscrete=discrete)
    env.np_random = EvenChance()
    observation, _ = env.reset()
    distances = [float(np.hypot(*observation))]
    for _ in range(6):
        aside = np.clip(np.arctan2(observation[1], observation[0]), -1.0, 1.0)
        action = 6 + int(np.sign(aside)) + 1 if discrete else np.array([1.0, aside])
        observation, reward, *_ = env.step(action)
        distances.append(float(np.hypot(*observation)))
        assert -distances[-1] < reward < 0.0
    assert distances[0] == pytest.approx(5.0, abs=0.3)
    assert min(distances) < distances[0] - 0.5
    env.close()


def test_scripts_that_use_the_arm_alone_have_the_first_connection() -> None:
    pybullet.connect(pybullet.DIRECT)
    try:
        arm = Kuka(pybullet_data.getDataPath(), timeStep=1 / 240)
        assert pybullet.getNumBodies() == 2
        assert arm.getActionDimension() == 12
        assert arm.getObservationDimension() == 6
        before = arm.endEffectorPos[:]
        arm.applyAction([0.01, -0.01, -0.002, 0.1, 0.3])
        assert arm.endEffectorPos == pytest.approx([before[0] + 0.01, before[1] - 0.01, before[2] - 0.002])
        pybullet.stepSimulation()
    finally:
        pybullet.disconnect()
