"""A measured motion as steps relate it, smoothed and differentiated where something was not measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.identification.base_motion import BaseMotion, base_motion, parabolas, without_jumps
from carom.identification.loads import States, joint_forces_of
from carom.identification.measurements import Measurements
from carom.identification.smoothing import chosen_cutoff, filtered, smoothed

if TYPE_CHECKING:
    from carom.scene.body import Body

# A filter has forgotten what was so many periods of its cut-off away; at most the sixth part of the rows
# at each end is left out for that.
_REACH, _ENDS = 2.0, 6


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A motion as steps relate it: positions (m, coordinates), velocities, accelerations, forces (m, dofs).

    Of a free base, its position and quaternion come before those of joints, its angular and linear velocity
    in the axes of its inertial frame, and torque and force on it, likewise.

    Attributes:
        rows: Which rows of the measurements these are.
        window: Rows on each side that smoothing has mixed with each.
        time_step: Interval between rows [s].
        cutoff: Cut-off of the filter that positions have passed [Hz], which torques and their terms are to
            pass as well; None for none.
        positions: [rad or m].
        velocities: Before the step.
        accelerations: Mean ones of the step.
        torques: In the step, those of joints by their drives; of a base, which has none, 0, or NaN if forces
            are unknown.
        forces: On links from outside in the step, by their index, -1 for the base, (m, 6) each.
        sensors: What sensors showed of the step, by their names, (m, dim) each.
    """

    rows: slice
    window: int
    time_step: float
    cutoff: float | None
    positions: Array
    velocities: Array
    accelerations: Array
    torques: Array
    forces: dict[int, Array]
    sensors: dict[str, Array]

    @property
    def states(self) -> States:
        """Positions, velocities and accelerations."""
        return States(self.positions, self.velocities, self.accelerations)

    def applied(self, body: Body) -> Array:
        """Generalized forces (m, dofs) of the forces on links."""
        return joint_forces_of(body, self.states, self.forces)


def motion_of(
    measured: Measurements, body: Body, cutoff: float | None, window: int | None, degree: int
) -> Motion:
    """The motion that was measured; what was not measured is found by smoothing positions.

    Args:
        measured: The measurements.
        body: The body.
        cutoff: That of the filter [Hz]; None for one that is chosen from the positions.
        window: Rows on each side of polynomials that smooth instead of the filter; None for the filter.
        degree: Their degree.

    Raises:
        ValueError: There is nothing that tells of forces, too few rows, there is no such filter or
            polynomial, poses of a free base are missing, or forces act on no link of the body.
    """
    if measured.torques is None and measured.forces is None and not measured.sensors:
        raise ValueError('the log has no torques: use residuals="prediction"')
    forces = {_link(body, name): wrenches for name, wrenches in (measured.forces or {}).items()}
    torques = measured.torques
    if torques is None:
        torques = np.full(measured.positions.shape, np.nan)
    # What a sensor shows of a step is in the row after that.
    late = {
        name: np.concatenate([it[1:], np.full_like(it[:1], np.nan)]) for name, it in measured.sensors.items()
    }
    h, accelerations = measured.time_step, measured.accelerations
    if not body.fixed_base:
        if window is not None:
            raise ValueError(f"{body.name!r} has a free base: choose a cutoff instead of a window")
        return _of_free_base(measured, body, cutoff, forces, torques, late)
    if measured.velocities is not None and accelerations is not None:
        everything = measured.positions, measured.velocities, accelerations, torques, forces, late
        return Motion(slice(0, len(measured)), 0, h, None, *everything)
    if window is None:
        chosen = chosen_cutoff(measured.positions, h) if cutoff is None else cutoff
        place, velocity, acceleration = filtered(measured.positions, h, chosen)
        rows = slice(0, len(measured))
        if accelerations is not None:
            acceleration = accelerations
        reach = _reach(measured, chosen)
        return Motion(rows, reach, h, chosen, place, velocity, acceleration, torques, forces, late)
    if cutoff is not None:
        raise ValueError("cutoff and window are two ways to smooth: choose one")
    place, velocity, acceleration = smoothed(measured.positions, h, window, degree)
    rows = slice(window, len(measured) - window)
    if accelerations is not None:
        acceleration = accelerations[rows]
    forces, late = {key: it[rows] for key, it in forces.items()}, {key: it[rows] for key, it in late.items()}
    return Motion(rows, window, h, None, place, velocity, acceleration, torques[rows], forces, late)


def _reach(measured: Measurements, cutoff: float) -> int:
    return min(round(_REACH / (cutoff * measured.time_step)), (len(measured) - 1) // _ENDS)


def _of_free_base(
    measured: Measurements,
    body: Body,
    cutoff: float | None,
    forces: dict[int, Array],
    torques: Array,
    sensors: dict[str, Array],
) -> Motion:
    places, turns = measured.base_positions, measured.base_orientations
    if places is None or turns is None:
        raise ValueError(
            f"{body.name!r} has a free base: the log needs base_positions and base_orientations, "
            "poses of its link frame"
        )
    h, turns = measured.time_step, without_jumps(turns)
    if cutoff is None:
        cutoff = chosen_cutoff(
            np.concatenate([places - parabolas(places), turns, measured.positions], axis=1), h
        )
    base: BaseMotion = base_motion(places, turns, body.link_inertial_frame(-1), h, cutoff)
    joints = filtered(measured.positions, h, cutoff)
    if measured.accelerations is not None:
        joints = (*joints[:2], measured.accelerations)
    place, rate, change = (np.concatenate(pair, axis=1) for pair in zip(base, joints, strict=True))
    on_base = np.full((len(torques), 6), np.nan if measured.forces is None else 0.0)
    known = np.concatenate([on_base, torques], axis=1)
    rows = slice(0, len(measured))
    return Motion(rows, _reach(measured, cutoff), h, cutoff, place, rate, change, known, forces, sensors)


def _link(body: Body, name: str) -> int:
    """The index of a link by name; the base is -1."""
    names = [body.spec.base.name, *(link.name for link in body.spec.links)]
    if name == "base" and name not in names:
        return -1
    if name not in names:
        raise ValueError(f"forces act on {name!r}, but {body.name!r} has the links {', '.join(names)}")
    return names.index(name) - 1
