"""What changes a Minitaur from one episode to the next."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any


class EnvRandomizerBase(ABC):
    """Something that each `reset` of an environment calls."""

    @abstractmethod
    def randomize_env(self, env: Any) -> None:
        """Changes what is in an environment, for one episode.

        Args:
            env: The environment; random numbers come from its `np_random`, that is from its seed.
        """
