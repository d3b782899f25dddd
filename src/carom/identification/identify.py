"""Fitting parameters of a world to a log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.identification.chosen_body import chosen_body
from carom.identification.least_squares import Normal, minimise
from carom.identification.measurements import Measurements
from carom.identification.motion import motion_of
from carom.identification.prediction_residuals import PredictionResiduals
from carom.identification.reading import measurements_of
from carom.identification.result import IdentificationResult, result_of
from carom.identification.several_logs import SeveralLogs, times_of
from carom.identification.torque_residuals import TorqueResiduals
from carom.identification.unknowns import Unknowns

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_REWEIGHTINGS = 3
_SAME = 0.02


def identify(
    log: Any,
    world: World,
    parameters: Sequence[str],
    *,
    body: Body | str | None = None,
    controls: Mapping[str, ArrayLike] | None = None,
    residuals: str = "auto",
    cutoff: float | None = None,
    window: int | None = None,
    degree: int = 4,
    slow: float = 0.02,
    horizon: int = 120,
    starts: str = "fitted",
    prior: float = np.inf,
    confidence: float = 0.99,
) -> IdentificationResult:
    """Fit parameters of a robot to a log of its motion, by Gauss-Newton steps (Levenberg-Marquardt).

    The world does not change; `result.apply(world)` gives it the values. Derivatives are exact: of torques
    those of `joint_torque_regressor`, of predictions those of `World.linearize`, step by step.

    Inertial parameters remain those of some body of positive density. All ten of each link are fitted, though
    data never determine all; `result.combinations` are what they determine. The rest stays near the values
    of the world.

    Residuals are weighted by their noise, which is estimated from them for each joint. Bounds allow for what
    smoothing makes of it, and assume that it is small in positions that are smoothed.

    Args:
        log: What was measured: a path (a log of `STATE_LOGGING_GENERIC_ROBOT`, a `.csv` file with columns
            `time`, `JOINT.position`, `JOINT.velocity`, `JOINT.torque`, `.npz`, or `.mcap`, see `read_mcap`),
            arrays by name (`time`, `positions`, `velocities`, `accelerations`, `torques`, `controls`, those
            of a free base, `forces`, `sensors`; see `Measurements.of`), `Measurements`, or
            `World.log("position", "velocity")`; or a list of such logs, which are fitted
            together, each weighted by its own noise.
        world: The world with the robot, whose joints are hinges and sliders; its base may be free.
        parameters: Kinds, or full names: "inertial_parameters", or "ROBOT.LINK.inertial" of a link;
            "damping", "armature", "joint_friction", "stiffness"; for predictions also all others of
            `World.linearize`, and "delays" of controls [s], or "CONTROL.delay".
        body: The robot, or its name; by default the only body that can move.
        controls: Commands in each step, by the names of `World.linearize`, in addition to those of the log.
        residuals: "torque" for measured torques, forces on a free base, and sensors of forces, less those
            of the equations of motion; "prediction" for measured positions, velocities and other sensors less
            those of the simulator; "auto" is "torque" if the log has torques or forces, and no controls.
        cutoff: Cut-off of the filter for "torque" [Hz]: a Butterworth low pass of order 4, forwards and
            backwards, of positions before they are differentiated, and of both sides of the equations. None
            for one that is chosen from the spectra of the positions, above their motion and below their
            noise; `result.cutoff` says which.
        window: Instead of the filter, polynomials fitted to so many rows on each side; None for the filter.
            They keep faster motion, but need positions with very little noise.
        degree: Degree of these polynomials.
        slow: With `window`, rate below which a joint with friction may stick [rad/s or m/s]; torques near
            there are left out, for accelerations jump.
        horizon: Rows that are predicted from one state, for "prediction".
        starts: "fitted" if these states are to be fitted, too, or "measured": then a horizon of 2 is that of
            predictions of one step.
        prior: Standard deviations of the parameters about the world's values, relative to their sizes; with
            one, all parameters are determined.
        confidence: Probability that all bounds together hold.

    Returns:
        Values, bounds, what cannot be told apart, and what fits how well.

    Raises:
        ValueError: An argument has a value that it cannot have, the log does not fit the robot, there is no
            such parameter, or data do not determine anything.
        NotImplementedError: Steps of this world have no exact derivatives, centres of links cannot move, or
            predictions cannot have a sensor or forces that are in the log.
        OSError: The file cannot be read.
    """
    if residuals not in ("auto", "torque", "prediction"):
        raise ValueError(f"residuals must be 'auto', 'torque' or 'prediction', not {residuals!r}")
    if starts not in ("fitted", "measured"):
        raise ValueError(f"starts must be 'fitted' or 'measured', not {starts!r}")
    if not (prior > 0.0 and 0.0 < confidence < 1.0):
        raise ValueError("prior must be positive, and confidence between 0 and 1")
    work = world.copy()
    own = work.bodies[chosen_body(world, body).id]
    several = isinstance(log, (list, tuple))
    if several and controls is not None:
        raise ValueError("with several logs the controls belong into each of them")
    logs = [measurements_of(it, own, controls) for it in (log if several else [log])]
    if not logs:
        raise ValueError("there is no log in the list")
    names = list(logs[0].controls)
    for number, it in enumerate(logs):
        if sorted(it.controls) != sorted(names):
            raise ValueError(f"log {number} has the controls {sorted(it.controls)}, log 0 {sorted(names)}")
    unknowns = Unknowns(work, own, parameters, names)
    by_torques = residuals == "torque" or (
        residuals == "auto"
        and all(it.torques is not None or it.forces is not None for it in logs)
        and not names
    )

    def residuals_of(measured: Measurements) -> TorqueResiduals | PredictionResiduals:
        if by_torques:
            return TorqueResiduals(
                work, own, motion_of(measured, own, cutoff, window, degree), unknowns, slow
            )
        return PredictionResiduals(work, own, measured, unknowns, horizon, starts)

    parts = [residuals_of(it) for it in logs]
    problem = SeveralLogs(parts) if several else parts[0]
    p, normal = _solve(problem, unknowns, prior)
    at_bound = (p <= unknowns.lower) & (normal.gradient > 0.0)
    return result_of(unknowns, p, at_bound, normal.matrix, problem, times_of(logs), confidence)


def _solve(
    problem: TorqueResiduals | PredictionResiduals | SeveralLogs, unknowns: Unknowns, prior: float
) -> tuple[Array, Normal]:
    information = 0.0 if np.isinf(prior) else 1.0 / (prior * unknowns.scale) ** 2

    def model(p: Array) -> Normal:
        found = problem.model(p)
        away = p - unknowns.start
        return Normal(
            float(found.cost + 0.5 * np.sum(information * away**2)),
            found.gradient + information * away,
            found.matrix + np.diag(np.broadcast_to(information, len(p))),
            found.follow,
        )

    p = np.maximum(unknowns.start, unknowns.lower)
    for _ in range(_REWEIGHTINGS):
        p, normal = minimise(model, unknowns, p, drifts=bool(np.isinf(prior)))
        before = problem.deviations.copy()
        problem.reweight(p)
        if (np.abs(problem.deviations - before) <= _SAME * before).all():
            return p, normal
    return minimise(model, unknowns, p, drifts=bool(np.isinf(prior)))
