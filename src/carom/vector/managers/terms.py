"""The terms of a task: named functions, and what is to be done with their results.

Functions get the environment, and compute for all worlds at once. The first axis of arrays is the world.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from carom.vector.delays import Delay
from carom.vector.managers.noises import Noise

_Term = TypeVar("_Term")


@dataclass(frozen=True)
class Observation:
    """A part of the observation: (value + noise) clipped, then times `scale`.

    Attributes:
        function: Its value, (num_envs,) or (num_envs, n), from the environment.
        scale: Factor, one or (n,).
        noise: Greatest amount of uniform noise, one or (n,), in the unit of the value; or a model of
            `carom.vector.managers.noises`.
        clip: Least and greatest value; None for no limits.
        history: Number of the latest values that are observed, the oldest first. At the start of an episode
            they all are the first one.
        delay: Number of environment steps by which they are late; or the least and the greatest number,
            between which each episode draws its own. At the start of an episode they are the first one.
    """

    function: Callable[[Any], ArrayLike]
    scale: ArrayLike = 1.0
    noise: ArrayLike | Noise = 0.0
    clip: tuple[float, float] | None = None
    history: int = 1
    delay: Delay = 0


@dataclass(frozen=True)
class ImageGroup:
    """A group of observations that is the images of a camera.

    Attributes:
        camera: The camera, mounted on a link of the world that is copied, or fixed in the world.
        kind: "colour": (height, width, 3) uint8. "depth": (height, width, 1) float32 [m], at most `farthest`.
        farthest: What depths are cut off at [m].
    """

    camera: Any
    kind: Literal["colour", "depth"] = "colour"
    farthest: float = 10.0


@dataclass(frozen=True)
class Reward:
    """A part of the reward: value times weight times the duration of a step.

    Attributes:
        function: Its value, (num_envs,), from the environment.
        weight: Factor [1/s].
    """

    function: Callable[[Any], ArrayLike]
    weight: float


@dataclass(frozen=True)
class Termination:
    """A reason for the end of an episode.

    Attributes:
        function: In which worlds it is over: booleans (num_envs,), from the environment.
        time_out: The episode is cut off (truncated), and has not come to its end (terminated).
    """

    function: Callable[[Any], ArrayLike]
    time_out: bool = False


@dataclass(frozen=True)
class Event:
    """Something that changes worlds, for example at random.

    Attributes:
        function: Changes worlds: called with the environment and their indices (n,). Random numbers have to
            be drawn from `env.random` for these worlds.
        when: "start": with the first episode, and with the first one after a new seed; what it changes has to
            be kept by resets, such as parameters. "reset": with each episode. "interval": again and again,
            before a step.
        seconds: Least and greatest simulated time between two intervals [s].
    """

    function: Callable[[Any, np.ndarray], None]
    when: Literal["start", "reset", "interval"] = "reset"
    seconds: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True)
class Command:
    """Something that the policy has to do: `env.commands[name]`, an array (num_envs, n).

    Attributes:
        function: New commands (k, n) for k worlds, from the environment and their indices (k,).
        seconds: Least and greatest simulated time until the next command of an episode [s].
    """

    function: Callable[[Any, np.ndarray], ArrayLike]
    seconds: tuple[float, float] = (np.inf, np.inf)


@dataclass(frozen=True)
class Curriculum:
    """A change of the difficulty between episodes.

    Attributes:
        function: Called with the environment and the indices (n,) of worlds whose episodes are over, while
            they are still as these have left them. What it returns, a number, is among the infos.
    """

    function: Callable[[Any, np.ndarray], float]


@dataclass(frozen=True)
class Task:
    """What an environment is about: terms by name.

    Terms are used in the order in which they are listed; observations are put side by side in this order.

    Attributes:
        observations: What is observed: terms; or groups of them by name, such as "policy" and "critic", whose
            observation is a dictionary. A group that is an `ImageGroup` has images.
        rewards: What is rewarded.
        terminations: When an episode is over.
        events: What changes worlds.
        commands: What the policy has to do.
        curriculum: How the difficulty changes.
        action_delay: Number of environment steps after which an action is applied; or the least and the
            greatest number, between which each episode draws its own. Until then an episode begins with
            actions of 0.
    """

    observations: Mapping[str, Observation] | Mapping[str, Mapping[str, Observation] | ImageGroup]
    rewards: Mapping[str, Reward]
    terminations: Mapping[str, Termination] = field(default_factory=dict)
    events: Mapping[str, Event] = field(default_factory=dict)
    commands: Mapping[str, Command] = field(default_factory=dict)
    curriculum: Mapping[str, Curriculum] = field(default_factory=dict)
    action_delay: Delay = 0


def shaped(value: ArrayLike, shape: tuple[int, ...], kind: str, name: str) -> np.ndarray:
    """What the function of a term returned, as an array of a shape.

    Raises:
        ValueError: It has another shape; the message names the term.
    """
    array = np.asarray(value)
    if array.shape != shape:
        raise ValueError(
            f"{kind} {name!r} returned an array of shape {array.shape}; it must have shape {shape}"
        )
    return array
