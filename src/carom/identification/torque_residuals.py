"""Residuals of torques: linear in inertial parameters, friction, damping, armature and stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.algorithms.regressor import inertial_parameters, joint_torque_regressor
from carom.checks import Array
from carom.identification.least_squares import Normal
from carom.identification.measurements import Measurements
from carom.identification.smoothing import smoothed
from carom.identification.unknowns import SMALL_FRICTION, Unknowns
from carom.identification.writing import read_value
from carom.lazy_dataclasses import dataclass
from carom.linearization.inputs import INERTIAL, PARAMETERS, chosen_inputs

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_TERMS = ("armature", "damping", "stiffness", "joint_friction")


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A motion as steps relate it: positions, velocities, accelerations, torques, (m, n) each.

    Attributes:
        rows: Which rows of the measurements these are.
        window: Rows on each side that smoothing has mixed with each.
        positions: [rad or m].
        velocities: Before the step.
        accelerations: Mean ones of the step.
        torques: In the step.
    """

    rows: slice
    window: int
    positions: Array
    velocities: Array
    accelerations: Array
    torques: Array


def motion_of(measured: Measurements, window: int, degree: int) -> Motion:
    """The motion that was measured; what was not measured is found by smoothing positions."""
    if measured.torques is None:
        raise ValueError('the log has no torques: use residuals="prediction"')
    place, velocity, acceleration = smoothed(measured.positions, measured.time_step, window, degree)
    rows = slice(window, len(measured) - window)
    if measured.velocities is not None and measured.accelerations is not None:
        rows, window = slice(0, len(measured)), 0
        place, velocity, acceleration = measured.positions, measured.velocities, measured.accelerations
    elif measured.accelerations is not None:
        acceleration = measured.accelerations[rows]
    return Motion(rows, window, place, velocity, acceleration, measured.torques[rows])


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
        deviations: Standard deviations of the noise of each, (n,).

    Raises:
        ValueError: The body has a free base, spherical or planar joints, or air damps it; or something is to
            be fitted that torques do not depend on.
    """

    def __init__(self, world: World, body: Body, motion: Motion, unknowns: Unknowns, slow: float) -> None:
        _check(world, body, unknowns)
        self.channels: tuple[str, ...] = tuple(
            body.spec.links[j].joint_name for j, count in enumerate(body.velocity_count) if count
        )
        self._unknowns, self._motion = unknowns, motion
        h = world.parameters.substep_time
        after = motion.velocities + h * motion.accelerations
        terms = {
            "armature": motion.accelerations,
            "damping": motion.velocities if body.spec.is_held else after,
            "stiffness": motion.positions + h * after - _spring_rest(world, body),
            "joint_friction": np.sign(after),
        }
        count, joints = motion.positions.shape
        regressors = np.stack(
            [
                joint_torque_regressor(body, *row)
                for row in zip(motion.positions, motion.velocities, motion.accelerations, strict=True)
            ]
        )
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
        self._design = np.zeros((count, joints, len(unknowns.names)))
        for place, it in enumerate(unknowns.inputs):
            if it is None:
                continue
            if it.kind == INERTIAL:
                link = it.row - body.first_link
                self._design[:, :, place] = regressors[:, :, 10 * link + it.place[1]]
            else:
                self._design[:, it.row - first, place] = terms[it.kind][:, it.row - first]
        self._target = motion.torques - constant + self._design @ unknowns.start
        left_out = _turning(after[:, rubbing], slow, motion.window)
        self._used = np.isfinite(motion.torques) & ~left_out[:, None]
        if self._used.sum() <= len(unknowns.names):
            raise ValueError(
                f"only {self._used.sum()} torques are left where no joint with friction turns round: the log "
                "is too short, or `slow` or `window` too great"
            )
        self._factors: list[Array] = [
            np.asarray(np.linalg.qr(np.column_stack([self._design[own, j], self._target[own, j]]))[1])
            for j, own in enumerate(self._used.T)
        ]
        self.deviations: Array = np.ones(joints)

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
        for lag in range(2 * self._motion.window + 1):
            early, late = slice(0, count - lag), slice(lag, count)
            pairs = mask[early].T @ mask[late]
            covariance = residual[early].T @ residual[late] / (share * np.maximum(pairs, 1.0))
            later = np.einsum("ij,tjp->tip", covariance, weighted[late])
            part = weighted[early].reshape(-1, size).T @ later.reshape(-1, size)
            found += part if lag == 0 else part + part.T
        return found

    def fit(self, p: Array) -> tuple[slice, Array, Array]:
        """Rows of the log, measured and fitted torques."""
        predicted = self._motion.torques - self._target + self._design @ p
        return self._motion.rows, self._motion.torques, predicted


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


def _check(world: World, body: Body, unknowns: Unknowns) -> None:
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
