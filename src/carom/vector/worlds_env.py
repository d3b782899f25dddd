"""`WorldsEnv`: a vector environment from copies of a world, computed with arrays only."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike

from carom.camera import Camera
from carom.checks import Array
from carom.vector.actions import ActionChecker
from carom.vector.checkpoints import attributes_of, read_checkpoint, set_attributes, write_checkpoint
from carom.vector.infos import batched_infos
from carom.vector.observations import own_observation, replace_observations
from carom.vector.random import RandomSources
from carom.world.world import World
from carom.worlds.chosen import Mask
from carom.worlds.worlds import Worlds

if TYPE_CHECKING:
    from carom.viewer.viewer import Viewer

RESET_MASK = "reset_mask"
_MODES = (None, "rgb_array")


class WorldsEnv(VectorEnv[Any, np.ndarray, np.ndarray]):
    """A vector environment: environments of the same kind, one for each of many worlds.

    A subclass defines how an episode begins (`begin`), what an action does (`act`), the observation
    (`observe`), the reward (`reward`) and when an episode is over (`terminated`, `truncated`), each for all
    environments at once: the first axis of arrays is the environment. A step calls the last five in this
    order, with the worlds stepped between `act` and `observe`. If a reward needs data from before the step,
    `act` has to keep them; `observe` may be called several times for a state, and must not change it. It may
    draw noise from `random`: if it is called for environments that begin, the others keep their observations
    and draw none.

    Environment k depends only on its own actions and its own seed: `reset(seed=s)` gives it `s + k`.

    `autoreset_mode` says when environments are reset after an episode. With `NEXT_STEP`, the default of
    Gymnasium's vector environments, the next step ignores the action of such an environment, and returns the
    first observation with a reward of 0. With `SAME_STEP` the first observation replaces the last one, which
    is in `infos["final_obs"]`, with the infos of that step in `infos["final_info"]`. With `DISABLED` call
    `reset(options={"reset_mask": mask})`.

    As in Gymnasium's own vector environments, each of the `infos` comes with a mask of the environments that
    have it, whose name begins with `_`. Environments that have just begun have none.

    If velocities become NaN or infinite the world is halted, and its episode is truncated; see
    `infos["halted"]`.

    Attributes:
        worlds: The worlds.
        steps: Number of simulation steps per environment step.
        max_episode_steps: Number of steps after which an episode is truncated; None for never.
        autoreset_mode: When environments are reset after an episode.
        episode_steps: Steps of each environment in its present episode, (num_envs,).
        random: The random number generators.
        camera: The camera of `render`; None for none.

    Args:
        world: The world to copy; episodes begin in its state, unless `begin` changes it.
        num_envs: Number of environments.
        observation_space: Observation space of one environment: a `Box`, or a `Dict` or `Tuple` of such.
        action_space: Action space of one environment: `Box`, `Discrete`, `MultiDiscrete` or `MultiBinary`.
        steps: Number of simulation steps per environment step.
        max_episode_steps: Number of steps after which an episode is truncated; None for never.
        autoreset_mode: When environments are reset after an episode: Gymnasium's `AutoresetMode`, or its
            value.
        threads: Number of threads; None for the number of processors.
        render_mode: "rgb_array" or None.
        camera: The camera of `render`.

    Raises:
        ValueError: A number is less than 1, or a mode is unknown.
        MemoryError: There is not enough memory for so many worlds.
    """

    def __init__(
        self,
        world: World,
        num_envs: int,
        observation_space: gymnasium.spaces.Space[Any],
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
        self.observation_space: gymnasium.spaces.Space[Any] = batch_space(observation_space, num_envs)
        self.action_space: gymnasium.spaces.Space[np.ndarray] = batch_space(action_space, num_envs)
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {
            "autoreset_mode": self.autoreset_mode,
            "render_modes": ["rgb_array"],
            "render_fps": round(1.0 / (steps * self.worlds.time_step)),
        }
        self.render_mode = render_mode
        self.camera = camera
        self.steps = steps
        self.max_episode_steps = max_episode_steps
        self.episode_steps = np.zeros(num_envs, dtype=np.int64)
        self.random = RandomSources(num_envs)
        self._saved_start = self.worlds.snapshot([0])
        self._checked = ActionChecker(action_space, num_envs)
        # No episode has begun: `step` raises an error until `reset` has been called.
        self._over: Mask = np.ones(num_envs, dtype=bool)
        self._begun = False
        self._observations: Any = None
        self._viewer: Viewer | None = None

    # To be defined by subclasses

    def end(self, worlds: np.ndarray) -> None:
        """Take note of episodes whose worlds are about to be restored, for example for a curriculum.

        The worlds are as the episodes have left them; with `NEXT_STEP` they have taken one more step.

        Args:
            worlds: Indices of the environments whose episodes have had at least one step, (n,).
        """

    def begin(self, worlds: np.ndarray) -> None:
        """Set the initial state of episodes, for example at random; the worlds have just been restored.

        Args:
            worlds: Indices of the environments whose episodes begin, (n,).
        """

    @abstractmethod
    def act(self, actions: np.ndarray) -> None:
        """Apply the actions for the next step, and keep data that `reward` needs.

        Args:
            actions: Finite doubles (num_envs, size of an action); integers for `Discrete` (num_envs,),
                `MultiDiscrete` and `MultiBinary` (num_envs, size of an action).
        """

    def simulate(self) -> None:
        """Advance all worlds by one environment step."""
        self.worlds.step(self.steps)

    @abstractmethod
    def observe(self) -> Any:
        """The observations: a new array (num_envs, ...), for `Dict` and `Tuple` spaces one of each part."""

    @abstractmethod
    def reward(self, actions: np.ndarray) -> Array:
        """The rewards of the step: a new array (num_envs,).

        Args:
            actions: As passed to `act`.
        """

    def terminated(self) -> Mask:
        """Which episodes are over, except by their length: a new array (num_envs,)."""
        return np.zeros(self.num_envs, dtype=bool)

    def truncated(self) -> Mask:
        """Which episodes are cut off, besides those of maximum length: a new array (num_envs,)."""
        return np.zeros(self.num_envs, dtype=bool)

    def infos(self) -> dict[str, Any]:
        """Further information on a step.

        Returns:
            By name an array or list with the environments in front, a dictionary of such, or one value for
            all.
        """
        return {}

    # Checkpoints

    def save(self, path: str | Path) -> None:
        """Write a checkpoint to a file.

        It contains the states of all worlds, all parameters that can differ between worlds, the random number
        generators, and attributes of this object that are numbers or arrays, also in dictionaries, lists and
        tuples, or that are `carom.vector.checkpoints.Resumable`. Other attributes that change during episodes
        have to be among what a subclass adds to `checkpoint` and takes back in `resume`.

        Raises:
            OSError: The file cannot be written; an existing file is unchanged.
        """
        write_checkpoint(path, self.checkpoint())

    def restore(self, path: str | Path) -> None:
        """Continue from a file of `save`, bit for bit, also in another process.

        Raises:
            OSError: The file cannot be read.
            ValueError: It is not a checkpoint, or one of other environments or of another number of them.
        """
        self.resume(read_checkpoint(path))

    def checkpoint(self) -> dict[str, Any]:
        """What `save` writes: numbers, texts and arrays, in dictionaries, lists and tuples."""
        return {"environment": type(self).__name__, "attributes": attributes_of(self)}

    def resume(self, saved: Mapping[str, Any]) -> None:
        """Continue from what `checkpoint` returned.

        Raises:
            ValueError: It is of other environments, or of another number of them.
        """
        kind, attributes = saved["environment"], saved["attributes"]
        if kind != type(self).__name__ or attributes["num_envs"] != self.num_envs:
            raise ValueError(
                f"this is a checkpoint of {attributes['num_envs']} {kind}; "
                f"these are {self.num_envs} {type(self).__name__}"
            )
        set_attributes(self, attributes)

    # Gymnasium's interface

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start episodes.

        Args:
            seed: Environment k gets `seed + k`, or the k-th of a list; None continues with the present
                generators.
            options: `{"reset_mask": mask}` resets only the environments of the mask (num_envs,); the others
                keep their observations.

        Returns:
            The observations, (num_envs, ...), and an empty dictionary.
        """
        worlds = self._to_reset(options)
        self.random.seed(seed, worlds)
        self._begin(worlds)
        if self._observations is None or len(worlds) == self.num_envs:
            self._observations = self.observe()
        else:
            self._observe_again(worlds)
        self._begun = True
        return deepcopy(self._observations), {}

    def step(self, actions: ArrayLike) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Take a step.

        Args:
            actions: Actions of all environments, (num_envs, ...).

        Returns:
            Observations (num_envs, ...), rewards, terminations and truncations (num_envs,), and infos.

        Raises:
            ValueError: The shape of the actions is wrong, or one is not finite or out of range.
            gymnasium.error.ResetNeeded: An episode is over and has not been reset.
        """
        values = self._checked(actions)
        beginning = self._to_begin()
        self.act(values)
        self.simulate()
        self.episode_steps += 1
        if len(beginning):
            self._begin(beginning)
        self._observations = self.observe()
        rewards, terminations, truncations = self.reward(values), self.terminated(), self.truncated()
        reported = self.infos()
        if len(beginning):
            truncations[beginning] = False
        truncations |= self._truncations(reported)
        stepped = np.ones(self.num_envs, dtype=bool)
        if len(beginning):
            rewards[beginning] = 0.0
            terminations[beginning] = False
            stepped[beginning] = False
        self._over = terminations | truncations
        infos = batched_infos(reported, self.num_envs, stepped)
        if self.autoreset_mode == AutoresetMode.SAME_STEP and self._over.any():
            infos = self._begin_at_once(reported, self._over.copy())
        return deepcopy(self._observations), rewards, terminations, truncations, infos

    def show(self, **options: Any) -> Viewer:
        """Shows some of the environments in a browser, or below the cell of a notebook.

        They go on as before: the window sees them at the rate of pictures. It can be paused and closed there;
        `close` closes it as well.

        Args:
            **options: As for `carom.viewer.Viewer`: `shown`, how many or which ones; `chosen`;
                `arrangement`, "grid" or "overlay"; `port` and others.

        Returns:
            The viewer; that of the last call, if its window is still open and no options are stated.

        Raises:
            OSError: The server cannot listen on the address.
            ValueError: There are no such environments.
        """
        from carom.viewer.viewer import Viewer

        if self._viewer is not None:
            if self._viewer.is_open and not options:
                return self._viewer
            self._viewer.close()
        self._viewer = Viewer(self.worlds, **{"title": type(self).__name__, **options})
        self._viewer.open_browser()
        return self._viewer

    def close_extras(self, **kwargs: Any) -> None:
        """Closes the window of `show`; called by `close`."""
        if self._viewer is not None:
            self._viewer.close()
            self._viewer = None

    def render(self) -> tuple[np.ndarray, ...] | None:  # type: ignore[override]
        """An image (height, width, 3) of each environment if `render_mode` is "rgb_array"."""
        if self.render_mode is None or self.camera is None:
            return None
        return tuple(self.worlds.images(self.camera).colour)

    @property
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """The random number generators, one for each environment."""
        return tuple(self.random.generators)

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """The seeds of the random number generators, one for each environment."""
        return tuple(self.random.seeds)

    # Implementation

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
        """The environments that are reset instead of taking a step."""
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
        if not len(worlds):
            return
        played = worlds[self.episode_steps[worlds] > 0]
        if len(played):
            self.end(played)
        self.worlds.restore(self._saved_start, worlds)
        self.episode_steps[worlds] = 0
        self._over[worlds] = False
        self.begin(worlds)

    def _begin_at_once(self, reported: dict[str, Any], over: Mask) -> dict[str, Any]:
        """Begin the episodes after those that are over; returns the infos, with the last ones of these."""
        ended = np.flatnonzero(over)
        infos = batched_infos(reported, self.num_envs, ~over)
        last = np.full(self.num_envs, None, dtype=object)
        for world in ended.tolist():
            last[world] = own_observation(self._observations, world)
        infos["final_obs"], infos["_final_obs"] = last, over.copy()
        infos["final_info"] = batched_infos(reported, self.num_envs, over)
        infos["_final_info"] = over.copy()
        self._begin(ended)
        self._observe_again(ended)
        return infos

    def _observe_again(self, worlds: np.ndarray) -> None:
        """Observe environments that have just begun; the others keep their observations."""
        with self.random.only(worlds):
            replace_observations(self._observations, self.observe(), worlds)

    def _truncations(self, infos: dict[str, Any]) -> Mask:
        """A mask of the episodes that have reached their maximum length or whose world is halted."""
        halted = self.worlds.halted
        if self.max_episode_steps is None:
            truncations = halted.copy()
        else:
            truncations = self.episode_steps >= self.max_episode_steps
            truncations |= halted
        if halted.any():
            infos["halted"] = halted.copy()
        return truncations
