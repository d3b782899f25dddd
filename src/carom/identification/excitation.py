"""Trajectories that excite a robot, so that a log of its motion tells its parameters apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.identification.chosen_body import chosen_body
from carom.identification.torque_design import check_torques, torque_design
from carom.identification.unknowns import Unknowns

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

# Derivatives of torques by a coordinate: differences over this [rad or m, and their rates].
_CHANGE = 1e-6
# Directions in which a motion at random within the limits tells less than this of the best are none.
_UNDETERMINED = 1e-7
# Samples in a period of the highest frequency: for torques, and to find the extremes; states at random.
_SAMPLES, _FINE, _RANDOM = 12, 48, 300
# The least singular value and the greatest share of limits, smoothed: power means.
_POWER, _PEAKS = 4.0, 20
_FIRST, _LEAST, _GROWTH = 0.3, 1e-4, 1.5
_UNLIMITED = np.pi


@dataclass(frozen=True, eq=False, slots=True)
class ExcitingTrajectory:
    """A periodic motion of n joints: sums of sines, which begin and end each period at rest.

    Attributes:
        joints: Names of the joints, in the order of the columns.
        period: [s].
        centre: (n,) [rad or m].
        sines: Amplitudes of positions, (harmonics, n).
        cosines: Likewise.
        least: The least singular value of the derivatives of torques by the parameters, each multiplied by
            its size, over the square root of the number of rows; only combinations that some motion
            determines. Bounds of an identification are inversely proportional to it.
        condition: Ratio of the greatest to the least.
    """

    joints: tuple[str, ...]
    period: float
    centre: Array
    sines: Array
    cosines: Array
    least: float
    condition: float

    def at(self, time: ArrayLike) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations at times [s], each (n,) for one, else (N, n)."""
        waves = _waves(np.asarray(time, dtype=float), self.period, len(self.sines))
        amplitudes = np.concatenate([self.sines, self.cosines])
        place, velocity, acceleration = (part @ amplitudes for part in waves)
        return self.centre + place, velocity, acceleration

    def sampled(self, time_step: float, periods: float = 1.0) -> dict[str, Array]:
        """Rows at equal intervals: `time` (N,), `positions`, `velocities`, `accelerations`, (N, n) each.

        Args:
            time_step: Interval [s].
            periods: How long, in periods.

        Raises:
            ValueError: An interval or a length is not positive.
        """
        if not (time_step > 0.0 and periods > 0.0):
            raise ValueError(f"time_step and periods must be positive, not {time_step} and {periods}")
        time = time_step * np.arange(round(periods * self.period / time_step) + 1)
        places, velocities, accelerations = self.at(time)
        found = {"positions": places, "velocities": velocities, "accelerations": accelerations}
        return {"time": np.asarray(time, dtype=np.float64), **found}


def exciting_trajectory(
    world: World,
    parameters: Sequence[str],
    *,
    body: Body | str | None = None,
    period: float = 10.0,
    harmonics: int = 5,
    velocity: ArrayLike = 1.0,
    acceleration: ArrayLike = 4.0,
    share: float = 0.9,
    collides: bool = False,
    starts: int = 3,
    rounds: int = 60,
    seed: int = 0,
) -> ExcitingTrajectory:
    """Find a motion whose log would tell parameters apart: the greatest least singular value within limits.

    Positions are sums of sines (J. Swevers and others, Optimal robot excitation and identification, IEEE
    Transactions on Robotics and Automation 13, 1997), at rest at the beginning and end of each period. The
    search climbs along exact derivatives of a power mean of the singular values, from several starts at
    random; the best motion within all limits is returned. The world does not change.

    Args:
        world: The world with the robot, whose base is fixed and whose joints are hinges and sliders.
        parameters: What is to be identified, as for `carom.identify` by torques.
        body: The robot, or its name; by default the only body that can move.
        period: [s].
        harmonics: Number of frequencies: 1, 2, ... over the period; at least 3.
        velocity: Greatest velocities [rad/s or m/s], one number or (n,).
        acceleration: Greatest accelerations [rad/s² or m/s²], likewise.
        share: Of the range between the limits of a joint, how much is used; joints without limits turn half
            a circle to both sides.
        collides: Whether a motion may be returned in which the robot touches itself or another body.
        starts: How many searches.
        rounds: Steps of each.
        seed: Of the starts.

    Returns:
        The best motion that was found.

    Raises:
        ValueError: An argument is out of range, torques do not depend on a parameter, or all motions that
            were found collide.
    """
    if harmonics < 3 or starts < 1 or rounds < 0:
        raise ValueError("harmonics must be at least 3, starts at least 1, and rounds not negative")
    if not (period > 0.0 and 0.0 < share <= 1.0):
        raise ValueError("period must be positive, and share between 0 and 1")
    work = world.copy()
    own = work.bodies[chosen_body(world, body).id]
    if not own.fixed_base:
        raise ValueError(
            f"{own.name!r} has a free base: exciting motions are those of robots with a fixed one"
        )
    unknowns = Unknowns(work, own, parameters, [])
    check_torques(work, own, unknowns)
    limits = _Limits.of(own, velocity, acceleration, share)
    search = _Search(work, own, unknowns, limits, period, harmonics)
    rng = np.random.default_rng(seed)
    search.choose_combinations(rng)
    found = sorted((search.climbed(rng, rounds) for _ in range(starts)), key=search.least, reverse=True)
    touching = ""
    for amplitudes in found:
        trajectory = search.trajectory(amplitudes)
        touching = "" if collides else _touching(work, own, trajectory)
        if not touching:
            return trajectory
    raise ValueError(
        f"in each of the {starts} motions {touching}: give a smaller share, other seeds, more starts, or "
        "collides=True"
    )


