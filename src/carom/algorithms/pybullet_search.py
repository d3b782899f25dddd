"""Inverse kinematics exactly as PyBullet's `calculateInverseKinematics`, arrived at the targets or not."""

from __future__ import annotations

from collections.abc import Sequence
from struct import error as StructError
from typing import TYPE_CHECKING

from carom.algorithms.inverse_kinematics import (
    DEFAULT_DAMPING,
    DEFAULT_ITERATIONS,
    DEFAULT_THRESHOLD,
    MAX_ITERATIONS,
    Numbers,
    SearchTable,
    Solver,
)
from carom.native.kernels import pybullet_search_kernel
from carom.native.launch import Launch

if TYPE_CHECKING:
    from carom.scene.body import Body

Rests = tuple[Numbers, Numbers, Numbers, Numbers]


def pybullet_positions(
    body: Body,
    links: Sequence[int],
    positions: Sequence[Numbers],
    orientations: Sequence[Numbers] | None = None,
    *,
    rests: Rests | None = None,
    damping: Numbers | None = None,
    start: Numbers | None = None,
    in_base_frame: bool = False,
    iterations: int = DEFAULT_ITERATIONS,
    threshold: float = DEFAULT_THRESHOLD,
) -> tuple[float, ...]:
    """The joint positions that PyBullet answers, whose search may end far from the targets.

    `carom.algorithms.inverse_kinematics` goes on to the targets and keeps limits; this is for programs that
    were tuned to PyBullet's answers.

    Args:
        body: The body; its joints turn or slide.
        links: Indices of the links; -1 is the base.
        positions: Target positions of the origins of the link frames [m], world axes.
        orientations: Target orientations of the links' inertial frames, quaternions (x, y, z, w), of any
            length except 0.
        rests: Lower and upper limits, ranges and rest positions, one for each joint that moves [rad or m].
            They pull joints; the answer may be beyond the limits.
        damping: Damping of each joint, without `rests`; default 0.5.
        start: Joint positions to start from; default the present ones.
        in_base_frame: Targets are in the inertial frame of the base instead of the world's.
        iterations: Maximum number of steps, at most 100000.
        threshold: The step after all links are within this distance [m] is the last.

    Returns:
        The joint positions.

    Raises:
        ValueError: A sequence has the wrong length.
    """
    ends = tuple(links)
    follower: _Follower | None = body.derived.get((_Follower, ends))
    if follower is None:
        follower = body.derived[_Follower, ends] = _Follower(body, ends)
    try:
        follower.set_targets(positions, orientations)
        follower.set_base(None if in_base_frame else body)
        follower.set_start(body, start)
    except StructError as problem:
        raise ValueError(f"a sequence does not fit: {problem}") from None
    follower.set_damping(damping)
    if rests is not None:
        follower.set_rests(rests)
    counted = min(iterations, MAX_ITERATIONS)
    return follower.solve((orientations is not None, rests is not None, counted, threshold))


class _Follower(Solver):
    """PyBullet's search for one body and some of its links."""

    def _first_launch(self, table: SearchTable) -> Launch:
        return Launch(pybullet_search_kernel, 1, [*table.structs, 0, 0, 0, 0.0])

    def set_damping(self, damping: Numbers | None) -> None:
        """Set any damping, also 0 or less."""
        if damping is not None:
            self._damping[:] = damping
        elif self._has_damping:
            self._damping.fill(DEFAULT_DAMPING)
        self._has_damping = damping is not None

    def set_rests(self, rests: Rests) -> None:
        """Set limits, ranges and rest positions, also lower limits above the upper ones."""
        self._lower[:], self._upper[:], self._ranges[:], self._rest[:] = rests
