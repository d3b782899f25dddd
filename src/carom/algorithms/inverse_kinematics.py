"""Inverse kinematics: joint positions for given poses of links."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import hypot, inf
from struct import Struct
from struct import error as StructError
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.algorithms.chain import BodyChain
from carom.algorithms.forward_kinematics import forward_kinematics
from carom.description.transform import compose, conjugate, multiplied
from carom.layouts.chain import DAMPED, NULL_SPACE, SELECTIVE, Search
from carom.layouts.codes import BASE_POSITIONS
from carom.native.gates import gated
from carom.native.kernels import inverse_kinematics_kernel
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, ArrayTable, numbers_of
from carom.native.trigonometry import atan2

if TYPE_CHECKING:
    from carom.scene.body import Body

DEFAULT_ITERATIONS = 20
DEFAULT_THRESHOLD = 1e-4
DEFAULT_DAMPING = 0.5
MIN_DAMPING = 1e-9
_NUMBER = np.dtype(NUMPY_REAL)
_NO_POSE = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), dtype=NUMPY_REAL).data
# The first of the kernel's arguments that change from call to call.
_FIRST_OPTION = 3
MAX_ITERATIONS = 100_000
"""Upper bound of iterations: more would not help, but take very long."""
Numbers = Sequence[float] | np.ndarray


class InverseKinematicsResult(NamedTuple):
    """What inverse kinematics found.

    Attributes:
        positions: The best joint positions found, in order; a quaternion (x, y, z, w) for each spherical
            joint.
        residual: Largest distance that is left between a link and its target [m].
        angle_residual: Largest angle that is left [rad]; 0 if no orientations were asked for.
        success: Whether no residual is above the threshold.
    """

    positions: tuple[float, ...]
    residual: float
    angle_residual: float
    success: bool


@gated("world.call_lock")
def inverse_kinematics(
    body: Body,
    links: Sequence[int | str],
    positions: Sequence[Numbers],
    orientations: Sequence[Numbers] | None = None,
    *,
    lower: Numbers | None = None,
    upper: Numbers | None = None,
    ranges: Numbers | None = None,
    rest: Numbers | None = None,
    damping: Numbers | None = None,
    selective: bool = False,
    start: Numbers | None = None,
    in_base_frame: bool = False,
    iterations: int = DEFAULT_ITERATIONS,
    further: int | None = None,
    threshold: float = DEFAULT_THRESHOLD,
    patience: float = 0.0,
) -> InverseKinematicsResult:
    """Joint positions at which links reach target poses.

    The search starts at the current pose and uses PyBullet's damped least squares, with the same result if
    that reaches the target. Otherwise, or if a limit is violated, up to `further` steps follow with a method
    that converges quadratically, stays within the limits, and restarts from nearby poses if it is stuck. The
    body itself does not move.

    Args:
        body: The body.
        links: The links by index (-1 is the base) or name.
        positions: Target positions of the origins of the link frames [m], world axes.
        orientations: Target orientations of the link frames, quaternions (x, y, z, w), of any length except
            0.
        lower: Lower limits of the result [rad or m], one for each degree of freedom of the joints. A joint
            whose lower limit is above the upper one has no limits.
        upper: Upper limits.
        ranges: Together with `lower`, `upper` and `rest`: ranges of the joints. The push of a joint back into
            its limits is divided by its range.
        rest: Preferred joint positions, approached as far as this does not move the links (null space).
        damping: Damping of each joint in the search, > 0; default 0.5.
        selective: Selectively damped least squares, without rest positions.
        start: Joint positions to start from, a quaternion for each spherical joint.
        in_base_frame: Targets are in the inertial frame of the base instead of the world's.
        iterations: Maximum number of steps of PyBullet's method.
        further: Maximum number of steps of the other method; by default the same, with limits at least 300.
        threshold: Tolerance of distances [m] and angles [rad].
        patience: The result of PyBullet's method is accepted if it is within the limits and leaves at most
            this share of the first distance, or 2 cm; with 0 only if it reaches the target.

    Returns:
        The joint positions, and what is left of the way to the targets.

    Raises:
        IndexError, KeyError: There is no such link.
        ValueError: A sequence has the wrong length.
    """
    numbers = [body.link_number(link) for link in links]
    if orientations is not None:
        frames = [body.link_inertial_frame(link).orientation for link in numbers]
        try:
            orientations = [
                multiplied((x, y, z, w), frame)
                for (x, y, z, w), frame in zip(orientations, frames, strict=True)
            ]
        except (TypeError, ValueError) as problem:
            raise ValueError(f"orientations must be a quaternion for each link: {problem}") from None
    found = find_positions(
        body,
        numbers,
        positions,
        orientations,
        lower=lower,
        upper=upper,
        ranges=ranges,
        rest=rest,
        damping=damping,
        selective=selective,
        start=start,
        in_base_frame=in_base_frame,
        iterations=iterations,
        further=further,
        threshold=threshold,
        patience=patience,
    )
    distance, angle = _residuals(body, found, numbers, positions, orientations, in_base_frame=in_base_frame)
    return InverseKinematicsResult(found, distance, angle, distance <= threshold and angle <= threshold)


def find_positions(
    body: Body,
    links: Sequence[int],
    positions: Sequence[Numbers],
    orientations: Sequence[Numbers] | None = None,
    *,
    lower: Numbers | None = None,
    upper: Numbers | None = None,
    ranges: Numbers | None = None,
    rest: Numbers | None = None,
    damping: Numbers | None = None,
    selective: bool = False,
    start: Numbers | None = None,
    in_base_frame: bool = False,
    iterations: int = DEFAULT_ITERATIONS,
    further: int | None = None,
    threshold: float = DEFAULT_THRESHOLD,
    patience: float = 0.0,
) -> tuple[float, ...]:
    """The joint positions of `inverse_kinematics` without residuals.

    The arguments are the same, but for links, by index, and orientations, of inertial frames as PyBullet's.
    """
    solver = _solver(body, tuple(links))
    try:
        solver.set_targets(positions, orientations)
        solver.set_base(None if in_base_frame else body)
        solver.set_start(body, start)
    except StructError as problem:
        raise ValueError(
            f"a sequence does not fit: {problem}; targets have 3 numbers for each link, quaternions 4, and "
            f"start has {sum(body.position_count)}: one for each coordinate of the movable joints of "
            f"{body.name!r}"
        ) from None
    solver.set_damping(damping)
    step = SELECTIVE if selective else DAMPED
    bounded = lower is not None and upper is not None
    solver.set_limits(lower, upper)
    if bounded and ranges is not None and rest is not None:
        step = NULL_SPACE
        solver.set_rest(ranges, rest)
    further = min(iterations if further is None else further, MAX_ITERATIONS)
    iterations = min(iterations, MAX_ITERATIONS)
    return solver.solve((orientations is not None, step, bounded, iterations, further, threshold, patience))


def _residuals(
    body: Body,
    found: tuple[float, ...],
    links: Sequence[int],
    positions: Sequence[Numbers],
    orientations: Sequence[Numbers] | None,
    *,
    in_base_frame: bool,
) -> tuple[float, float]:
    """Largest distance [m] and angle [rad] between links and their targets."""
    poses = forward_kinematics(body, found, links, in_base_frame=in_base_frame)
    distance = angle = 0.0
    for pose, target in zip(poses, positions, strict=True):
        distance = max(distance, hypot(*(float(a) - b for a, b in zip(target, pose.position, strict=True))))
    turns = () if orientations is None else orientations
    for link, frame, target in zip(links, poses, turns, strict=False):
        pose = compose(frame, body.link_inertial_frame(link))
        x, y, z, w = (float(number) for number in target)
        dx, dy, dz, dw = multiplied(conjugate(pose.orientation), (x, y, z, w))
        angle = max(angle, 2.0 * atan2(hypot(dx, dy, dz), abs(dw)))
    return distance, angle


class SearchTable:
    """The chain of a body to some of its links, and the arrays of a search.

    Attributes:
        chain: The chain.
        arrays: The arrays of `Search`, by name.
        structs: The arguments of kernels: sizes, chain and search.
    """

    def __init__(self, body: Body, links: tuple[int, ...]) -> None:
        self.chain = BodyChain(body, links)
        sizes = self.chain.sizes
        blocks = 2 * len(links)
        search = ArrayTable(Search)
        search.reserve(
            {
                "base": BASE_POSITIONS,
                "end": len(links),
                "dof": int(sizes.dofs),
                "coordinate": int(sizes.coordinates),
                "joint": int(sizes.joints),
                "column": int(sizes.columns),
                "block": blocks,
                "entry": blocks * int(sizes.columns),
                "square": blocks * blocks,
                "spectrum": 9 * blocks * blocks,
                "normal": int(sizes.columns) * (int(sizes.columns) + 1),
            }
        )
        self.arrays: dict[str, np.ndarray] = search.numpy
        self.structs: tuple[Any, Any, Any] = (sizes, self.chain.arrays.struct(), search.struct())


class Solver:
    """The search for one body and some of its links: arrays, and the kernel that works on them."""

    def __init__(self, body: Body, links: tuple[int, ...]) -> None:
        table = SearchTable(body, links)
        arrays, sizes = table.arrays, table.chain.sizes
        self._dofs = int(sizes.dofs)
        self._coordinates = int(sizes.coordinates)
        self._write_positions = _writers(arrays["end_given_position"][: len(links)])
        self._write_rotations = _writers(arrays["end_given_rotation"][: len(links)])
        self._base = arrays["base_pose"].data[:BASE_POSITIONS]
        self._start = arrays["coordinate_start"].data[: self._coordinates]
        self._write_start = _writers(arrays["coordinate_start"][None, : self._coordinates])[0]
        self._best = arrays["coordinate_best"].data.cast("B")
        self._unpack = Struct(f"{self._coordinates}{_NUMBER.char}").unpack_from
        self._damping, self._lower, self._upper, self._ranges, self._rest = (
            arrays[f"dof_{name}"][: self._dofs] for name in ("damping", "lower", "upper", "range", "rest")
        )
        self._damping.fill(DEFAULT_DAMPING)
        self._lower.fill(-inf)
        self._upper.fill(inf)
        self._has_damping = self._has_limits = False
        self._given_limits: tuple[Numbers, Numbers] | None = None
        self._given_rest: tuple[Numbers, Numbers] | None = None
        self._options: tuple[float, ...] = ()
        self._launch = self._first_launch(table)

    def _first_launch(self, table: SearchTable) -> Launch:
        return Launch(inverse_kinematics_kernel, 1, [*table.structs, 0, 0, 0, 0, 0, 0.0, 0.0])

    def set_targets(self, positions: Sequence[Numbers], orientations: Sequence[Numbers] | None) -> None:
        """Set the targets in the frame of `set_base`."""
        for write, position in zip(self._write_positions, positions, strict=True):
            write(*position)
        if orientations is not None:
            for write, orientation in zip(self._write_rotations, orientations, strict=True):
                write(*orientation)

    def set_base(self, body: Body | None) -> None:
        """Set the pose of the base; without a body, targets are in its frame."""
        if body is None:
            self._base[:] = _NO_POSE
        else:
            first = body.first_position
            self._base[:] = body.world.position_memory[first : first + BASE_POSITIONS]

    def set_start(self, body: Body, start: Numbers | None) -> None:
        """Set the positions to start from; without them, the present ones."""
        if start is None:
            first = body.first_position + BASE_POSITIONS
            self._start[:] = body.world.position_memory[first : first + self._coordinates]
        else:
            self._write_start(*start)

    def set_damping(self, damping: Numbers | None) -> None:
        """Set the damping of each dof, at least `MIN_DAMPING`."""
        if damping is not None:
            np.maximum(damping, MIN_DAMPING, out=self._damping)
        elif self._has_damping:
            self._damping.fill(DEFAULT_DAMPING)
        self._has_damping = damping is not None

    def set_limits(self, lower: Numbers | None, upper: Numbers | None) -> None:
        """Set limits; a lower one above the upper one is none."""
        if lower is not None and upper is not None:
            given = _unchanging(lower, upper)
            if given is None or given != self._given_limits:
                self._lower[:] = lower
                self._upper[:] = upper
                unlimited = self._lower > self._upper
                self._lower[unlimited] = -inf
                self._upper[unlimited] = inf
            self._given_limits = given
            self._has_limits = True
        elif self._has_limits:
            self._lower.fill(-inf)
            self._upper.fill(inf)
            self._given_limits = None
            self._has_limits = False

    def set_rest(self, ranges: Numbers, rest: Numbers) -> None:
        """Set ranges and rest positions."""
        given = _unchanging(ranges, rest)
        if given is None or given != self._given_rest:
            self._ranges[:] = ranges
            self._rest[:] = rest
            self._given_rest = given

    def solve(self, options: tuple[float, ...]) -> tuple[float, ...]:
        """The positions found; the options are arguments of the kernel."""
        if options != self._options:
            for index, value in enumerate(options, start=_FIRST_OPTION):
                self._launch.replace(index, value)
            self._options = options
        self._launch()
        return self._unpack(self._best)


def _writers(rows: np.ndarray) -> list[Callable[..., None]]:
    """Functions that write the numbers of each row."""
    memory = numbers_of(rows).cast("B")
    row = Struct(f"{rows.shape[1]}{_NUMBER.char}")
    return [partial(row.pack_into, memory, place * row.size) for place in range(len(rows))]


def _unchanging(first: Numbers, second: Numbers) -> tuple[Numbers, Numbers] | None:
    """Both as a pair to compare with those of later calls, if they are tuples, which cannot change."""
    return (first, second) if type(first) is type(second) is tuple else None


def _solver(body: Body, links: tuple[int, ...]) -> Solver:
    solver = body.derived.get((Solver, links))
    if solver is None:
        solver = body.derived[Solver, links] = Solver(body, links)
    return solver
