"""Residuals of torques: linear in inertial parameters, friction, damping, armature and stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.algorithms.regressor import inertial_parameters, joint_torque_regressors
from carom.checks import Array
from carom.identification.butterworth import zero_phase
from carom.identification.least_squares import Normal
from carom.identification.measurements import Measurements
from carom.identification.smoothing import chosen_cutoff, filtered, smoothed
from carom.identification.unknowns import SMALL_FRICTION, Unknowns
from carom.identification.writing import read_value
from carom.linearization.inputs import INERTIAL, PARAMETERS, chosen_inputs

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

# A filter has forgotten what was so many periods of its cut-off away; at most the sixth part of the rows
# at each end is left out for that.
_REACH, _ENDS = 2.0, 6
# So many rows are kept in a period of the cut-off.
_KEPT = 4.0
_TERMS = ("armature", "damping", "stiffness", "joint_friction")


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A motion as steps relate it: positions, velocities, accelerations, torques, (m, n) each.

    Attributes:
        rows: Which rows of the measurements these are.
        window: Rows on each side that smoothing has mixed with each.
        time_step: Interval between rows [s].
        cutoff: Cut-off of the filter that positions have passed [Hz], which torques and their terms are to
            pass as well; None for none.
        positions: [rad or m].
        velocities: Before the step.
        accelerations: Mean ones of the step.
        torques: In the step.
    """

    rows: slice
    window: int
    time_step: float
    cutoff: float | None
    positions: Array
    velocities: Array
    accelerations: Array
    torques: Array


