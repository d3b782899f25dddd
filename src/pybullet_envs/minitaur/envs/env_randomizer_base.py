"""What changes a Minitaur from one episode to the next, and disturbs it on the way."""

from __future__ import annotations

from typing import Any

from pybullet_envs.bullet import env_randomizer_base


class EnvRandomizerBase(env_randomizer_base.EnvRandomizerBase):
    """Something that an environment calls at each `reset`, and in each step."""

    def randomize_step(self, env: Any) -> None:
        """Called before each step of the environment."""

    def randomize_sub_step(self, env: Any, sub_step_index: int, num_sub_steps: int) -> None:
        """Called before each step of the simulation; forces last for one of them.

        Args:
            env: The environment.
            sub_step_index: The number of the step within that of the environment, from 0.
            num_sub_steps: How many there are.
        """
