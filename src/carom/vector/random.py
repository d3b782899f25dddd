"""Random number generators of many environments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from gymnasium.utils import seeding
from numpy.typing import ArrayLike

from carom.checks import Array


class RandomSources:
    """One generator for each environment, so that its random numbers depend on its own seed only.

    Attributes:
        generators: The generators.
        seeds: Seed of each generator.

    Args:
        count: Number of environments.
    """

    def __init__(self, count: int) -> None:
        # A generator whose numbers are thrown away.
        self._spare = np.random.default_rng(0)
        made = [seeding.np_random() for _ in range(count)]
        self.generators: list[np.random.Generator] = [generator for generator, _ in made]
        self.seeds: list[int] = [seed for _, seed in made]

    def seed(self, seed: int | Sequence[int | None] | None, worlds: np.ndarray) -> None:
        """Seed the generators.

        Args:
            seed: Environment k gets `seed + k`, or the k-th of a list; None changes nothing.
            worlds: The environments that get a seed.

        Raises:
            ValueError: The number of seeds differs from the number of environments.
        """
        if seed is None:
            return
        count = len(self.generators)
        seeds = [seed + k for k in range(count)] if isinstance(seed, (int, np.integer)) else list(seed)
        if len(seeds) != count:
            raise ValueError(f"there are {len(seeds)} seeds for {count} environments")
        for world in worlds.tolist():
            own = seeds[world]
            if own is not None:
                self.generators[world], self.seeds[world] = seeding.np_random(int(own))

    @contextmanager
    def only(self, worlds: np.ndarray) -> Iterator[None]:
        """Let only some environments draw; those of the others get numbers that are not theirs meanwhile.

        So what the others draw later does not depend on what is drawn for these.
        """
        kept = self.generators
        self.generators = [self._spare] * len(kept)
        for world in worlds.tolist():
            self.generators[world] = kept[world]
        try:
            yield
        finally:
            for world in worlds.tolist():
                kept[world] = self.generators[world]
            self.generators = kept

    def checkpoint(self) -> dict[str, Any]:
        """The states of the generators and their seeds, for `resume`."""
        states = [generator.bit_generator.state for generator in self.generators]
        return {"seeds": list(self.seeds), "states": states}

    def resume(self, saved: Mapping[str, Any]) -> None:
        """Continue the generators of `checkpoint`."""
        for world, state in enumerate(saved["states"]):
            kind = getattr(np.random, state["bit_generator"])()
            kind.state = state
            self.generators[world] = np.random.Generator(kind)
        self.seeds[:] = saved["seeds"]

    def draw(self, worlds: np.ndarray, sample: Callable[[np.random.Generator], ArrayLike]) -> Array:
        """The results of `sample` for the generators of some environments, (n, ...)."""
        if not len(worlds):
            return np.zeros((0, *np.shape(sample(self._spare))))
        return np.array([sample(self.generators[world]) for world in worlds.tolist()], dtype=np.float64)

    def uniform(
        self, worlds: np.ndarray, low: float | Array, high: float | Array, size: int | None = None
    ) -> Array:
        """Uniform numbers from `low` to `high`, from the generators of some environments, (n, size)."""
        return self.draw(worlds, lambda generator: generator.uniform(low, high, size))
