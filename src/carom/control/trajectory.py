"""Reference trajectories from one joint position to another, all joints arriving together."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, positive


class Sample(NamedTuple):
    """Position, velocity and acceleration of a trajectory at one time or at several.

    Attributes:
        position: [rad or m], shape (*times, *joints).
        velocity: [rad/s or m/s], same shape.
        acceleration: [rad/s² or m/s²], same shape.
    """

    position: Array
    velocity: Array
    acceleration: Array


class QuinticTrajectory:
    """A fifth-order polynomial that starts and ends at rest, without a jump in acceleration.

    Example:
        >>> path = QuinticTrajectory(start=[0.0, 0.5], goal=[1.0, -0.5], duration=2.0)
        >>> path.sample(1.0).position
        array([0.5, 0. ])
    """

    def __init__(self, start: ArrayLike, goal: ArrayLike, duration: float) -> None:
        """Plan from `start` to `goal` [rad or m] in `duration` seconds.

        Raises:
            ValueError: Positions are not finite or differ in shape, or the duration is not positive.
        """
        self.start: Array
        self.goal: Array
        self.start, self.goal = _end_points(start, goal)
        self.duration: float = float(positive(duration, "duration"))

    def sample(self, time: ArrayLike) -> Sample:
        """Position, velocity and acceleration at `time` [s]; at rest before 0 and after `duration`."""
        s = np.clip(_times(time, self.start.ndim) / self.duration, 0.0, 1.0)
        distance = self.goal - self.start
        return Sample(
            self.start + distance * s**3 * (10.0 - 15.0 * s + 6.0 * s**2),
            distance * 30.0 * s**2 * (1.0 - s) ** 2 / self.duration,
            distance * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / self.duration**2,
        )


class TrapezoidalTrajectory:
    """Fastest rest-to-rest motion within velocity and acceleration limits: a trapezoidal velocity profile.

    All joints share one profile, which the tightest limits determine, so the path is a straight line
    in joint space. If the distance is too short to reach full speed, the profile is a triangle.

    Attributes:
        duration: Time from start to goal [s]; 0 if they are equal.
        ramp: Duration of the acceleration, and also of the deceleration [s].
    """

    def __init__(
        self, start: ArrayLike, goal: ArrayLike, max_velocity: ArrayLike, max_acceleration: ArrayLike
    ) -> None:
        """Plan from `start` to `goal` [rad or m].

        Args:
            start: First position.
            goal: Last position.
            max_velocity: Maximum speed of each joint [rad/s or m/s].
            max_acceleration: Maximum acceleration of each joint [rad/s² or m/s²].

        Raises:
            ValueError: Positions are not finite or differ in shape, or a bound is not positive.
        """
        self.start: Array
        self.goal: Array
        self.start, self.goal = _end_points(start, goal)
        velocity = positive(max_velocity, "max_velocity")
        acceleration = positive(max_acceleration, "max_acceleration")
        distance = np.abs(self.goal - self.start)
        # Reciprocals of the limits on the first and second derivative of the path parameter, which all joints
        # share; it is 0 at the start and 1 at the goal.
        slowest = float(np.max(distance / velocity, initial=0.0))
        laziest = float(np.max(distance / acceleration, initial=0.0))
        if min(slowest, laziest) < np.finfo(np.float64).tiny:
            self.ramp, self.duration, self._acceleration = 0.0, 0.0, 0.0
            return
        self.ramp: float = min(laziest / slowest, float(np.sqrt(laziest)))
        self._acceleration = 1.0 / laziest
        self.duration: float = self.ramp + laziest / self.ramp

    def sample(self, time: ArrayLike) -> Sample:
        """Position, velocity and acceleration at `time` [s]; at rest before 0 and after `duration`."""
        t = np.clip(_times(time, self.start.ndim), 0.0, self.duration)
        left = self.duration - t
        speeding_up, slowing_down = t < self.ramp, left < self.ramp
        rate = self._acceleration * self.ramp
        share = np.where(
            slowing_down,
            1.0 - 0.5 * self._acceleration * left**2,
            np.where(speeding_up, 0.5 * self._acceleration * t**2, rate * (t - 0.5 * self.ramp)),
        )
        share = np.where(left <= 0.0, 1.0, share)
        moving = (t > 0.0) & (left > 0.0)
        share_rate = np.minimum(self._acceleration * np.minimum(t, left), rate)
        share_acceleration = self._acceleration * moving * (speeding_up * 1.0 - slowing_down * 1.0)
        distance = self.goal - self.start
        return Sample(self.start + distance * share, distance * share_rate, distance * share_acceleration)


def _end_points(start: ArrayLike, goal: ArrayLike) -> tuple[Array, Array]:
    first, last = finite(start, "start"), finite(goal, "goal")
    if first.shape != last.shape:
        raise ValueError(f"start has shape {first.shape} but goal has shape {last.shape}")
    return first, last


def _times(time: ArrayLike, joint_axes: int) -> Array:
    """Times with as many trailing axes of length one as there are joint axes to broadcast against."""
    times = np.array(time, dtype=np.float64)
    if np.isnan(times).any():
        raise ValueError(f"time must not be NaN, but is {time!r}")
    return times.reshape(times.shape + (1,) * joint_axes)
