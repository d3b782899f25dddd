"""Residuals of predictions: measured positions and velocities less those of the simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.identification.least_squares import Normal
from carom.identification.load_channels import sensor_names, sensor_of
from carom.identification.measurements import Measurements
from carom.identification.smoothing import smoothed
from carom.identification.states import START_DEGREE, START_WINDOW, MeasuredStates
from carom.identification.unknowns import Unknowns
from carom.layouts.linearization import BASE_DOF
from carom.linearization.exact import step_derivatives
from carom.linearization.inputs import CONTROLS, INERTIAL, Input, chosen_inputs
from carom.linearization.sensor_motion import SensorMotion, has_jacobian
from carom.linearization.stepping import copy_of

if TYPE_CHECKING:
    from carom.linearization.tangent import TangentSpace
    from carom.scene.body import Body
    from carom.world.world import World


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
        ValueError: The time step is not that of the world, or the body has spherical or planar joints, or
            other bodies can move, or there are no such controls or sensors.
        NotImplementedError: A sensor has no exact derivatives, forces act on links, or the centre of a base
            is to be fitted.
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
        count = len(measured)
        least = 2 if self._fits_starts else 1
        if horizon <= least:
            raise ValueError(f"a window needs more than {least} rows, not {horizon}")
        self._windows = [slice(first, min(first + horizon, count)) for first in range(0, count, horizon)]
        self._windows = [it for it in self._windows if it.stop - it.start > least]
        self._states = states = MeasuredStates(body, unknowns.space, measured)
        self.channels: tuple[str, ...] = tuple(f"{name} position" for name in states.names)
        if states.count > len(states.names):
            self.channels += tuple(f"{name} velocity" for name in states.names)
        # Of turns of a base the targets are 0, and what is predicted are rotation vectors from there.
        self._targets = np.concatenate([_tangent(unknowns.space, states), states.velocities], axis=1)
        self._targets = self._targets[:, : states.count]
        self._sensors = [sensor_of(body, name, it) for name, it in measured.sensors.items()]
        for sensor, readings in zip(self._sensors, measured.sensors.values(), strict=True):
            if not has_jacobian(body, sensor):
                raise NotImplementedError(
                    f"what sensor {sensor.name!r} shows ({sensor.kind.value}) has no exact derivatives in "
                    'predictions: leave it out, or use residuals="torque" for forces and torques'
                )
            self.channels += tuple(sensor_names(sensor))
            self._targets = np.concatenate([self._targets, readings], axis=1)
        self._used = np.isfinite(self._targets)
        for window in self._windows:
            # What sensors show follows from a step.
            self._used[window.start, states.count :] = False
        self.deviations: Array = _roughness(self._targets, measured.time_step)
        self.cutoff: float | None = None
        rows = [window.start for window in self._windows]
        self._first_positions: Array = states.positions[rows]
        self._first_velocities: Array = states.velocities[rows]
        self._controls = chosen_inputs(world, unknowns.space, CONTROLS, list(measured.controls), "control")
        self._driven = [body.velocity_index[j] for j, moving in enumerate(body.velocity_count) if moving]
        self._predicted = np.full_like(self._targets, np.nan)

    def model(self, p: Array) -> Normal:
        """The cost at some values, and its derivatives; states at the starts of windows are eliminated."""
        self._unknowns.write(self._world, self._body, p)
        size, dofs = len(p), len(self._unknowns.space)
        states = 2 * dofs
        cost, gradient, matrix = 0.0, np.zeros(size), np.zeros((size, size))
        eliminated: list[tuple[Array, Array]] = []
        weight = 1.0 / self.deviations
        for number, window in enumerate(self._windows):
            found, by_p, by_start = self._predict(p, window, number)
            self._predicted[window] = np.nan_to_num(self._targets[window]) + found
            for array in (found, by_p, by_start):
                array[~self._used[window]] = 0.0
            residual = (found * weight).ravel()
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
        before = self._first_positions, self._first_velocities

        def follow(change: Array) -> None:
            self._first_positions, self._first_velocities = before
            if not change.any() or not eliminated:
                return
            moves = np.array([-offset - slope @ change for offset, slope in eliminated])
            self._first_positions = self._unknowns.space.moved(before[0], moves[:, :dofs])
            self._first_velocities = before[1] + moves[:, dofs:]

        return Normal(float(cost), gradient, matrix, follow)

    def _predict(self, p: Array, window: slice, number: int) -> tuple[Array, Array, Array]:
        """Errors of predictions in a window (rows, channels), by parameters and by the state at its start."""
        world, space, states = self._world, self._unknowns.space, self._states
        fitted = [it for it in self._unknowns.inputs if it is not None]
        inputs = [*self._controls, *fitted]
        copies, dofs = copy_of(world), len(space)
        state = copies.engine.arrays.state.numpy
        state["position"][0, : space.coordinates[0]] = self._first_positions[number]
        state["dof_velocity"][0, space.dofs] = self._first_velocities[number]
        width = 2 * dofs + len(space.activations)
        by_p, by_start = np.zeros((width, len(p))), np.eye(width, 2 * dofs)
        rows = window.stop - window.start
        channels = len(self.channels)
        found = (
            np.zeros((rows, channels)),
            np.zeros((rows, channels, len(p))),
            np.zeros((rows, channels, 2 * dofs)),
        )
        for row in range(rows):
            state, at = copies.engine.arrays.state.numpy, slice(window.start + row, window.start + row + 1)
            position, velocity = self._read_state(state)
            off = (
                space.difference(position, states.positions[at])[0],
                (velocity[0, space.dofs] - states.velocities[at][0]),
            )
            for whole, part in zip(found, (np.concatenate(off), by_p, by_start), strict=True):
                whole[row, : states.count] = part[: states.count]
            if row == rows - 1:
                break
            slopes = self._drive(state, p, window.start + row)
            motion = self._motion_at(position, velocity) if self._sensors else None
            found_step = step_derivatives(world, space, inputs, copies, 0.0, described=False)
            by_state, by_input = found_step.by_state[0], found_step.by_input[0]
            driven = np.zeros((width, len(p)))
            driven[:, : len(fitted)] = by_input[:, len(self._controls) :]
            for name, place in self._unknowns.delays.items():
                control = list(self._measured.controls).index(name)
                driven[:, place] = by_input[:, control] * slopes[control]
            earlier = by_p, by_start
            by_p, by_start = by_state @ by_p + driven, by_state @ by_start
            if motion is not None:
                self._write_state(*self._read_state(copies.engine.arrays.state.numpy))
                motion.finish()
                shown = [motion.shown(self._body.id, index) for index in self._indices]
                values, before, after = (np.concatenate(part) for part in zip(*shown, strict=True))
                found[0][row + 1, states.count :] = values - self._targets[at.stop, states.count :]
                for whole, early, late in zip(found[1:], earlier, (by_p, by_start), strict=True):
                    whole[row + 1, states.count :] = before @ early + after @ late
        return found

    def _motion_at(self, position: Array, velocity: Array) -> SensorMotion:
        """The motion of the scene before a step, for sensors."""
        self._write_state(position, velocity)
        return SensorMotion(self._world, self._unknowns.space)

    def _write_state(self, position: Array, velocity: Array) -> None:
        fields = self._world.arrays.state.numpy
        fields["position"][:1, : position.shape[1]] = position
        fields["dof_velocity"][:1, : velocity.shape[1]] = velocity

    def _read_state(self, fields: dict[str, Array]) -> tuple[Array, Array]:
        """Copies of the coordinates and velocities of one world, (1, n) each."""
        coordinates, rates = self._unknowns.space.coordinates[0], self._unknowns.space.rates[0]
        return fields["position"][:1, :coordinates].copy(), fields["dof_velocity"][:1, :rates].copy()

    @property
    def _indices(self) -> list[int]:
        """The numbers of the sensors in the body."""
        known = [it.name for it in self._body.spec.sensors]
        return [known.index(it.name) for it in self._sensors]

    def _drive(self, state: dict[str, Array], p: Array, row: int) -> list[float]:
        """Set torques and controls of a step; returns the derivatives of controls by their delays."""
        torques = self._measured.torques
        if torques is not None:
            state["dof_torque"][0, self._driven] = np.nan_to_num(torques[row])
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
        used = self._used[rows]
        residual = np.where(used, self._predicted[rows] - self._targets[rows], 0.0)
        states = 2 * len(self._unknowns.space) * len(self._windows) if self._fits_starts else 0
        spent = (len(p) + states) / len(self.channels)
        freedom = np.maximum(used.sum(axis=0) - spent, 1.0)
        self.deviations = np.maximum(np.sqrt((residual**2).sum(axis=0) / freedom), 1e-12)

    def spread(self, p: Array) -> None:
        """Nothing: noise of measurements is taken as independent."""

    def fit(self, p: Array) -> tuple[slice, Array, Array]:
        """Rows of the log, measured and predicted values of the channels."""
        return slice(0, self._windows[-1].stop), self._targets[: self._windows[-1].stop], self._predicted


def _roughness(values: Array, time_step: float) -> Array:
    """Deviations of values (N, channels) from smooth ones, as a first guess of their noise."""
    gaps = ~np.isfinite(values)
    filled = np.where(gaps, np.nan_to_num(values).mean(axis=0), values)
    size = min(START_WINDOW, (len(values) - 2) // 2)
    smooth = smoothed(filled, time_step, size, min(START_DEGREE, 2 * size))[0]
    rough = np.sqrt(((filled[size : len(values) - size] - smooth) ** 2).mean(axis=0))
    return np.maximum(rough, 1e-6 * np.maximum(np.ptp(filled, axis=0), 1e-6))


def _tangent(space: TangentSpace, states: MeasuredStates) -> Array:
    """Positions by the dofs, (N, dofs): 0 for the turns of a base."""
    rows, kinds, _ = space.firsts()
    found = np.where(rows >= 0, states.positions[:, rows], 0.0)
    for first in np.flatnonzero(kinds == BASE_DOF).tolist():
        base = space.bodies[0].first_position
        found[:, first : first + 3] = 0.0
        found[:, first + 3 : first + 6] = states.positions[:, base : base + 3]
    return found


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
    if any(count > 1 for count in body.velocity_count):
        raise ValueError(
            f"{body.name!r} has spherical or planar joints: predictions identify robots with hinges "
            "and sliders"
        )
    if any(it.any() for it in (measured.forces or {}).values()):
        raise NotImplementedError('predictions do not apply forces on links: use residuals="torque"')
    if any(it is not None and it.kind == INERTIAL and it.row == body.first_link for it in unknowns.inputs):
        raise NotImplementedError(
            'predictions do not move the centre of a base: fit its mass and inertia as "masses" and '
            '"inertias", or use residuals="torque"'
        )
    if unknowns.space.bodies != [body]:
        raise ValueError("other bodies of the world can move: give a world with the robot alone")
    step = world.parameters.time_step
    if abs(measured.time_step - step) > 0.02 * step:
        raise ValueError(f"the log's interval is {measured.time_step} s, the world's time step {step} s")
