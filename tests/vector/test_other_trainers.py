"""Adapters for RSL-RL and PettingZoo, where these are installed."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from tests.face.scene import ARM

from carom import World
from carom.vector.managers import ManagerEnv, Observation, Reward, Task, Termination
from carom.vector.managers import library as ready

TASK = Task(
    {
        "policy": {"joints": Observation(ready.joint_positions("arm"))},
        "critic": {"rates": Observation(ready.joint_velocities("arm"))},
    },
    {"alive": Reward(ready.alive(), 1.0)},
    {"late": Termination(ready.longer_than(0.1), time_out=True)},
)


class Arms(ManagerEnv):
    """Arms whose actuators are controlled."""

    def __init__(self, num_envs: int, **options: Any) -> None:
        world = World()
        world.load(ARM)
        action = np.ones(2, np.float32)
        super().__init__(world, num_envs, gymnasium.spaces.Box(-action, action), TASK, steps=2, **options)

    def apply(self, actions: np.ndarray) -> None:
        self.worlds.controls = actions


def test_rsl_rl_gets_groups_rewards_and_time_outs() -> None:
    pytest.importorskip("rsl_rl")
    pytest.importorskip("tensordict")
    torch = pytest.importorskip("torch")
    from carom.vector.rsl_rl import RslRlEnv

    env = RslRlEnv(Arms(3, autoreset_mode="SameStep"))
    assert (env.num_envs, env.num_actions) == (3, 2)
    assert {name: tuple(part.shape) for name, part in env.get_observations().items()} == {
        "policy": (3, 2), "critic": (3, 2),
    }  # fmt: skip
    ends = []
    observations = env.get_observations()
    for _ in range(14):
        observations, rewards, dones, extras = env.step(torch.full((3, 2), 5.0))
        ends.append(bool(dones.all()))
        assert torch.equal(dones, extras["time_outs"])
        assert tuple(rewards.shape) == (3,)
    assert sum(ends) == 1
    assert observations["policy"].dtype == torch.float32
    env.episode_length_buf = torch.tensor([1, 2, 3])
    assert env.episode_length_buf.tolist() == [1, 2, 3]
    with pytest.raises(ValueError, match="autoreset_mode='SameStep'"):
        RslRlEnv(Arms(1))


def test_petting_zoo_gets_one_agent_for_each_part() -> None:
    pytest.importorskip("pettingzoo")
    from pettingzoo.test import parallel_api_test  # pyright: ignore[reportMissingImports]

    from carom.vector.petting_zoo import Agent, AgentsEnv

    agents = {
        "upper": Agent("policy", slice(0, 1)),
        "lower": Agent("critic", slice(1, 2), lambda env: np.full(1, 2.0)),
    }
    env = AgentsEnv(Arms(1), agents)
    parallel_api_test(env, 40)
    seen, _ = env.reset(seed=1)
    assert {name: part.shape for name, part in seen.items()} == {"upper": (2,), "lower": (2,)}
    _, rewards, *_ = env.step({"upper": [0.5], "lower": [0.0]})
    assert rewards == {"upper": pytest.approx(2 * 0.004), "lower": 2.0}
    assert env.env.worlds.controls.tolist() == [[0.5, 0.0]]
    with pytest.raises(ValueError, match="there is no group 'eyes'; there are"):
        AgentsEnv(Arms(1), {"upper": Agent("eyes", slice(0, 2))})
    with pytest.raises(ValueError, match=r"these many choose each: \[1, 0\]"):
        AgentsEnv(Arms(1), {"upper": agents["upper"]})
    with pytest.raises(ValueError, match="one world"):
        AgentsEnv(Arms(2), agents)
