"""Robots that consist of a cart with poles."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFBasedRobot

LARGEST_START = 0.1
"""Largest initial angle of a pole from upright [rad]."""

HANGING = 3.1415
"""Half a turn, cut to four decimals as in PyBullet [rad]."""


class InvertedPendulum(MJCFBasedRobot):
    """A pole on a cart that is pushed with up to 100 N.

    Observation: position and velocity of the cart; cosine, sine and velocity of the pole's angle.

    Attributes:
        swingup: Whether episodes start with a hanging pole.
        theta: Angle of the pole from upright [rad].
    """

    swingup = False
    push = 100.0

    def __init__(self) -> None:
        super().__init__("inverted_pendulum.xml", "cart", action_dim=1, obs_dim=5)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Places the pole near upright or, for `swingup`, near hanging."""
        self.slider, self.j1 = self.jdict["slider"], self.jdict["hinge"]
        offset = self.np_random.uniform(-LARGEST_START, LARGEST_START)
        self.j1.reset_current_position(offset + (HANGING if self.swingup else 0.0), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Applies a force to the cart."""
        self.slider.set_motor_torque(self.push * float(checked(a)[0]))

    def calc_state(self) -> np.ndarray:
        """The present observation."""
        self.theta, rate = self.j1.current_position()
        return np.array([*self.slider.current_position(), cos(self.theta), sin(self.theta), rate], np.float32)


class InvertedPendulumSwingup(InvertedPendulum):
    """A pole that hangs at the start."""

    swingup = True


class InvertedDoublePendulum(MJCFBasedRobot):
    """Two poles, one on the other, on a cart that is pushed with up to 200 N.

    Observation: position and velocity of the cart, x of the upper pole's centre, and cosine, sine and
    velocity of both angles.

    Attributes:
        pos_x: Position of the upper pole's centre along x [m].
        pos_y: Height of the upper pole's centre [m].
    """

    push = 200.0

    def __init__(self) -> None:
        super().__init__("inverted_double_pendulum.xml", "cart", action_dim=1, obs_dim=9)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Places both poles near upright."""
        self.pole2, self.slider = self.parts["pole2"], self.jdict["slider"]
        self.j1, self.j2 = self.jdict["hinge"], self.jdict["hinge2"]
        offsets = self.np_random.uniform(-LARGEST_START, LARGEST_START, 2)
        for joint, offset in zip((self.j1, self.j2), offsets, strict=True):
            joint.reset_current_position(float(offset), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Applies a force to the cart."""
        self.slider.set_motor_torque(self.push * float(checked(a)[0]))

    def calc_state(self) -> np.ndarray:
        """The present observation."""
        self.pos_x, _, self.pos_y = self.pole2.pose().xyz().tolist()
        angles = [joint.current_position() for joint in (self.j1, self.j2)]
        turns = [value for angle, rate in angles for value in (cos(angle), sin(angle), rate)]
        return np.array([*self.slider.current_position(), self.pos_x, *turns], np.float32)
