"""Base class of randomizers, which change a Minitaur between episodes and disturb it in steps."""

from __future__ import annotations

from typing import Any

from pybullet_envs.bullet import env_randomizer_base


class EnvRandomizerBase(env_randomizer_base.EnvRandomizerBase):
    """A randomizer, called by an environment at each `reset` and in each step."""

    def randomize_step(self, env: Any) -> None:
        """Called before each environment step."""

    def randomize_sub_step(self, env: Any, sub_step_index: int, num_sub_steps: int) -> None:
        """Called before each simulation step; forces last for one of these.

        Args:
            env: The environment.
            sub_step_index: Index of the simulation step within the environment step, from 0.
            num_sub_steps: Number of simulation steps per environment step.
        """
