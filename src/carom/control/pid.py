"""A PID controller for one value or for an array of them."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, not_negative, positive

Limits = tuple[ArrayLike, ArrayLike]

UNLIMITED: Limits = (-np.inf, np.inf)


class PID:
    """Proportional, integral and derivative control with anti-windup, in discrete time.

    With error `e = setpoint - measurement`, every `update` computes

        output = clip(kp·e + I + D + feed_forward, output_limits)

    *I*, the integral term, holds `∫ ki·e dt` in units of the output, so a change of `ki` while
    running does not make the output jump. It is kept from winding up in two ways:

    - it never leaves `integral_limits`;
    - while the output is saturated, either *conditional integration* is used (the default: an
      element whose error would push its output further past the limit is not integrated) or, with
      a `tracking_time`, *back-calculation* (the excess over the limit is subtracted from the
      integral with that time constant).

    *D*, the derivative term, is `kd·de/dt`, or `-kd·d(measurement)/dt` which has no kick when the
    setpoint steps, behind a first-order low-pass of time constant `derivative_filter`. It is zero
    at the first update after a reset, when there is nothing to differentiate yet.

    Gains may be changed at any time. All gains, limits and signals broadcast against each other as
    NumPy arrays do: one controller can drive all joints of a robot. Scalars in, scalar out.

    Example:
        >>> pid = PID(kp=40.0, ki=10.0, kd=4.0, output_limits=(-20.0, 20.0))
        >>> torque = pid.update(setpoint=1.0, measurement=0.9, dt=1 / 240)
    """

    def __init__(
        self,
        kp: ArrayLike,
        ki: ArrayLike = 0.0,
        kd: ArrayLike = 0.0,
        *,
        output_limits: Limits = UNLIMITED,
        integral_limits: Limits = UNLIMITED,
        derivative_on: Literal["measurement", "error"] = "measurement",
        derivative_filter: float = 0.0,
        tracking_time: float | None = None,
    ) -> None:
        """Make a controller in its reset state.

        Args:
            kp: Proportional gain.
            ki: Integral gain.
            kd: Derivative gain.
            output_limits: Minimum and maximum output; each a scalar or an array.
            integral_limits: Minimum and maximum integral term, in units of the output.
            derivative_on: Differentiate the measurement (no kick on setpoint steps) or the error.
            derivative_filter: Time constant of the low-pass on the derivative [s]; 0 is no filter.
            tracking_time: Time constant of back-calculation [s]; None integrates conditionally.

        Raises:
            ValueError: A gain is not finite, a limit is NaN or its pair out of order, a time
                constant is negative, or `derivative_on` is unknown.
        """
        self.kp = kp
        self.ki = ki
        self.kd = kd
        self._output_limits = _ordered(output_limits, "output_limits")
        self._integral_limits = _ordered(integral_limits, "integral_limits")
        if derivative_on not in ("measurement", "error"):
            raise ValueError(f"derivative_on must be 'measurement' or 'error', not {derivative_on!r}")
        not_negative(finite(derivative_filter, "derivative_filter"), "derivative_filter")
        if tracking_time is not None:
            positive(tracking_time, "tracking_time")
        self._derivative_sign = 1.0 if derivative_on == "error" else -1.0
        self._derivative_filter = derivative_filter
        self._tracking_time = tracking_time
        self.reset()

    @property
    def kp(self) -> Array:
        """Proportional gain [output / error]."""
        return self._kp

    @kp.setter
    def kp(self, gain: ArrayLike) -> None:
        self._kp = finite(gain, "kp")

    @property
    def ki(self) -> Array:
        """Integral gain [output / (error s)]."""
        return self._ki

    @ki.setter
    def ki(self, gain: ArrayLike) -> None:
        self._ki = finite(gain, "ki")

    @property
    def kd(self) -> Array:
        """Derivative gain [output s / error]."""
        return self._kd

    @kd.setter
    def kd(self, gain: ArrayLike) -> None:
        self._kd = finite(gain, "kd")

    @property
    def integral(self) -> Array:
        """The integral term, in units of the output."""
        return self._integral

    def reset(self, integral: ArrayLike = 0.0) -> None:
        """Clear the state, and set the integral term to `integral`, clipped to its limits."""
        self._integral = np.clip(finite(integral, "integral"), *self._integral_limits)
        self._previous: Array | None = None
        self._derivative = np.float64(0.0)

    def preload(
        self, output: ArrayLike, setpoint: ArrayLike, measurement: ArrayLike, feed_forward: ArrayLike = 0.0
    ) -> None:
        """Take over from `output` without a jump (bumpless transfer from manual control).

        Resets, then sets the integral term, within `integral_limits`, so that the next update with the
        same signals returns `output` plus the integration step of that update.
        """
        error = finite(setpoint, "setpoint") - finite(measurement, "measurement")
        rest = finite(output, "output") - self._kp * error - finite(feed_forward, "feed_forward")
        self.reset(rest)

    def update(
        self, setpoint: ArrayLike, measurement: ArrayLike, dt: float, feed_forward: ArrayLike = 0.0
    ) -> Any:
        """Advance by one sample and return the output.

        Args:
            setpoint: Desired value of the measurement.
            measurement: Measured value.
            dt: Time since the last update [s].
            feed_forward: Added to the output before it is limited, a gravity torque for example.

        Returns:
            The output, within `output_limits`: an array in the broadcast shape of gains and signals, or
            a float if all of them are scalars.

        Raises:
            ValueError: `dt` is not positive or a signal is not finite; the state is unchanged.
        """
        positive(dt, "dt")
        measurement = finite(measurement, "measurement")
        error = finite(setpoint, "setpoint") - measurement
        feed_forward = finite(feed_forward, "feed_forward")

        differentiated = error if self._derivative_sign > 0.0 else measurement
        if self._previous is not None:
            rate = self._derivative_sign * (differentiated - self._previous) / dt
            # Backward Euler of the low-pass: stable for any dt, and no filter at all for time constant 0.
            self._derivative = self._derivative + (rate - self._derivative) * dt / (
                self._derivative_filter + dt
            )
        self._previous = differentiated

        rest = self._kp * error + self._kd * self._derivative + feed_forward
        self._integral = self._integrate(error, rest, dt)
        return np.clip(rest + self._integral, *self._output_limits)[()]

    def _integrate(self, error: Array, rest: Array, dt: float) -> Array:
        """The next integral term; `rest` is the output without it."""
        step = self._ki * error * dt
        integral = np.clip(self._integral + step, *self._integral_limits)
        excess = rest + integral - np.clip(rest + integral, *self._output_limits)
        if self._tracking_time is None:
            return np.where(excess * step > 0.0, self._integral, integral)
        bled_off = integral - excess * min(1.0, dt / self._tracking_time)
        return np.clip(bled_off, *self._integral_limits)


def _ordered(limits: Limits, name: str) -> tuple[Array, Array]:
    lower, upper = (np.array(limit, dtype=np.float64) for limit in limits)
    if not (lower <= upper).all():
        raise ValueError(f"{name} must be (lower, upper) with lower <= upper, not {limits!r}")
    return lower, upper
