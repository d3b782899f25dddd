"""Measured states of a robot as coordinates and velocities of its world."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.identification.base_motion import inertial_poses, without_jumps
from carom.identification.measurements import Measurements
from carom.identification.smoothing import smoothed
from carom.layouts.codes import BASE_POSITIONS
from carom.linearization.turns import inverse, multiplied, vector_of

if TYPE_CHECKING:
    from carom.linearization.tangent import TangentSpace
    from carom.scene.body import Body

START_WINDOW, START_DEGREE = 4, 2


class MeasuredStates:
    """What was measured, in the coordinates of a world, and names of what was.

    Args:
        body: The body, the only one of its world that can move.
        space: The tangent space.
        measured: The measurements.

    Attributes:
        positions: Coordinates of the world, (N, coordinates).
        velocities: Those measured, or found from positions, by the dofs of the tangent space, (N, dofs).
        names: Of the dofs.
        count: How many numbers of the tangent space were measured: positions, or velocities as well.

    Raises:
        ValueError: Poses of a free base are missing.
    """

    def __init__(self, body: Body, space: TangentSpace, measured: Measurements) -> None:
        count = len(measured)
        q = [body.position_index[j] for j, moving in enumerate(body.velocity_count) if moving]
        self.positions: Array = np.repeat(
            body.world.arrays.state.numpy["position"][:1, : space.coordinates[0]], count, axis=0
        )
        self.positions[:, q] = measured.positions
        self.names: list[str] = [
            body.spec.links[j].joint_name for j, moving in enumerate(body.velocity_count) if moving
        ]
        rates, base = measured.velocities, measured.base_velocities
        known = rates is not None or not q
        joints = _rates(measured.positions, measured.time_step) if rates is None else rates
        if not body.fixed_base:
            self.names[:0] = [f"base {kind}.{axis}" for kind in ("turn", "shift") for axis in "xyz"]
            joints = np.concatenate([self._place_base(body, measured), joints], axis=1)
            known = known and base is not None
        self.velocities: Array = joints
        self.count: int = len(space) * (2 if known else 1)

    def _place_base(self, body: Body, measured: Measurements) -> Array:
        """Write poses of the base; returns its angular and linear velocities, (N, 6)."""
        places, turns, rates = measured.base_positions, measured.base_orientations, measured.base_velocities
        if places is None or turns is None:
            raise ValueError(
                f"{body.name!r} has a free base: the log needs base_positions and base_orientations, "
                "poses of its link frame"
            )
        poses = inertial_poses(places, without_jumps(turns), body.link_inertial_frame(-1))
        first = body.first_position
        self.positions[:, first : first + BASE_POSITIONS] = poses
        if rates is not None:
            return np.concatenate([rates[:, 3:], rates[:, :3]], axis=1)
        size = min(START_WINDOW, (len(poses) - 2) // 2)
        inner = multiplied(poses[2 * size :, 3:], inverse(poses[: -2 * size, 3:]))
        spins = vector_of(inner) / (2 * size * measured.time_step)
        return np.concatenate([_widened(spins, size), _rates(poses[:, :3], measured.time_step)], axis=1)


def _rates(positions: Array, time_step: float) -> Array:
    """Velocities (N, n) of positions, as steps relate them: to the position before."""
    size = min(START_WINDOW, (len(positions) - 2) // 2)
    return _widened(smoothed(positions, time_step, size, min(START_DEGREE, 2 * size))[1], size)


def _widened(inner: Array, size: int) -> Array:
    return np.concatenate([np.repeat(inner[:1], size, axis=0), inner, np.repeat(inner[-1:], size, axis=0)])
