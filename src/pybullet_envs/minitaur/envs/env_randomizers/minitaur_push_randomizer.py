"""Minitaurs that are pushed now and then."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import pybullet
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase

Range = tuple[float, float]
_HORIZONTAL: Range = (120.0, 240.0)
_VERTICAL: Range = (300.0, 500.0)


class MinitaurPushRandomizer(EnvRandomizerBase):
    """Pushes a link of the chassis of a `MinitaurGymEnv`, to some side and downward, for a few steps."""

    def __init__(
        self,
        perturbation_start_step: int = 100,
        perturbation_interval_steps: int = 200,
        perturbation_duration_steps: int = 10,
        horizontal_force_bound: Range | None = None,
        vertical_force_bound: Range | None = None,
    ) -> None:
        """Makes one.

        Args:
            perturbation_start_step: The step of the environment before which it does nothing.
            perturbation_interval_steps: From one push to the next.
            perturbation_duration_steps: Of a push.
            horizontal_force_bound: The least and the greatest force to a side [N]; 120 and 240 if not given.
            vertical_force_bound: The least and the greatest force downward [N]; 300 and 500 if not given.
        """
        self._start = perturbation_start_step
        self._interval = perturbation_interval_steps
        self._duration = perturbation_duration_steps
        self._horizontal = horizontal_force_bound or _HORIZONTAL
        self._vertical = vertical_force_bound or _VERTICAL
        self._link = -1
        self._force = (0.0, 0.0, 0.0)
        self._pushes = False

    def randomize_env(self, env: Any) -> None:
        """Ends the push of the last episode."""
        self._pushes = False

    def randomize_step(self, env: Any) -> None:
        """Draws the next push where it is time, and begins or ends it."""
        draw, links = env.np_random, env.minitaur.chassis_link_ids
        since = env.env_step_counter % self._interval
        if since == 0:
            self._link = links[draw.integers(len(links))]
            force, way = draw.uniform(*self._horizontal), draw.uniform(0, 2 * pi)
            self._force = (force * cos(way), force * sin(way), -draw.uniform(*self._vertical))
        self._pushes = since < self._duration and env.env_step_counter >= self._start

    def randomize_sub_step(self, env: Any, sub_step_index: int, num_sub_steps: int) -> None:
        """Pushes."""
        if self._pushes:
            body, origin = env.minitaur.quadruped, [0.0, 0.0, 0.0]
            env.pybullet_client.applyExternalForce(body, self._link, self._force, origin, pybullet.LINK_FRAME)
