"""Randomizer that pushes a Minitaur at regular intervals."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import pybullet
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase

Range = tuple[float, float]
_HORIZONTAL: Range = (120.0, 240.0)
_VERTICAL: Range = (300.0, 500.0)


class MinitaurPushRandomizer(EnvRandomizerBase):
    """Pushes a random link of the chassis, in a random horizontal direction and downward, for some steps."""

    def __init__(
        self,
        perturbation_start_step: int = 100,
        perturbation_interval_steps: int = 200,
        perturbation_duration_steps: int = 10,
        horizontal_force_bound: Range | None = None,
        vertical_force_bound: Range | None = None,
    ) -> None:
        """Makes a randomizer.

        Args:
            perturbation_start_step: Environment step before which there are no pushes.
            perturbation_interval_steps: Number of environment steps from one push to the next.
            perturbation_duration_steps: Number of environment steps of a push.
            horizontal_force_bound: Minimum and maximum horizontal force [N]; by default 120 and 240.
            vertical_force_bound: Minimum and maximum downward force [N]; by default 300 and 500.
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
        """Ends a push of the previous episode."""
        self._pushes = False

    def randomize_step(self, env: Any) -> None:
        """Draws the next push when it is due, and begins or ends it."""
        draw, links = env.np_random, env.minitaur.chassis_link_ids
        since = env.env_step_counter % self._interval
        if since == 0:
            self._link = links[draw.integers(len(links))]
            force, way = draw.uniform(*self._horizontal), draw.uniform(0, 2 * pi)
            self._force = (force * cos(way), force * sin(way), -draw.uniform(*self._vertical))
        self._pushes = since < self._duration and env.env_step_counter >= self._start

    def randomize_sub_step(self, env: Any, sub_step_index: int, num_sub_steps: int) -> None:
        """Applies the force of the push."""
        if self._pushes:
            body, origin = env.minitaur.quadruped, [0.0, 0.0, 0.0]
            env.pybullet_client.applyExternalForce(body, self._link, self._force, origin, pybullet.LINK_FRAME)