def motion_of(measured: Measurements, cutoff: float | None, window: int | None, degree: int) -> Motion:
    """The motion that was measured; what was not measured is found by smoothing positions.

    Args:
        measured: The measurements.
        cutoff: That of the filter [Hz]; None for one that is chosen from the positions.
        window: Rows on each side of polynomials that smooth instead of the filter; None for the filter.
        degree: Their degree.

    Raises:
        ValueError: There are no torques, too few rows, or there is no such filter or polynomial.
    """
    if measured.torques is None:
        raise ValueError('the log has no torques: use residuals="prediction"')
    h, accelerations = measured.time_step, measured.accelerations
    if measured.velocities is not None and accelerations is not None:
        everything = measured.positions, measured.velocities, accelerations, measured.torques
        return Motion(slice(0, len(measured)), 0, h, None, *everything)
    if window is None:
        chosen = chosen_cutoff(measured.positions, h) if cutoff is None else cutoff
        place, velocity, acceleration = filtered(measured.positions, h, chosen)
        reach = min(round(_REACH / (chosen * h)), (len(measured) - 1) // _ENDS)
        rows = slice(0, len(measured))
        if accelerations is not None:
            acceleration = accelerations
        return Motion(rows, reach, h, chosen, place, velocity, acceleration, measured.torques)
    if cutoff is not None:
        raise ValueError("cutoff and window are two ways to smooth: choose one")
    place, velocity, acceleration = smoothed(measured.positions, h, window, degree)
    rows = slice(window, len(measured) - window)
    if accelerations is not None:
        acceleration = accelerations[rows]
    return Motion(rows, window, h, None, place, velocity, acceleration, measured.torques[rows])


class TorqueResiduals:
    """Measured torques less those of the equations of motion.

    Args:
        world: A copy of the world; gravity and what is not fitted are taken from there.
        body: The body there.
        motion: The motion.
        unknowns: What is fitted.
        slow: Rates below which a joint with friction may stick [rad/s or m/s]: rows near such ones are left
            out.

    Attributes:
        channels: Names of the joints.
        deviations: Standard deviations of the residuals of each, (n,), after the filter.
        noise: Those before it: of the torques as they were measured.
        cutoff: That of the filter [Hz]; None for none.
        row_count: Number of rows of the log.

    Raises:
        ValueError: The body has a free base, spherical or planar joints, or air damps it; or something is to
            be fitted that torques do not depend on.
    """

    def __init__(self, world: World, body: Body, motion: Motion, unknowns: Unknowns, slow: float) -> None:
        check_torques(world, body, unknowns)
        self.channels: tuple[str, ...] = tuple(
            body.spec.links[j].joint_name for j, count in enumerate(body.velocity_count) if count
        )
        self._unknowns, self._motion = unknowns, motion
        self.row_count: int = motion.rows.stop + (motion.window if motion.cutoff is None else 0)
        constant, self._design, rubbing = torque_design(
            world, body, unknowns, motion.positions, motion.velocities, motion.accelerations
        )
        joints = motion.positions.shape[1]
        after = motion.velocities + world.parameters.substep_time * motion.accelerations
        self._target = motion.torques - constant + self._design @ unknowns.start
        self._raw = self._design, self._target
        self._rows, self._lags = slice(None), 2 * motion.window
        if motion.cutoff is None:
            left_out = _turning(after[:, rubbing], slow, motion.window)
            self._used = np.isfinite(motion.torques) & ~left_out[:, None]
        else:
            self._filter(motion, motion.cutoff)
        if self._used.sum() <= len(unknowns.names):
            raise ValueError(
                f"only {self._used.sum()} torques are left: the log is too short, or turns round too often "
                "for `slow` and `window`"
            )
        self._factors: list[Array] = [
            np.asarray(np.linalg.qr(np.column_stack([self._design[own, j], self._target[own, j]]))[1])
            for j, own in enumerate(self._used.T)
        ]
        self.deviations: Array = np.ones(joints)
        self.noise: Array = np.ones(joints)
        self.cutoff: float | None = motion.cutoff

    def _filter(self, motion: Motion, cutoff: float) -> None:
        """Let torques and what multiplies the parameters pass the filter of the positions.

        The equations are linear in the parameters, so they hold between filtered sides as well; then it does
        not matter that the filter rounds off what jumps, such as friction. What is left has no frequencies
        above the cut-off, so few rows are kept.
        """
        known = np.isfinite(motion.torques)
        every = max(int(1.0 / (_KEPT * cutoff * motion.time_step)), 1)
        rows = slice(motion.window, len(known) - motion.window, every)
        target = np.where(known, self._target, 0.0)
        apart = np.cumsum(np.pad(~known, ((motion.window + 1, motion.window), (0, 0))), axis=0)
        gaps = apart[2 * motion.window + 1 :] - apart[: -2 * motion.window - 1]
        self._target = zero_phase(target, cutoff, motion.time_step)[rows]
        self._design = zero_phase(self._design, cutoff, motion.time_step)[rows]
        self._used = (gaps == 0)[rows]
        self._rows, self._lags = rows, -(-motion.window // every)

    def model(self, p: Array) -> Normal:
        """The cost at some values, and its derivatives; of triangular factors, which are small."""
        size = len(p)
        cost, gradient, matrix = 0.0, np.zeros(size), np.zeros((size, size))
        for factor, deviation in zip(self._factors, self.deviations, strict=True):
            residual = (factor[:, :-1] @ p - factor[:, -1]) / deviation
            jacobian = factor[:, :-1] / deviation
            cost += 0.5 * residual @ residual
            gradient += jacobian.T @ residual
            matrix += jacobian.T @ jacobian
        return Normal(float(cost), gradient, matrix, lambda _: None)

    def reweight(self, p: Array) -> None:
        """Set the deviations by the residuals at some values."""
        share = len(p) / max(len(self.channels), 1)
        for joint, factor in enumerate(self._factors):
            residual = factor[:, :-1] @ p - factor[:, -1]
            freedom = max(float(self._used[:, joint].sum()) - share, 1.0)
            self.deviations[joint] = max(np.sqrt(residual @ residual / freedom), 1e-9)
        design, target = self._raw
        residual = (target - design @ p)[self._rows]
        count = np.maximum(self._used.sum(axis=0) - share, 1.0)
        squares = np.where(self._used, residual**2, 0.0).sum(axis=0)
        self.noise = np.maximum(np.sqrt(squares / count), 1e-9)

    def spread(self, p: Array) -> Array:
        """Covariance of the gradient of the cost, (np, np), for noise as it is.

        Smoothing makes noise of accelerations that lasts for its window, in all joints at once. So
        covariances of the residuals of joints are estimated for all lags that a window has.
        """
        used = self._used[:, :, None]
        weighted = np.where(used, self._design, 0.0) / self.deviations[:, None]
        residual = np.where(self._used, self._target - self._design @ p, 0.0) / self.deviations
        count, size = len(residual), len(p)
        mask = self._used.astype(float)
        share = 1.0 - min(size / max(mask.sum(), 1.0), 0.5)
        found = np.zeros((size, size))
        for lag in range(min(self._lags, count - 1) + 1):
            early, late = slice(0, count - lag), slice(lag, count)
            pairs = mask[early].T @ mask[late]
            covariance = residual[early].T @ residual[late] / (share * np.maximum(pairs, 1.0))
            later = np.einsum("ij,tjp->tip", covariance, weighted[late])
            part = weighted[early].reshape(-1, size).T @ later.reshape(-1, size)
            found += part if lag == 0 else part + part.T
        return found

    def fit(self, p: Array) -> tuple[slice, Array, Array]:
        """Rows of the log, measured and fitted torques."""
        design, target = self._raw
        predicted = self._motion.torques - target + design @ p
        return self._motion.rows, self._motion.torques, predicted


def torque_design(
    world: World, body: Body, unknowns: Unknowns, positions: Array, velocities: Array, accelerations: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Torques (m, n) of a motion at the world's parameters, and their derivatives by what is fitted.

    Args:
        world: A copy of the world.
        body: The body there.
        unknowns: What is fitted, as many as np.
        positions: (m, n).
        velocities: Before each step, likewise.
        accelerations: Means over each step, likewise.

    Returns:
        Torques (m, n), their derivatives (m, n, np), and which joints have friction, (n,).
    """
    h = world.parameters.substep_time
    after = velocities + h * accelerations
    terms = {
        "armature": accelerations,
        "damping": velocities if body.spec.is_held else after,
        "stiffness": positions + h * after - _spring_rest(world, body),
        "joint_friction": np.sign(after),
    }
    count, joints = positions.shape
    regressors = joint_torque_regressors(body, positions, velocities, accelerations)
    constant = regressors @ inertial_parameters(body).ravel()
    first = unknowns.space.places[unknowns.space.bodies.index(body)][0]
    rubbing = np.zeros(joints, dtype=bool)
    for it in chosen_inputs(world, unknowns.space, PARAMETERS, _TERMS, "parameter"):
        joint = it.row - first
        if 0 <= joint < joints:
            value = read_value(world, it)
            constant[:, joint] += value * terms[it.kind][:, joint]
            rubbing[joint] |= it.kind == "joint_friction" and (
                it.name in unknowns.names or value > SMALL_FRICTION
            )
    design = np.zeros((count, joints, len(unknowns.names)))
    for place, it in enumerate(unknowns.inputs):
        if it is None:
            continue
        if it.kind == INERTIAL:
            link = it.row - body.first_link
            design[:, :, place] = regressors[:, :, 10 * link + it.place[1]]
        else:
            design[:, it.row - first, place] = terms[it.kind][:, it.row - first]
    return constant, design, rubbing


def _turning(rates: Array, slow: float, window: int) -> NDArray[np.bool_]:
    """Rows near which some joint may stick or turns round, (m,).

    Friction jumps there, and so do accelerations, which smoothing spreads over its window, for all joints.
    """
    near = np.asarray(np.any(np.abs(rates) < slow, axis=1))
    near[1:] |= np.any(rates[1:] * rates[:-1] <= 0.0, axis=1)
    wide = np.convolve(near.astype(float), np.ones(2 * window + 1))
    return wide[window : window + len(near)] > 0.5


def _spring_rest(world: World, body: Body) -> Array:
    rows = [body.position_index[j] for j, count in enumerate(body.velocity_count) if count]
    return world.arrays.model.numpy["position_spring"][0, rows]


def check_torques(world: World, body: Body, unknowns: Unknowns) -> None:
    """Raise `ValueError` unless torques of the body are linear in what is to be fitted."""
    if not body.fixed_base or any(count > 1 for count in body.velocity_count):
        raise ValueError(
            f"{body.name!r} has a free base, spherical or planar joints: torques identify fixed arms"
        )
    tree, model = body.rows.tree, world.arrays.model.numpy
    if model["tree_linear_damping"][0, tree] or model["tree_angular_damping"][0, tree]:
        raise ValueError(
            f"air damps {body.name!r}, as in PyBullet: torques are no linear functions of its inertia then; "
            "set linear_damping and angular_damping to 0 by change_dynamics"
        )
    for name, it in zip(unknowns.names, unknowns.inputs, strict=True):
        if it is None or it.kind not in (INERTIAL, *_TERMS):
            raise ValueError(f'{name!r} cannot be fitted to torques: use residuals="prediction"')
