"""Several agents in one world, as PettingZoo has them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import gymnasium
import numpy as np

try:
    from pettingzoo import ParallelEnv  # pyright: ignore[reportMissingImports]
except ImportError as missing:
    raise ImportError(
        "carom.vector.petting_zoo needs PettingZoo; install it with: pip install pettingzoo",
        name="pettingzoo",
    ) from missing

from dataclasses import dataclass

from carom.vector.worlds_env import WorldsEnv


@dataclass(frozen=True)
class Agent:
    """What one agent of an environment sees, does and gets.

    Attributes:
        observation: Name of the group of observations that it sees.
        actions: Which numbers of the action of the environment it chooses.
        reward: Its reward, (1,), from the environment; None for that of all.
    """

    observation: str
    actions: slice
    reward: Callable[[Any], Any] | None = None


class AgentsEnv(ParallelEnv):  # pyright: ignore[reportMissingTypeArgument]
    """A `WorldsEnv` of one world whose observation groups and actions belong to several agents.

    All agents act in each step, and an episode is over for all at once.

    Attributes:
        env: The environment.
        possible_agents: Names of the agents.
        agents: Those that are in the present episode: all, or none after its end.
        render_mode: That of the environment.

    Args:
        env: An environment with one world, whose observations are groups by name and whose actions are a
            `Box` of one axis.
        agents: The agents by name.

    Raises:
        ValueError: It has several worlds, no such groups, or actions that nobody or several choose.
    """

    def __init__(self, env: WorldsEnv, agents: Mapping[str, Agent]) -> None:
        spaces, box = env.single_observation_space, env.single_action_space
        if env.num_envs != 1 or not isinstance(spaces, gymnasium.spaces.Dict):
            raise ValueError("agents need a WorldsEnv of one world whose observations are groups by name")
        if not isinstance(box, gymnasium.spaces.Box) or len(box.shape) != 1:
            raise ValueError(f"the actions of all agents must be a Box of one axis, not {box}")
        taken = np.zeros(box.shape, dtype=np.int64)
        for name, agent in agents.items():
            if agent.observation not in spaces.spaces:
                known = ", ".join(spaces.spaces)
                raise ValueError(
                    f"agent {name!r}: there is no group {agent.observation!r}; there are {known}"
                )
            taken[agent.actions] += 1
        if (taken != 1).any():
            raise ValueError(
                f"each action must be that of one agent; these many choose each: {taken.tolist()}"
            )
        self.env = env
        self.metadata: dict[str, Any] = {"name": type(env).__name__, "render_modes": ["rgb_array"]}
        self.render_mode = env.render_mode
        self.possible_agents: list[str] = [*agents]
        self.agents: list[str] = []
        self._given = dict(agents)
        self.observation_spaces: dict[str, gymnasium.Space[Any]] = {
            name: spaces[agent.observation] for name, agent in agents.items()
        }
        self.action_spaces: dict[str, gymnasium.Space[Any]] = {
            name: gymnasium.spaces.Box(box.low[agent.actions], box.high[agent.actions], dtype=box.dtype.type)  # pyright: ignore[reportArgumentType, reportOptionalMemberAccess]
            for name, agent in agents.items()
        }

    def observation_space(self, agent: str) -> gymnasium.Space[Any]:
        """What an agent sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gymnasium.Space[Any]:
        """What an agent does."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Start an episode: the observations and the infos of all agents."""
        observation, _ = self.env.reset(seed=seed)
        self.agents = [*self.possible_agents]
        return self._seen(observation), {name: {} for name in self.agents}

    def step(self, actions: Mapping[str, Any]) -> Any:
        """Take a step with the actions of all agents.

        Returns:
            Observations, rewards, which agents have come to an end, which are cut off, and infos, by agent.
        """
        whole = np.zeros((1, *(self.env.single_action_space.shape or ())))
        for name, agent in self._given.items():
            whole[0, agent.actions] = actions[name]
        observation, reward, terminated, truncated, _ = self.env.step(whole)
        names = self.agents
        rewards = {
            name: float(reward[0] if agent.reward is None else np.asarray(agent.reward(self.env))[0])
            for name, agent in self._given.items()
        }
        if terminated[0] or truncated[0]:
            self.agents = []
        return (
            self._seen(observation),
            rewards,
            dict.fromkeys(names, bool(terminated[0])),
            dict.fromkeys(names, bool(truncated[0])),
            {name: {} for name in names},
        )

    def render(self) -> Any:
        """The image of the environment."""
        pictures = self.env.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    def _seen(self, observation: Mapping[str, np.ndarray]) -> dict[str, Any]:
        return {name: observation[agent.observation][0].copy() for name, agent in self._given.items()}
