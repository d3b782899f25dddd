"""`ManagerEnv`: a vector environment whose task is a list of terms."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np

from carom.checks import Array
from carom.vector.delays import DelayLine
from carom.vector.managers.clock import Clock
from carom.vector.managers.observing import Groups, Observer, observer_of
from carom.vector.managers.terms import Task, shaped
from carom.vector.worlds_env import WorldsEnv
from carom.world.world import World
from carom.worlds.chosen import Mask


class ManagerEnv(WorldsEnv):
    """A `WorldsEnv` whose observations, rewards, terminations, events and commands are terms of a `Task`.

    A subclass says what an action does (`apply`), and in `prepare` gets the bodies that the terms use. In a
    step, interval events and new commands come first, then the action and the simulation, then observations,
    rewards and terminations.

    The infos of a step are `rewards`, the sum of each reward term in the episode; `terminations`, which
    termination terms apply; and `curriculum`, the latest number of each curriculum term.

    Attributes:
        task: The task.
        commands: The present commands by name, (num_envs, n).
        actions: The latest actions, (num_envs, n); 0 when an episode begins.
        last_actions: Those before them.
        reward_sums: The sum of each reward term in the episode, (num_envs,).

    Args:
        world: The world to copy.
        num_envs: Number of environments.
        action_space: Action space of one environment, a `Box` with one axis.
        task: The terms.
        **options: As for `WorldsEnv`.

    Raises:
        ValueError: What a term returns has a wrong shape.
    """

    def __init__(
        self, world: World, num_envs: int, action_space: gymnasium.spaces.Box, task: Task, **options: Any
    ) -> None:
        super().__init__(world, num_envs, _box(0), action_space, **options)
        self.task = task
        self.duration: float = self.steps * self.worlds.time_step
        """Duration of an environment step [s]."""
        self.actions: Array = np.zeros((num_envs, *action_space.shape))
        self.last_actions: Array = self.actions.copy()
        self._late_actions = DelayLine(num_envs, action_space.shape, task.action_delay, name="action_delay")
        self.reward_sums: dict[str, Array] = {name: np.zeros(num_envs) for name in task.rewards}
        self.commands: dict[str, Array] = {}
        self._ended: dict[str, Mask] = {name: np.zeros(num_envs, dtype=bool) for name in task.terminations}
        self._difficulties: dict[str, float] = {}
        self._started: Mask = np.zeros(num_envs, dtype=bool)
        intervals = {name: event for name, event in task.events.items() if event.when == "interval"}
        self._event_clocks = {
            name: Clock(num_envs, event.seconds, f"event {name!r}") for name, event in intervals.items()
        }
        self._command_clocks = {
            name: Clock(num_envs, command.seconds, f"command {name!r}")
            for name, command in task.commands.items()
        }
        self.prepare()
        every = np.arange(num_envs)
        with self.random.only(every[:0]):
            for name, command in task.commands.items():
                first = np.asarray(command.function(self, every), dtype=np.float64)
                if first.ndim != 2 or len(first) != num_envs:
                    raise ValueError(
                        f"command {name!r} returned an array of shape {first.shape}; it must have shape "
                        f"({num_envs}, n)"
                    )
                self.commands[name] = np.zeros_like(first)
        self.observer: Observer | Groups = observer_of(self, task.observations)
        self.single_observation_space = self.observer.space()
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)

    # To be defined by subclasses

    def prepare(self) -> None:
        """Get what the terms use, for example bodies of `worlds`, before they are called the first time."""

    @abstractmethod
    def apply(self, actions: Array) -> None:
        """Apply the actions for the next step.

        Args:
            actions: Finite doubles (num_envs, n): `self.actions`, or earlier ones with `Task.action_delay`.
        """

    # What `WorldsEnv` asks

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """See `WorldsEnv.reset`; after a new seed the events of the start happen again."""
        if seed is not None:
            self._started[self._to_reset(options)] = False
        return super().reset(seed=seed, options=options)

    def end(self, worlds: np.ndarray) -> None:
        """Let the curriculum judge episodes that are over."""
        for name, term in self.task.curriculum.items():
            self._difficulties[name] = float(term.function(self, worlds))

    def begin(self, worlds: np.ndarray) -> None:
        """Call the events of episodes that begin, and choose commands."""
        new = worlds[~self._started[worlds]]
        self._started[worlds] = True
        for when, which in (("start", new), ("reset", worlds)):
            for event in self.task.events.values():
                if event.when == when and len(which):
                    event.function(self, which)
        for clock in self._event_clocks.values():
            clock.start(worlds, self.random)
        for name, clock in self._command_clocks.items():
            self._command(name, worlds)
            clock.start(worlds, self.random)
        for array in (self.actions, self.last_actions, *self.reward_sums.values()):
            array[worlds] = 0.0
        self.observer.forget(worlds, self.random)
        self._late_actions.start(worlds, self.random)
        self._late_actions.fill(worlds, 0.0)

    def act(self, actions: np.ndarray) -> None:
        """Call what is due, then apply the actions."""
        for name, clock in self._event_clocks.items():
            due = clock.due(self.duration, self.random)
            if len(due):
                self.task.events[name].function(self, due)
        for name, clock in self._command_clocks.items():
            self._command(name, clock.due(self.duration, self.random))
        self.last_actions[...] = self.actions
        self.actions[...] = actions
        self._late_actions.push(self.actions)
        self.apply(self._late_actions.value)

    def _command(self, name: str, worlds: np.ndarray) -> None:
        if len(worlds):
            present = self.commands[name]
            new = self.task.commands[name].function(self, worlds)
            present[worlds] = shaped(new, (len(worlds), present.shape[1]), "command", name)

    def observe(self) -> Any:
        """The observations of all terms, side by side; or of each group, by its name."""
        return self.observer(self)

    def reward(self, actions: np.ndarray) -> Array:
        """The sum of all reward terms."""
        total, stepped = np.zeros(self.num_envs), self.episode_steps > 0
        for name, term in self.task.rewards.items():
            value = shaped(term.function(self), (self.num_envs,), "reward", name)
            share = np.where(stepped, value * (term.weight * self.duration), 0.0)
            self.reward_sums[name] += share
            total += share
        return total

    def terminated(self) -> Mask:
        """Which episodes have come to their end."""
        for name, term in self.task.terminations.items():
            self._ended[name][:] = shaped(term.function(self), (self.num_envs,), "termination", name)
            self._ended[name] &= self.episode_steps > 0
        return self._any_ended(time_out=False)

    def truncated(self) -> Mask:
        """Which episodes are cut off."""
        return self._any_ended(time_out=True)

    def _any_ended(self, *, time_out: bool) -> Mask:
        over = np.zeros(self.num_envs, dtype=bool)
        for name, term in self.task.terminations.items():
            if term.time_out == time_out:
                over |= self._ended[name]
        return over

    def infos(self) -> dict[str, Any]:
        """See `ManagerEnv`."""
        return {
            "rewards": {name: total.copy() for name, total in self.reward_sums.items()},
            "terminations": {name: mask.copy() for name, mask in self._ended.items()},
            "curriculum": dict(self._difficulties),
        }


def _box(size: int) -> gymnasium.spaces.Box:
    endless = np.full(size, np.inf, np.float32)
    return gymnasium.spaces.Box(-endless, endless)
