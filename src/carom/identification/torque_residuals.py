"""Residuals of torques: linear in inertial parameters, friction, damping, armature and stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.identification.butterworth import zero_phase
from carom.identification.least_squares import Normal
from carom.identification.load_channels import Channels, sensor_channels
from carom.identification.motion import Motion
from carom.identification.torque_design import check_torques, torque_design
from carom.identification.unknowns import Unknowns
from carom.linearization.inputs import INERTIAL

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

# So many rows are kept in a period of the cut-off.
_KEPT = 4.0
# Forces below this share of those of gravity and motion are rounding errors.
_NOTHING = 1e-9
# Torque and force on a free base come first.
_OF_BASE = 6


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
        channels: Names of the joints, before them those of torques and forces on a free base, along the axes
            of its inertial frame; after them those of sensors.
        deviations: Standard deviations of the residuals of each, (n,), after the filter.
        noise: Those before it: of the torques as they were measured.
        cutoff: That of the filter [Hz]; None for none.
        row_count: Number of rows of the log.

    Raises:
        ValueError: The body has spherical or planar joints, or air damps it; something is to be fitted that
            torques do not depend on; a sensor shows no forces; or data tell of nothing but ratios of masses.
    """

    def __init__(self, world: World, body: Body, motion: Motion, unknowns: Unknowns, slow: float) -> None:
        check_torques(world, body, unknowns)
        self._unknowns, self._motion = unknowns, motion
        self.row_count: int = motion.rows.stop + (motion.window if motion.cutoff is None else 0)
        constant, design, rubbing = torque_design(world, body, unknowns, *motion.states)
        after = motion.velocities + world.parameters.substep_time * motion.accelerations
        names = [body.spec.links[j].joint_name for j, count in enumerate(body.velocity_count) if count]
        channels = [Channels(names, motion.torques, constant - motion.applied(body), design)]
        if not body.fixed_base:
            channels[0].names[:0] = [f"base {kind}.{axis}" for kind in ("torque", "force") for axis in "xyz"]
        channels += sensor_channels(body, unknowns, motion)
        self.channels: tuple[str, ...] = tuple(name for it in channels for name in it.names)
        # What was measured: torques, and what sensors showed.
        self._measured: Array = np.concatenate([it.measured for it in channels], axis=1)
        self._design: Array = np.concatenate([it.design for it in channels], axis=1)
        constant = np.concatenate([it.constant for it in channels], axis=1)
        joints = len(self.channels)
        self._target = self._measured - constant + self._design @ unknowns.start
        _refuse_ratios(body, self._target, constant)
        pushed = any(it.any() for it in motion.forces.values())
        if not pushed and _fits_base(body, unknowns):
            # Noise of positions makes all masses of such rows look smaller, for then they fit better.
            self._measured[:, :_OF_BASE] = self._target[:, :_OF_BASE] = np.nan
        self._raw = self._design, self._target
        self._rows, self._lags = slice(None), 2 * motion.window
        if motion.cutoff is None:
            left_out = _turning(after[:, rubbing], slow, motion.window)
            self._used = np.isfinite(self._measured) & ~left_out[:, None]
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
        known = np.isfinite(self._measured)
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
        predicted = self._measured - target + design @ p
        return self._motion.rows, self._measured, predicted


def _turning(rates: Array, slow: float, window: int) -> NDArray[np.bool_]:
    """Rows near which some joint may stick or turns round, (m,).

    Friction jumps there, and so do accelerations, which smoothing spreads over its window, for all joints.
    """
    near = np.asarray(np.any(np.abs(rates) < slow, axis=1))
    near[1:] |= np.any(rates[1:] * rates[:-1] <= 0.0, axis=1)
    wide = np.convolve(near.astype(float), np.ones(2 * window + 1))
    return wide[window : window + len(near)] > 0.5


def _fits_base(body: Body, unknowns: Unknowns) -> bool:
    """Whether inertia of a free base is fitted."""
    rows = [it.row for it in unknowns.inputs if it is not None and it.kind == INERTIAL]
    return not body.fixed_base and body.first_link in rows


def _refuse_ratios(body: Body, target: Array, constant: Array) -> None:
    """Raise `ValueError` if no force is known: then all masses might as well be twice as great.

    Args:
        body: The body.
        target: What parameters have to explain, (m, channels).
        constant: What those of the world would explain, likewise.
    """
    known = np.isfinite(target)
    sizes = np.abs(np.where(known, target, 0.0)).max(initial=0.0)
    if known.any() and sizes <= _NOTHING * np.abs(np.where(known, constant, 0.0)).max(initial=0.0):
        raise ValueError(
            f"the log has no forces on {body.name!r}, so it tells ratios of masses and inertias only: add "
            "torques of joints, forces on links or a sensor of forces, or leave a link whose mass is known "
            "out of the parameters"
        )
