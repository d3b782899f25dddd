"""Carom's own search for the poses of `reach_cases`, which goes on where PyBullet's stops."""

from __future__ import annotations

from typing import Any

import numpy as np
from tests.algorithms.reach_cases import Arm, Reach, Way

import pybullet as p
from carom.algorithms.inverse_kinematics import find_positions
from pybullet._clients.clients import clients

_NAMES = {
    "lowerLimits": "lower",
    "upperLimits": "upper",
    "jointRanges": "ranges",
    "restPoses": "rest",
    "maxNumIterations": "iterations",
    "residualThreshold": "threshold",
}


class OwnReach(Reach):
    """A robot that is asked by the names of PyBullet's arguments, and answers with Carom's search."""

    def __init__(self, arm: Arm) -> None:
        super().__init__(p, arm)

    def find(self, target: Any, orientation: Any = None, **options: Any) -> tuple[float, ...]:
        """Joint positions for a target, from the present ones."""
        return find_positions(
            clients[self.client].world.bodies[self.body],
            [self.arm.link],
            [target],
            None if orientation is None else [orientation],
            **{_NAMES.get(name, name): value for name, value in options.items()},
        )

    def ask(self, way: Way, target: tuple[np.ndarray, np.ndarray]) -> tuple[float, ...]:
        self.place(self.home)
        options = dict(way.options)
        if way.limited:
            options |= {
                "lowerLimits": self.lower.tolist(),
                "upperLimits": self.upper.tolist(),
                "jointRanges": (self.upper - self.lower).tolist(),
                "restPoses": self.home.tolist(),
            }
        return self.find(target[0].tolist(), target[1].tolist() if way.oriented else None, **options)
