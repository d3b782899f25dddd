"""Residuals of predictions: measured positions and velocities less those of the simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.identification.least_squares import Normal
from carom.identification.measurements import Measurements
from carom.identification.smoothing import smoothed
from carom.identification.unknowns import Unknowns
from carom.linearization.exact import step_derivatives
from carom.linearization.inputs import CONTROLS, Input, chosen_inputs
from carom.linearization.stepping import copy_of

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_START_WINDOW, _START_DEGREE = 4, 2


class PredictionResiduals:
    """Errors of predictions over windows of some steps, each from a state of its own.

    The states at which windows start are eliminated: they are fitted together with the parameters.

    Args:
        world: A copy of the world, whose parameters change.
        body: The body there.
        measured: The measurements.
        unknowns: What is fitted.
        horizon: Rows of each window.
        starts: "fitted", or "measured" to start windows at measured states.

    Attributes:
        channels: Names of what is compared.
        deviations: Standard deviations of the noise of each.
        row_count: Number of rows of the log.

    Raises:
        ValueError: The time step is not that of the world, or the body has a free base, spherical or planar
            joints, or other bodies can move, or there are no such controls.
    """

    def __init__(
        self,
        world: World,
        body: Body,
        measured: Measurements,
        unknowns: Unknowns,
        horizon: int,
        starts: str,
    ) -> None:
        _check(world, body, measured, unknowns)
        self._world, self._body, self._measured, self._unknowns = world, body, measured, unknowns
        self._fits_starts = starts == "fitted"
        self.row_count: int = len(measured)
        count, joints = measured.positions.shape
        least = 2 if self._fits_starts else 1
        if horizon <= least:
            raise ValueError(f"a window needs more than {least} rows, not {horizon}")
        self._windows = [slice(first, min(first + horizon, count)) for first in range(0, count, horizon)]
        self._windows = [it for it in self._windows if it.stop - it.start > least]
        names = [body.spec.links[j].joint_name for j, moving in enumerate(body.velocity_count) if moving]
        self.channels: tuple[str, ...] = tuple(f"{name} position" for name in names)
        self._targets = measured.positions
        if measured.velocities is not None:
            self.channels += tuple(f"{name} velocity" for name in names)
            self._targets = np.concatenate([measured.positions, measured.velocities], axis=1)
        self.deviations: Array = _roughness(self._targets, measured.time_step)
        self.cutoff: float | None = None
        self._q = [body.position_index[j] for j, moving in enumerate(body.velocity_count) if moving]
        self._u = [body.velocity_index[j] for j, moving in enumerate(body.velocity_count) if moving]
        self._first_states = self._measured_states()
        self._controls = chosen_inputs(world, unknowns.space, CONTROLS, list(measured.controls), "control")
        self._joints = joints
        self._predicted = np.full_like(self._targets, np.nan)

    def _measured_states(self) -> Array:
        """Positions and velocities at the starts of windows, (windows, 2 n)."""
        measured = self._measured
        rows = [window.start for window in self._windows]
        velocity = measured.velocities
        if velocity is None:
            # Steps relate a velocity to the position before it.
            size = min(_START_WINDOW, (len(measured) - 2) // 2)
            inner = smoothed(measured.positions, measured.time_step, size, min(_START_DEGREE, 2 * size))[1]
            velocity = np.concatenate(
                [np.repeat(inner[:1], size, axis=0), inner, np.repeat(inner[-1:], size, axis=0)]
            )
        return np.concatenate([measured.positions[rows], velocity[rows]], axis=1)

    def model(self, p: Array) -> Normal:
        """The cost at some values, and its derivatives; states at the starts of windows are eliminated."""
        self._unknowns.write(self._world, self._body, p)
        size, states = len(p), 2 * self._joints
        cost, gradient, matrix = 0.0, np.zeros(size), np.zeros((size, size))
        eliminated: list[tuple[Array, Array]] = []
        weight = 1.0 / self.deviations
        for window, start in zip(self._windows, self._first_states, strict=True):
            predicted, by_p, by_start = self._predict(p, window, start)
            self._predicted[window] = predicted
            residual = ((predicted - self._targets[window]) * weight).ravel()
            by_p = (by_p * weight[:, None]).reshape(-1, size)
            cost += 0.5 * residual @ residual
            if not self._fits_starts:
                gradient += by_p.T @ residual
                matrix += by_p.T @ by_p
                continue
            by_start = (by_start * weight[:, None]).reshape(-1, states)
            # Projections keep the matrix positive where differences of products would not.
            basis, factor = np.linalg.qr(by_start)
            rest = by_p - basis @ (basis.T @ by_p)
            eliminated.append(
                (np.linalg.solve(factor, basis.T @ residual), np.linalg.solve(factor, basis.T @ by_p))
            )
            left = residual - basis @ (basis.T @ residual)
            gradient += rest.T @ left
            matrix += rest.T @ rest
        before = self._first_states.copy()

        def follow(change: Array) -> None:
            if not change.any():
                self._first_states = before.copy()
                return
            for number, (offset, slope) in enumerate(eliminated):
                self._first_states[number] = before[number] - offset - slope @ change

        return Normal(float(cost), gradient, matrix, follow)

    def _predict(self, p: Array, window: slice, start: Array) -> tuple[Array, Array, Array]:
        """Predictions in a window (rows, channels), by parameters and by the state at its start."""
        world, space, joints = self._world, self._unknowns.space, self._joints
        fitted = [it for it in self._unknowns.inputs if it is not None]
        inputs = [*self._controls, *fitted]
        copies = copy_of(world)
        state = copies.engine.arrays.state.numpy
        state["position"][0, self._q] = start[:joints]
        state["dof_velocity"][0, self._u] = start[joints:]
        width = 2 * len(space) + len(space.activations)
        by_p, by_start = np.zeros((width, len(p))), np.eye(width, 2 * joints)
        rows = window.stop - window.start
        channels = len(self.channels)
        found = (
            np.zeros((rows, channels)),
            np.zeros((rows, channels, len(p))),
            np.zeros((rows, channels, 2 * joints)),
        )
        for row in range(rows):
            state = copies.engine.arrays.state.numpy
            now = np.concatenate([state["position"][0, self._q], state["dof_velocity"][0, self._u]])
            for whole, part in zip(found, (now, by_p, by_start), strict=True):
                whole[row] = part[:channels]
            if row == rows - 1:
                break
            slopes = self._drive(state, p, window.start + row)
            found_step = step_derivatives(world, space, inputs, copies, 0.0)
            by_state, by_input = found_step.by_state[0], found_step.by_input[0]
            driven = np.zeros((width, len(p)))
            driven[:, : len(fitted)] = by_input[:, len(self._controls) :]
            for name, place in self._unknowns.delays.items():
                control = list(self._measured.controls).index(name)
                driven[:, place] = by_input[:, control] * slopes[control]
            by_p, by_start = by_state @ by_p + driven, by_state @ by_start
        return found

    def _drive(self, state: dict[str, Array], p: Array, row: int) -> list[float]:
        """Set torques and controls of a step; returns the derivatives of controls by their delays."""
        torques = self._measured.torques
        if torques is not None:
            state["dof_torque"][0, self._u] = np.nan_to_num(torques[row])
        slopes: list[float] = []
        for given, (name, values) in zip(self._controls, self._measured.controls.items(), strict=True):
            place = self._unknowns.delays.get(name)
            value, slope = _delayed(values, row, 0.0 if place is None else p[place], self._measured.time_step)
            _put(state, given, value)
            slopes.append(slope)
        return slopes

    @property
    def noise(self) -> Array:
        """Standard deviations of what was measured."""
        return self.deviations

    def reweight(self, p: Array) -> None:
        """Set the deviations by the residuals of the last model."""
        rows = np.concatenate([np.arange(it.start, it.stop) for it in self._windows])
        residual = self._predicted[rows] - self._targets[rows]
        spent = len(p) + (2 * self._joints * len(self._windows) if self._fits_starts else 0)
        freedom = max(len(rows) - spent / len(self.channels), 1.0)
        self.deviations = np.maximum(np.sqrt((residual**2).sum(axis=0) / freedom), 1e-12)

    def spread(self, p: Array) -> None:
        """Nothing: noise of measurements is taken as independent."""

    def fit(self, p: Array) -> tuple[slice, Array, Array]:
        """Rows of the log, measured and predicted values of the channels."""
        return slice(0, self._windows[-1].stop), self._targets[: self._windows[-1].stop], self._predicted


def _roughness(values: Array, time_step: float) -> Array:
    """Deviations of values (N, channels) from smooth ones, as a first guess of their noise."""
    size = min(_START_WINDOW, (len(values) - 2) // 2)
    smooth = smoothed(values, time_step, size, min(_START_DEGREE, 2 * size))[0]
    rough = np.sqrt(((values[size : len(values) - size] - smooth) ** 2).mean(axis=0))
    return np.maximum(rough, 1e-6 * np.maximum(np.ptp(values, axis=0), 1e-6))


def _put(state: dict[str, Array], given: Input, value: float) -> None:
    state[given.field][(0, *given.place)] = given.scale * value


def _delayed(values: Array, row: int, delay: float, time_step: float) -> tuple[float, float]:
    """A command as it was before a delay, between rows on a line, and its derivative by the delay.

    Before the first row it was as there.
    """
    back = delay / time_step
    whole = int(np.floor(back))
    late, early = values[max(row - whole, 0)], values[max(row - whole - 1, 0)]
    return float(late + (back - whole) * (early - late)), float((early - late) / time_step)


def _check(world: World, body: Body, measured: Measurements, unknowns: Unknowns) -> None:
    if not body.fixed_base or any(count > 1 for count in body.velocity_count):
        raise ValueError(
            f"{body.name!r} has a free base, spherical or planar joints: predictions identify fixed robots"
        )
    if unknowns.space.bodies != [body]:
        raise ValueError("other bodies of the world can move: give a world with the robot alone")
    step = world.parameters.time_step
    if abs(measured.time_step - step) > 0.02 * step:
        raise ValueError(f"the log's interval is {measured.time_step} s, the world's time step {step} s")
