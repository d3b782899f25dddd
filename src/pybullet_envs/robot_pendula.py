"""Carts with poles."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFBasedRobot

LARGEST_START = 0.1
"""Poles begin so far from upright at most [rad]."""

HANGING = 3.1415
"""Half a turn, to four digits as PyBullet has it [rad]."""


class InvertedPendulum(MJCFBasedRobot):
    """A pole on a cart that is pushed with up to 100 N.

    Observation: position and velocity of the cart, cosine, sine and rate of the pole's angle.

    Attributes:
        swingup: Whether the pole hangs at first.
        theta: Angle of the pole from upright [rad].
    """

    swingup = False
    push = 100.0

    def __init__(self) -> None:
        super().__init__("inverted_pendulum.xml", "cart", action_dim=1, obs_dim=5)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts the pole near upright, or half a turn from there."""
        self.slider, self.j1 = self.jdict["slider"], self.jdict["hinge"]
        offset = self.np_random.uniform(-LARGEST_START, LARGEST_START)
        self.j1.reset_current_position(offset + (HANGING if self.swingup else 0.0), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Pushes the cart."""
        self.slider.set_motor_torque(self.push * float(checked(a)[0]))

    def calc_state(self) -> np.ndarray:
        """What is observed now."""
        self.theta, rate = self.j1.current_position()
        return np.array([*self.slider.current_position(), cos(self.theta), sin(self.theta), rate], np.float32)


class InvertedPendulumSwingup(InvertedPendulum):
    """A pole that hangs at first."""

    swingup = True


class InvertedDoublePendulum(MJCFBasedRobot):
    """Two poles, one on the other, on a cart that is pushed with up to 200 N.

    Observation: position and velocity of the cart, where the upper pole is, and cosine, sine and rate of both
    angles.

    Attributes:
        pos_x: Where the middle of the upper pole is [m].
        pos_y: How high it is [m].
    """

    push = 200.0

    def __init__(self) -> None:
        super().__init__("inverted_double_pendulum.xml", "cart", action_dim=1, obs_dim=9)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts both poles near upright."""
        self.pole2, self.slider = self.parts["pole2"], self.jdict["slider"]
        self.j1, self.j2 = self.jdict["hinge"], self.jdict["hinge2"]
        offsets = self.np_random.uniform(-LARGEST_START, LARGEST_START, 2)
        for joint, offset in zip((self.j1, self.j2), offsets, strict=True):
            joint.reset_current_position(float(offset), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Pushes the cart."""
        self.slider.set_motor_torque(self.push * float(checked(a)[0]))

    def calc_state(self) -> np.ndarray:
        """What is observed now."""
        self.pos_x, _, self.pos_y = self.pole2.pose().xyz().tolist()
        angles = [joint.current_position() for joint in (self.j1, self.j2)]
        turns = [value for angle, rate in angles for value in (cos(angle), sin(angle), rate)]
        return np.array([*self.slider.current_position(), self.pos_x, *turns], np.float32)
