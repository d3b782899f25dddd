"""Base class of randomizers, which change a Minitaur from one episode to the next."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any


class EnvRandomizerBase(ABC):
    """A randomizer, called by each `reset` of an environment."""

    @abstractmethod
    def randomize_env(self, env: Any) -> None:
        """Changes the robot or the world of an environment, for one episode.

        Args:
            env: The environment; random numbers come from its `np_random`, that is from its seed.
        """
