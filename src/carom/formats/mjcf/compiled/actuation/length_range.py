"""The least and the greatest length that a tendon can have, by a search over the joints that move it.

MuJoCo pulls and pushes in a simulation until nothing moves any more. The search goes downhill and uphill,
from the reference and from elsewhere. Where all ways end alike the simulation ends there, too, but for how
far limits yield.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, inf

from carom.description.joint import BALL_TYPES, SLIDES
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.transform import compose
from carom.description.wrapping import wrapped
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint, FilePart
from carom.layouts.codes import PathKind
from carom.native.trigonometry import cos, sin

# Slides without limits that come this far go on for ever [m].
_FAR = 100.0
_FIRST_STEP, _LAST_STEP = 0.2, 1e-4
_GROWTH = 1.5
_LEAST_GAIN = 1e-8
_MAX_TRIES = 200
_MOST_JOINTS = 8
_DIFFERENCE = 1e-6
# How far from the reference other searches begin [rad or m], and how much of the way to it.
_AWAY, _MOST = 2.5, 0.7
# Ends that are so near to each other, per range, are one.
_ALIKE = 1e-4


def length_range(
    parts: Sequence[FilePart],
    bodies: Mapping[str, CompiledBody],
    above: Mapping[str, str],
    joints: Mapping[str, tuple[CompiledBody, CompiledJoint]],
) -> tuple[tuple[float, float] | None, bool]:
    """The range of lengths of a path by the limits of joints [m or rad], and whether it is the only one.

    There may be several where a length has several ends uphill or downhill; that next to the reference is
    given. It is None if the search cannot tell: for joints that are free or balls, for many joints, and
    where there is no end.

    Args:
        parts: The path, see `FilePart`.
        bodies: All bodies by name, without the world.
        above: Name of the body around each, by name; those in the world have none.
        joints: Body and joint of each hinge, slide and ball, by name.
    """
    path = _Path(parts, bodies, above, joints)
    if not path.is_known:
        return None, False
    starts = path.starts()
    ends = [[path.extreme(sign, start) for start in starts] for sign in (-1.0, 1.0)]
    (lower, *_), (upper, *_) = ends
    if lower is None or upper is None or not lower < upper:
        return None, False
    close = _ALIKE * (upper - lower)
    is_only = all(
        it is not None and abs(it - first) < close
        for first, others in ((lower, ends[0]), (upper, ends[1]))
        for it in others
    )
    return (lower, upper), is_only


def moment_arms(
    parts: Sequence[FilePart],
    bodies: Mapping[str, CompiledBody],
    above: Mapping[str, str],
    joints: Mapping[str, tuple[CompiledBody, CompiledJoint]],
) -> dict[str, float]:
    """Change of the length of a path at the reference per position of each joint [1 or m/rad].

    Arguments are those of `length_range`. Balls and free joints have none here.
    """
    return _Path(parts, bodies, above, joints).arms()


class _Path:
    """A path, the joints that move its parts, and the bounds of these."""

    def __init__(
        self,
        parts: Sequence[FilePart],
        bodies: Mapping[str, CompiledBody],
        above: Mapping[str, str],
        joints: Mapping[str, tuple[CompiledBody, CompiledJoint]],
    ) -> None:
        self._parts = parts
        self._ways: dict[str, list[CompiledBody]] = {}
        for part in parts:
            for name in (part.on, part.side_on) if part.kind is not PathKind.JOINT else ():
                way: list[CompiledBody] = []
                body = name
                while body in bodies:
                    way.insert(0, bodies[body])
                    body = above.get(body, "")
                if name:
                    self._ways[name] = way
        self._stated = {part.on: joints[part.on][1] for part in parts if part.kind is PathKind.JOINT}
        # What moves all parts alike changes no length.
        ways = list(self._ways.values())
        while ways and all(way and way[0] is ways[0][0] for way in ways):
            ways = [way[1:] for way in ways]
        moving = [body for way in ways for body in way]
        self._joints = [
            *{
                id(it): it for it in (*self._stated.values(), *(it for body in moving for it in body.joints))
            }.values()
        ]
        self._turning = [it for it in self._joints if it.joint.type not in BALL_TYPES]
        self.is_known: bool = 0 < len(self._joints) <= _MOST_JOINTS and not (
            any(body.is_free or body.is_mocap for body in moving)
            or any(it.joint.type in BALL_TYPES for it in self._joints)
        )
        limits = [it.joint.limit for it in self._joints]
        self._bounds = [(it.lower, it.upper) if it.lower < it.upper else (-inf, inf) for it in limits]

    def arms(self) -> dict[str, float]:
        """What `moment_arms` tells."""
        # Balls stay as they are, for which a position counts as any other.
        here = [it.reference for it in self._joints]
        found: dict[str, float] = {}
        for number, it in enumerate(self._joints):
            if it in self._turning:
                ahead, behind = list(here), list(here)
                ahead[number], behind[number] = here[number] + _DIFFERENCE, here[number] - _DIFFERENCE
                found[it.joint.name] = (self._length(ahead) - self._length(behind)) / (2.0 * _DIFFERENCE)
        return found

    def starts(self) -> list[list[float]]:
        """Where a search begins: the reference, and most of the way from it to the bounds."""
        here = self._within([it.reference for it in self._joints])
        ends = [
            (max(lower, it - _AWAY), min(upper, it + _AWAY))
            for it, (lower, upper) in zip(here, self._bounds, strict=True)
        ]
        sides = [[number % 2 for number in range(len(here))], [0] * len(here)]
        sides += [[1 - side for side in each] for each in sides]
        return [here] + [
            [it + _MOST * (bound[side] - it) for it, bound, side in zip(here, ends, each, strict=True)]
            for each in (sides if len(here) > 1 else sides[1::2])
        ]

    def extreme(self, sign: float, start: list[float]) -> float | None:
        """The greatest length uphill from a start, or by the sign the least one; None without an end."""
        at = list(start)
        best, step = sign * self._length(at), _FIRST_STEP
        for _ in range(_MAX_TRIES):
            for there in self._tries(at, sign, step):
                value = sign * self._length(there)
                if value > best + _LEAST_GAIN:
                    break
            else:
                if step < _LAST_STEP:
                    break
                step *= 0.5
                continue
            best, at, step = value, there, _GROWTH * step
            if max(map(abs, at)) > _FAR:
                return None
        return sign * best

    def _tries(self, at: list[float], sign: float, step: float) -> Iterator[list[float]]:
        """Positions a step away: uphill, and along each joint."""
        yield self._within(self._uphill(at, sign, step))
        for number in range(len(at)):
            for way in (step, -step):
                yield self._within([it + way * (number == place) for place, it in enumerate(at)])

    def _uphill(self, at: list[float], sign: float, step: float) -> list[float]:
        """A step along what of the slope does not lead out of the bounds."""
        slopes = []
        for number, (it, (lower, upper)) in enumerate(zip(at, self._bounds, strict=True)):
            ahead, behind = list(at), list(at)
            ahead[number], behind[number] = it + _DIFFERENCE, it - _DIFFERENCE
            slope = sign * (self._length(ahead) - self._length(behind))
            leads_out = (slope > 0.0 and it >= upper) or (slope < 0.0 and it <= lower)
            slopes.append(0.0 if leads_out else slope)
        size = hypot(*slopes) or 1.0
        return [it + step * slope / size for it, slope in zip(at, slopes, strict=True)]

    def _within(self, at: list[float]) -> list[float]:
        return [min(max(it, lower), upper) for it, (lower, upper) in zip(at, self._bounds, strict=True)]

    def _length(self, at: list[float]) -> float:
        """The length for positions of the joints; all others are at their references."""
        positions = {id(joint): it for joint, it in zip(self._joints, at, strict=True)}
        poses = {name: _pose(way, positions) for name, way in self._ways.items()}
        total, divisor = 0.0, 1.0
        last: Vector3 | None = None
        over: FilePart | None = None
        for part in self._parts:
            if part.kind is PathKind.JOINT:
                total += part.size * positions[id(self._stated[part.on])]
            elif part.kind is PathKind.PULLEY:
                divisor, last = part.size, None
            elif part.kind is PathKind.SITE:
                there = compose(poses[part.on], part.frame).position
                if last is not None:
                    total += _between(last, there, over, poses) / divisor
                last, over = there, None
            else:
                over = part
        return total


def _between(start: Vector3, end: Vector3, over: FilePart | None, poses: Mapping[str, Pose]) -> float:
    """The way between two points, around what is between them."""
    if over is not None:
        side = compose(poses[over.side_on], Pose(over.side)).position if over.side_on else None
        frame = compose(poses[over.on], over.frame)
        found = wrapped(over.kind, frame, over.size, start, end, side)
        if found is not None:
            return _apart(start, found.begin) + found.length + _apart(found.end, end)
    return _apart(start, end)


def _apart(a: Vector3, b: Vector3) -> float:
    return hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _pose(way: Sequence[CompiledBody], positions: Mapping[int, float]) -> Pose:
    """World pose of the last of some bodies, of which each is in the one before."""
    pose = IDENTITY
    for body in way:
        pose = compose(pose, body.pose)
        for joint in body.joints:
            by = positions.get(id(joint), joint.reference) - joint.reference
            x, y, z = joint.joint.axis
            if joint.joint.type in SLIDES:
                pose = compose(pose, Pose((by * x, by * y, by * z)))
                continue
            s, c = sin(0.5 * by), cos(0.5 * by)
            a, b, d = joint.anchor
            turn = Pose(joint.anchor, (s * x, s * y, s * z, c))
            pose = compose(compose(pose, turn), Pose((-a, -b, -d)))
    return pose
