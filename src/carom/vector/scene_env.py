"""`SceneEnv`: a vector environment from a robot file with actuators and sensors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np

from carom.checks import Array
from carom.scene.actuators.actuated_joint import control_range
from carom.vector.worlds_env import WorldsEnv
from carom.world.scene import Scene


class SceneEnv(WorldsEnv):
    """Base class of environments whose actions and observations are those of a robot file.

    An action is the controls of the actuators of the file in their order, within their control ranges; of a
    position servo without one, what the limits of its joint allow; otherwise from -1 to 1. Actions beyond are
    clipped.

    The observation is one array: of each body that can move, in order, the pose of its base's link frame
    (3 + 4) if it is free, the positions of its joints, the velocity of its base (3 + 3) if it is free, and
    the rates of its joints; then what the sensors show, in order. Units are those of `BodyBatch` and of
    the sensors.

    A subclass defines `reward`, and what else of `WorldsEnv` it needs.

    Attributes:
        observed: Names of the parts of the observation, `BODY/position` and `BODY/velocity` and names of
            sensors, with their places in it.

    Args:
        scene: What `World.load` has returned. Its options are those of the world if that was empty before, or
            after `Scene.apply_options`.
        num_envs: Number of environments.
        state: The states of bodies are part of the observation.
        sensors: Names of the sensors that are; None for all of them.
        keyframe: Name of the keyframe in which episodes begin; None for the present state of the world.
        **options: As for `WorldsEnv`.

    Raises:
        KeyError: The scene has no sensor or keyframe of a name.
        ValueError: There is nothing to act on or to observe.
    """

    def __init__(
        self,
        scene: Scene,
        num_envs: int = 1,
        *,
        state: bool = True,
        sensors: Sequence[str] | None = None,
        keyframe: str | None = None,
        **options: Any,
    ) -> None:
        actuators = list(scene.actuators.values())
        if not actuators:
            raise ValueError(f"{scene.source.name} has no actuators to act on")
        known = scene.sensors
        chosen = list(known) if sensors is None else list(sensors)
        for name in chosen:
            if name not in known:
                raise KeyError(
                    f"{scene.source.name} has no sensor {name!r}; it has {', '.join(known) or 'none'}"
                )
        if keyframe is not None and keyframe not in scene.keyframes:
            raise KeyError(f"{scene.source.name} has no keyframe {keyframe!r}")
        moving = (
            [body for body in scene.bodies if body.joints.movable or not body.fixed_base] if state else []
        )
        self.observed: dict[str, slice] = {}
        size = 0
        for body in moving:
            free = 0 if body.fixed_base else 1
            for what, count in (
                ("position", sum(body.position_count) + 7 * free),
                ("velocity", sum(body.velocity_count) + 6 * free),
            ):
                self.observed[f"{body.name}/{what}"] = slice(size, size + count)
                size += count
        for name in chosen:
            self.observed[name] = slice(size, size + known[name].dim)
            size += known[name].dim
        if size == 0:
            raise ValueError("there is nothing to observe: no state and no sensors")
        ranges = np.array([control_range(it.body, it.spec) for it in actuators], np.float32)
        endless = np.full(size, np.inf, np.float32)
        super().__init__(
            scene.world,
            num_envs,
            gymnasium.spaces.Box(-endless, endless),
            gymnasium.spaces.Box(ranges[:, 0], ranges[:, 1]),
            **options,
        )
        self._keyframe = keyframe
        self._bounds = ranges.T.astype(np.float64)
        self._moving = [(self.worlds[body], not body.fixed_base) for body in moving]
        self._sensors = [(self.worlds[known[name].body], known[name].index) for name in chosen]
        # Each body with actuators, the places of its controls in an action, and their numbers in the body.
        self._driven = [
            (
                self.worlds[body],
                [place for place, it in enumerate(actuators) if it.body is body],
                [it.index for it in actuators if it.body is body],
            )
            for body in dict.fromkeys(it.body for it in actuators)
        ]

    def begin(self, worlds: np.ndarray) -> None:
        """Reset the worlds to the keyframe, if there is one."""
        if self._keyframe is not None:
            self.worlds.reset(self._keyframe, worlds)

    def act(self, actions: np.ndarray) -> None:
        """Set the controls of the actuators."""
        held = np.clip(actions, *self._bounds)
        for batch, places, numbers in self._driven:
            batch.actuators.controls[:, numbers] = held[:, places]

    def observe(self) -> np.ndarray:
        """The states of the bodies and what the sensors show, (num_envs, size), single precision."""
        parts: list[Array] = []
        for batch, free in self._moving:
            parts += [*batch.pose] if free else []
            parts.append(batch.joints.positions)
            parts += [batch.base_velocities] if free else []
            parts.append(batch.joints.velocities)
        parts += [batch.sensors[number].read() for batch, number in self._sensors]
        whole = np.concatenate([part.reshape(self.num_envs, -1) for part in parts], axis=1)
        return whole.astype(np.float32)