@dataclass(frozen=True, slots=True)
class _Limits:
    """The middles of joints, how far, how fast and with what acceleration they move, (n,) each."""

    centre: Array
    room: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def of(cls, body: Body, velocity: ArrayLike, acceleration: ArrayLike, share: float) -> _Limits:
        joints = body.joints.movable
        centre, room = np.zeros(len(joints)), np.full(len(joints), share * _UNLIMITED)
        for number, joint in enumerate(joints):
            lower, upper = joint.limits
            if np.isfinite([lower, upper]).all() and lower < upper:
                centre[number], room[number] = 0.5 * (lower + upper), 0.5 * share * (upper - lower)
            else:
                centre[number] = joint.position
        bounds: list[Array] = []
        for name, value in (("velocity", velocity), ("acceleration", acceleration)):
            values = finite(value, name)
            if values.shape not in ((), (len(joints),)) or not (values > 0.0).all():
                raise ValueError(
                    f"{name} must be positive: one number, or one for each of {len(joints)} joints"
                )
            bounds.append(np.broadcast_to(values, (len(joints),)))
        return cls(centre, room, *bounds)


class _Search:
    """The search for amplitudes (2 harmonics, n) of one robot."""

    def __init__(
        self, world: World, body: Body, unknowns: Unknowns, limits: _Limits, period: float, harmonics: int
    ) -> None:
        self._limits, self._period = limits, period
        self._names: tuple[str, ...] = tuple(joint.name for joint in body.joints.movable)
        self._waves, self._fine = (
            _waves(np.linspace(0.0, period, count, endpoint=False), period, harmonics)
            for count in (_SAMPLES * harmonics, _FINE * harmonics)
        )
        # At t = 0 velocities and accelerations of a joint vanish: two linear conditions on its amplitudes.
        kept = np.array([wave[0] for wave in self._waves[1:]])
        self._at_rest: Array = np.eye(2 * harmonics) - np.linalg.pinv(kept) @ kept
        self._combinations: Array = np.eye(len(unknowns.scale))
        scale = unknowns.scale

        def design(motion: Sequence[Array]) -> Array:
            return torque_design(world, body, unknowns, *motion)[1] * scale

        self._design: Callable[[Sequence[Array]], Array] = design

    def choose_combinations(self, rng: np.random.Generator) -> None:
        """Find which combinations of parameters some motion determines."""
        it = self._limits
        rows = [
            middle + bound * rng.uniform(-1.0, 1.0, (_RANDOM, len(it.room)))
            for middle, bound in ((it.centre, it.room), (0.0, it.velocity), (0.0, it.acceleration))
        ]
        design = self._design(rows)
        _, sizes, directions = np.linalg.svd(design.reshape(-1, design.shape[-1]), full_matrices=False)
        if not sizes[0] > 0.0:
            raise ValueError("no motion of the joints depends on these parameters")
        self._combinations = directions[sizes > _UNDETERMINED * sizes[0]].T

    def climbed(self, rng: np.random.Generator, rounds: int) -> Array:
        """Amplitudes at the end of a search from some at random."""
        amplitudes = self._within(rng.normal(size=(len(self._at_rest), len(self._limits.room))))
        value, slope = self._value(amplitudes)
        step = _FIRST
        for _ in range(rounds):
            size = np.linalg.norm(slope * np.linalg.norm(amplitudes, axis=0))
            if step < _LEAST or not size > 0.0:
                break
            # Each joint has a scale of its own.
            ahead = self._within(amplitudes + step / size * (amplitudes**2).sum(axis=0) * slope)
            found, its_slope = self._value(ahead)
            if found > value:
                amplitudes, value, slope, step = ahead, found, its_slope, _GROWTH * step
            else:
                step *= 0.5
        return amplitudes

    def least(self, amplitudes: Array) -> float:
        """The least singular value of a motion."""
        return float(self._sizes(self._motion(amplitudes))[-1])

    def trajectory(self, amplitudes: Array) -> ExcitingTrajectory:
        """What users get."""
        sizes = self._sizes(self._motion(amplitudes))
        half = len(amplitudes) // 2
        return ExcitingTrajectory(
            self._names,
            self._period,
            self._limits.centre,
            amplitudes[:half],
            amplitudes[half:],
            float(sizes[-1]),
            float(sizes[0] / sizes[-1]) if sizes[-1] > 0.0 else np.inf,
        )

    def _motion(self, amplitudes: Array) -> list[Array]:
        place, velocity, acceleration = (wave @ amplitudes for wave in self._waves)
        return [self._limits.centre + place, velocity, acceleration]

    def _within(self, amplitudes: Array) -> Array:
        """The multiple for each joint that starts at rest and just keeps all limits."""
        still = self._at_rest @ amplitudes
        return still / np.max([np.abs(used).max(axis=0) for used in self._used(still)], axis=0)

    def _used(self, amplitudes: Array) -> list[Array]:
        """Shares of the limits of positions, velocities and accelerations, (samples, n) each."""
        it = self._limits
        return [
            wave @ amplitudes / bound
            for wave, bound in zip(self._fine, (it.room, it.velocity, it.acceleration), strict=True)
        ]

    def _growth(self, amplitudes: Array) -> Array:
        """Derivatives of the greatest share of each joint by its amplitudes, of motions that keep the limits.

        The greatest is a power mean, so that all peaks count that are nearly as high.
        """
        it = self._limits
        used = self._used(amplitudes)
        total = sum((share**_PEAKS).sum(axis=0) for share in used)
        parts = [
            wave.T @ (share ** (_PEAKS - 1) / bound)
            for wave, share, bound in zip(
                self._fine, used, (it.room, it.velocity, it.acceleration), strict=True
            )
        ]
        return self._at_rest @ np.sum(parts, axis=0) / total

    def _flat(self, design: Array) -> Array:
        return design.reshape(-1, design.shape[-1]) @ self._combinations / np.sqrt(len(design))

    def _sizes(self, motion: Sequence[Array]) -> Array:
        return np.asarray(np.linalg.svd(self._flat(self._design(motion)), compute_uv=False), dtype=np.float64)

    def _value(self, amplitudes: Array) -> tuple[float, Array]:
        """A smooth measure of the least singular value, and its derivatives by the amplitudes."""
        motion = self._motion(amplitudes)
        design = self._design(motion)
        left, sizes, right = np.linalg.svd(self._flat(design), full_matrices=False)
        if not sizes[-1] > 0.0:
            return -np.inf, np.zeros_like(amplitudes)
        powers = (sizes / sizes[-1]) ** -_POWER
        value = np.log(sizes[-1]) - np.log(powers.sum()) / _POWER
        by_design = (left * (powers / sizes / powers.sum())) @ right @ self._combinations.T
        by_design = by_design.reshape(design.shape) / np.sqrt(len(design))
        slope = np.zeros_like(amplitudes)
        for wave, part in zip(self._waves, motion, strict=True):
            for joint in range(part.shape[1]):
                kept = part[:, joint].copy()
                part[:, joint] = kept + _CHANGE
                change = (self._design(motion) - design) / _CHANGE
                part[:, joint] = kept
                slope[:, joint] += (by_design * change).sum(axis=(1, 2)) @ wave
        slope = self._at_rest @ slope
        # Limits bound how much a joint moves: only the shape of its motion is free.
        return float(value), slope - (slope * amplitudes).sum(axis=0) * self._growth(amplitudes)


def _waves(time: Array, period: float, harmonics: int) -> tuple[Array, Array, Array]:
    """Sines and cosines at times, and their first and second derivatives: (..., 2 harmonics) each."""
    rates: Array = np.linspace(1.0, harmonics, harmonics) * (2.0 * np.pi / period)
    angle = time[..., None] * rates
    sine, cosine = np.sin(angle), np.cos(angle)
    squares: Array = rates * rates
    return (
        np.concatenate([sine, cosine], axis=-1),
        np.concatenate([rates * cosine, -rates * sine], axis=-1),
        np.concatenate([-squares * sine, -squares * cosine], axis=-1),
    )


def _touching(world: World, body: Body, trajectory: ExcitingTrajectory) -> str:
    """What the robot touches first on its way; empty for nothing."""
    count = 20 * len(trajectory.sines)
    for place in trajectory.at(trajectory.period / count * np.arange(count))[0]:
        body.joints.reset(place)
        world.detect_collisions()
        for contact in world.contacts():
            if contact.distance <= 0.0 and (contact.a.body is body or contact.b.body is body):
                names = [f"{link.name!r} of {link.body.name!r}" for link in (contact.a, contact.b)]
                return " touches ".join(names)
    return ""
