"""`WorldsEnv`: from a world to a vector environment, with arrays alone."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike

from carom.camera import Camera
from carom.checks import Array
from carom.vector.actions import ActionChecker
from carom.vector.random import RandomSources
from carom.world.world import World
from carom.worlds.checks import Mask
from carom.worlds.worlds import Worlds

RESET_MASK = "reset_mask"
_MODES = (None, "rgb_array")


class WorldsEnv(VectorEnv[np.ndarray, np.ndarray, np.ndarray]):
    """Many environments of the same kind, one for each of many worlds.

    A subclass says how an episode begins (`begin`), what an action does (`act`), what is observed
    (`observe`), what that is worth (`reward`) and when it is over (`terminated`), each for all environments
    at once: arrays have them in front. In a step the four last are called in this order, with the worlds
    stepped between `act` and `observe`. What a reward compares with the state before the step has to be kept
    by `act`; `observe` may be called more than once for a state, and must not change any.

    Environment k depends on nothing but its own actions and its own seed: `reset(seed=s)` gives it `s + k`.

    Episodes that are over start again as `autoreset_mode` says. With `NEXT_STEP`, as Gymnasium's own vector
    environments have it, the next step ignores the action of such an environment, and returns what is
    observed at the beginning with a reward of 0. With `SAME_STEP` that observation comes in place of the
    last one, which is in `infos["final_obs"]`. With `DISABLED` nothing happens until
    `reset(options={"reset_mask": mask})`.

    Where velocities come out as NaN or infinite the world stands still, and its episode is truncated;
    `infos["halted"]` tells.

    Attributes:
        worlds: The worlds.
        steps: Steps of the worlds in one of the environments.
        max_episode_steps: After how many steps an episode is truncated; None for never.
        autoreset_mode: When episodes that are over start again.
        episode_steps: Steps of each environment in its present episode, (num_envs,).
        random: Where random numbers come from.
        camera: What `render` looks through; None for nothing.

    Args:
        world: What each world is like, and where episodes begin, unless `begin` changes it.
        num_envs: How many there are to be.
        observation_space: Of one environment.
        action_space: Of one environment: a `Box` of one axis, or `Discrete`.
        steps: Steps of the worlds in one of the environments.
        max_episode_steps: After how many steps an episode is truncated; None for never.
        autoreset_mode: When episodes that are over start again: one of Gymnasium's, or its value.
        threads: How many threads share the worlds; None for as many as there are processors.
        render_mode: "rgb_array" or None.
        camera: What `render` looks through.

    Raises:
        ValueError: A number is less than 1, or a mode is unknown.
        MemoryError: There is no room for so many worlds.
    """

    def __init__(
        self,
        world: World,
        num_envs: int,
        observation_space: gymnasium.spaces.Box,
        action_space: gymnasium.spaces.Space[Any],
        *,
        steps: int = 1,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: str | None = None,
        camera: Camera | None = None,
    ) -> None:
        for name, number in (("steps", steps), ("max_episode_steps", max_episode_steps)):
            if number is not None and number < 1:
                raise ValueError(f"{name} must be at least 1, not {number}")
        if render_mode not in _MODES:
            raise ValueError(f"render_mode must be one of {_MODES}, not {render_mode!r}")
        self.worlds = Worlds(world, num_envs, threads=threads)
        self.num_envs = num_envs
        self.single_observation_space = observation_space
        self.single_action_space = action_space
        self.observation_space = batch_space(observation_space, num_envs)
        self.action_space = batch_space(action_space, num_envs)
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"autoreset_mode": self.autoreset_mode, "render_modes": ["rgb_array"]}
        self.render_mode = render_mode
        self.camera = camera
        self.steps = steps
        self.max_episode_steps = max_episode_steps
        self.episode_steps = np.zeros(num_envs, dtype=np.int64)
        self.random = RandomSources(num_envs)
        self._saved_start = self.worlds.save([0])
        self._checked = ActionChecker(action_space, num_envs)
        # None has begun: steps ask for `reset` first.
        self._over: Mask = np.ones(num_envs, dtype=bool)
        self._begun = False

    # What subclasses say

    def begin(self, worlds: np.ndarray) -> None:
        """Make the beginnings of episodes differ; the worlds have just been put back to where they start.

        Args:
            worlds: Numbers of the environments whose episodes begin, (n,).
        """

    @abstractmethod
    def act(self, actions: np.ndarray) -> None:
        """Drive the bodies in the step that follows, and keep what `reward` compares with.

        Args:
            actions: Finite doubles (num_envs, numbers of an action), or integers (num_envs,) for choices.
        """

    def simulate(self) -> None:
        """Advance all worlds by a step of the environments."""
        self.worlds.step(self.steps)

    @abstractmethod
    def observe(self) -> np.ndarray:
        """What is observed now: a new array (num_envs, numbers of an observation)."""

    @abstractmethod
    def reward(self, actions: np.ndarray) -> Array:
        """What the step was worth: a new array (num_envs,).

        Args:
            actions: As `act` got them.
        """

    def terminated(self) -> Mask:
        """Where the episode is over, for other reasons than its length: a new array (num_envs,)."""
        return np.zeros(self.num_envs, dtype=bool)

    def infos(self) -> dict[str, Any]:
        """What else there is to tell of a step."""
        return {}

    # Gymnasium's interface

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: Environment k gets `seed + k`, or the k-th of a list; None goes on with the random numbers
                there are.
            options: `{"reset_mask": mask}` begins only those of the mask (num_envs,).

        Returns:
            What is observed, (num_envs, ...), and nothing more.
        """
        worlds = self._to_reset(options)
        self.random.seed(seed, worlds)
        self._begin(worlds)
        self._begun = True
        return self.observe(), {}

    def step(
        self, actions: ArrayLike
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Go on by a step.

        Args:
            actions: Of each environment, (num_envs, ...).

        Returns:
            Observations (num_envs, ...), rewards, terminations and truncations (num_envs,), and infos.

        Raises:
            ValueError: The actions have another shape, or one is not finite or no choice there is.
            gymnasium.error.ResetNeeded: An episode is over and none has begun.
        """
        values = self._checked(actions)
        beginning = self._to_begin()
        self.act(values)
        self.simulate()
        self.episode_steps += 1
        if len(beginning):
            self._begin(beginning)
        observations = self.observe()
        rewards, terminations = self.reward(values), self.terminated()
        infos = self.infos()
        truncations = self._truncations(infos)
        if len(beginning):
            rewards[beginning] = 0.0
            terminations[beginning] = False
        self._over = terminations | truncations
        if self.autoreset_mode == AutoresetMode.SAME_STEP and self._over.any():
            _tell_last(infos, observations, self._over)
            self._begin(np.flatnonzero(self._over))
            observations = self.observe()
        return observations, rewards, terminations, truncations, infos

    def render(self) -> tuple[np.ndarray, ...] | None:  # type: ignore[override]
        """A picture (height, width, 3) of each environment where `render_mode` is "rgb_array"."""
        if self.render_mode is None or self.camera is None:
            return None
        return tuple(self.worlds.images(self.camera).colour)

    @property
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """The generators of random numbers, one for each environment."""
        return tuple(self.random.generators)

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """What they were made from."""
        return tuple(self.random.seeds)

    # How it is done

    def _to_reset(self, options: dict[str, Any] | None) -> np.ndarray:
        mask = None if options is None else options.get(RESET_MASK)
        if mask is None:
            return np.arange(self.num_envs)
        mask = np.asarray(mask)
        if mask.dtype != np.bool_ or mask.shape != (self.num_envs,):
            raise ValueError(
                f"options[{RESET_MASK!r}] must be booleans of shape ({self.num_envs},), "
                f"not {mask.dtype} of shape {mask.shape}"
            )
        return np.flatnonzero(mask)

    def _to_begin(self) -> np.ndarray:
        """The environments that begin an episode instead of taking a step."""
        if not self._begun:
            raise gymnasium.error.ResetNeeded("no episode has begun: call reset first")
        if self.autoreset_mode == AutoresetMode.SAME_STEP:
            return np.zeros(0, dtype=np.int64)
        over = np.flatnonzero(self._over)
        if len(over) and self.autoreset_mode == AutoresetMode.DISABLED:
            raise gymnasium.error.ResetNeeded(
                f"the episode of environment {over[0]} is over: call reset with a {RESET_MASK}"
            )
        return over

    def _begin(self, worlds: np.ndarray) -> None:
        self.worlds.restore(self._saved_start, worlds)
        self.episode_steps[worlds] = 0
        self._over[worlds] = False
        self.begin(worlds)

    def _truncations(self, infos: dict[str, Any]) -> Mask:
        """Where the episode is as long as it may be, or the world stands still."""
        halted = self.worlds.halted
        if self.max_episode_steps is None:
            truncations = halted.copy()
        else:
            truncations = self.episode_steps >= self.max_episode_steps
            truncations |= halted
        if halted.any():
            infos["halted"] = halted.copy()
        return truncations


def _tell_last(infos: dict[str, Any], observations: np.ndarray, over: Mask) -> None:
    """Put the last observations of episodes where Gymnasium has them."""
    last = np.full(len(over), None, dtype=object)
    for world in np.flatnonzero(over):
        last[world] = observations[world]
    infos["final_obs"], infos["_final_obs"] = last, over.copy()
