"""The KUKA that grasps, and the racing car, beside what PyBullet's own environments do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.envs.record import EvenChance

import pybullet
import pybullet_data
from pybullet_envs.bullet import KukaDiverseObjectEnv, KukaGymEnv, RacecarGymEnv
from pybullet_envs.bullet.kuka import Kuka

# Recorded with PyBullet 3.2.7: the gripper and the block after so many steps, and the reward. Its wrist is a
# mesh, which is up to 2 mm nearer to the block than ours.
STEERED = {
    0: (
        [0.532117, -0.001107, 0.452298, 3.14129, 0.001438, -3.141371, -0.017033, 0.074921, -0.752964],
        0.0,
    ),
    1: (
        [0.532117, -0.001107, 0.452298, 3.14129, 0.001438, -3.141373, -0.017032, 0.074921, -0.752966],
        -6.143661,
    ),
    5: (
        [0.534178, 0.002878, 0.451304, 3.141482, 0.000038, 3.124972, -0.014614, 0.071309, -0.769807],
        -6.105884,
    ),
}
CHOSEN = {
    5: (
        [0.533938, 0.000638, 0.451307, 3.141399, -0.001934, -3.123682, -0.018544, 0.072946, -0.735276],
        -6.437544,
    ),
}


@pytest.mark.parametrize(("discrete", "recorded"), [(False, STEERED), (True, CHOSEN)])
def test_the_kuka_moves_as_pybullets(discrete: bool, recorded: dict[int, tuple[list[float], float]]) -> None:
    env: Any = KukaGymEnv(isDiscrete=discrete)
    env.np_random = EvenChance()
    observation, reward = env.reset()[0], 0.0
    for step in range(6):
        if step in recorded:
            assert observation == pytest.approx(recorded[step][0], abs=2e-6)
            assert reward == pytest.approx(recorded[step][1], abs=0.02)
        action = (2 * step + 5) % 7 if discrete else 0.5 * np.sin(0.1 * step + np.arange(3))
        observation, reward, ended, *_ = env.step(action)
        assert not ended
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
    ended = False
    for _ in range(8):
        assert not ended
        *_, ended, _, found = env.step(0)
        assert found["grasp_success"] in (0, 1)
        if ended:
            break
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
