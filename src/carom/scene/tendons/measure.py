"""Length, velocity and force of tendons."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, sqrt
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.actuator import Wrench
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.tendon import WORLD, PathPart
from carom.description.transform import compose, inverse, rotate
from carom.description.wrapping import wrapped
from carom.layouts.codes import PathKind
from carom.native.trigonometry import atan2
from carom.scene.named_constraints.named_constraint import forces_of
from carom.scene.sensors.source import Source

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.user_constraints import UserConstraint

# Of spring and damper, of friction, of the limit, and of the other limit if both can act at once.
_ROWS = 4
# Straight pieces that stand for an arc where a path is drawn.
_ARC_PIECES = 8


class Walk:
    """One way along a path in one world; parts are in inertial frames, see `inertial_path`.

    Attributes:
        length: Length of the path so far [m or rad].
        velocity: How fast it grows by the motion of the world [m/s or rad/s].
    """

    def __init__(self, source: Source, body: BodyCore, world: int) -> None:
        self._source = source
        self._body = body
        self._world = world
        self._poses = source.poses(body)[world]
        self._twists = self.twists()
        self.length = 0.0
        self.velocity = 0.0

    def twists(self) -> Array:
        """Linear and angular velocity of the inertial frame of each link, (links of all bodies, 6)."""
        return self._source.velocities(self._body)[self._world]

    def rates(self, link: int) -> Array:
        """Velocities of the joint of a link, (count,)."""
        first, count = self._body.velocity_index[link], self._body.velocity_count[link]
        return self._source.state("dof_velocity")[self._world, first : first + count]

    def pose(self, link: int) -> Pose:
        """World pose of the inertial frame of a link."""
        if link == WORLD:
            return IDENTITY
        px, py, pz, x, y, z, w = self._poses[self._body.first_link + 1 + link].tolist()
        return Pose((px, py, pz), (x, y, z, w))

    def _speed(self, link: int, point: Vector3, along: Vector3) -> float:
        """Velocity of a point of a link along a direction."""
        if link == WORLD:
            return 0.0
        row = self._body.first_link + 1 + link
        vx, vy, vz, wx, wy, wz = self._twists[row].tolist()
        cx, cy, cz = self._poses[row, :3].tolist()
        x, y, z = point[0] - cx, point[1] - cy, point[2] - cz
        return (
            along[0] * (vx + wy * z - wz * y)
            + along[1] * (vy + wz * x - wx * z)
            + along[2] * (vz + wx * y - wy * x)
        )

    def power(self, link: int, point: Vector3, force: Vector3, torque: Vector3) -> float:
        """Power of a force at a point of a link, and a torque, by the motion of the link."""
        if link == WORLD:
            return 0.0
        wx, wy, wz = self._twists[self._body.first_link + 1 + link, 3:].tolist()
        return self._speed(link, point, force) + torque[0] * wx + torque[1] * wy + torque[2] * wz

    def _add(self, a: tuple[int, Vector3], b: tuple[int, Vector3], divisor: float) -> None:
        x, y, z = (q - p for p, q in zip(a[1], b[1], strict=True))
        distance = hypot(x, y, z)
        self.length += distance / divisor
        if distance > 0.0 and a[0] != b[0]:
            along = (x / distance, y / distance, z / distance)
            self.velocity += (self._speed(b[0], b[1], along) - self._speed(a[0], a[1], along)) / divisor

    def follow(self, path: Sequence[PathPart]) -> None:
        """Add up the length of a path and its velocity."""
        divisor, at = 1.0, None
        over: PathPart | None = None
        if path[0].kind is PathKind.CRANK:
            self._add_crank(path[0], path[1])
            return
        for part in path:
            if part.kind is PathKind.JOINT:
                self._add_joint(part)
            elif part.kind is PathKind.BALL:
                self._add_ball(part)
            elif part.kind is PathKind.PULLEY:
                divisor, at = part.size, None
            elif part.kind is PathKind.SITE:
                there = (part.link, compose(self.pose(part.link), part.pose).position)
                if at is not None and over is not None:
                    at = self._around(over, at, there, divisor)
                if at is not None:
                    self._add(at, there, divisor)
                at, over = there, None
            else:
                over = part

    def _add_joint(self, part: PathPart) -> None:
        body, state = self._body, self._source.state
        self.length += part.size * float(state("position")[self._world, body.position_index[part.link]])
        self.velocity += part.size * float(self.rates(part.link)[0])

    def _add_ball(self, part: PathPart) -> None:
        """Add the angle by which a spherical joint is turned, and its rate."""
        body, state = self._body, self._source.state
        first = body.position_index[part.link]
        x, y, z, w = state("position")[self._world, first : first + 4].tolist()
        sine = hypot(x, y, z)
        if sine > 0.0:
            self.length += part.size * 2.0 * atan2(sine, abs(w))
            rates = self.rates(part.link).tolist()
            along = sum(p * q for p, q in zip((x, y, z), rates, strict=True)) / sine
            self.velocity += part.size * (along if w >= 0.0 else -along)

    def _add_crank(self, slider: PathPart, crank: PathPart) -> None:
        """Add the position of a slider that a rod connects to a site; see `kernels.tendons.paths`."""
        frame = compose(self.pose(slider.link), slider.pose)
        point = compose(self.pose(crank.link), crank.pose).position
        axis = rotate(frame.orientation, (0.0, 0.0, 1.0))
        x, y, z = (q - p for p, q in zip(frame.position, point, strict=True))
        along = x * axis[0] + y * axis[1] + z * axis[2]
        reach = along * along + slider.size * slider.size - (x * x + y * y + z * z)
        root = sqrt(reach) if reach > 0.0 else 0.0
        by_axis, by_point = (x, y, z), axis
        if reach > 0.0:
            share = 1.0 - along / root
            by_axis = (share * x, share * y, share * z)
            by_point = (axis[0] * share + x / root, axis[1] * share + y / root, axis[2] * share + z / root)
        self.length += along - root
        force = (-by_point[0], -by_point[1], -by_point[2])
        self.velocity += self._speed(crank.link, point, by_point)
        torque = (
            axis[1] * by_axis[2] - axis[2] * by_axis[1],
            axis[2] * by_axis[0] - axis[0] * by_axis[2],
            axis[0] * by_axis[1] - axis[1] * by_axis[0],
        )
        self.velocity += self.power(slider.link, frame.position, force, torque)

    def _around(
        self, part: PathPart, at: tuple[int, Vector3], there: tuple[int, Vector3], divisor: float
    ) -> tuple[int, Vector3]:
        """Add the way to where a path leaves a sphere or cylinder; returns this point."""
        side = None if part.side is None else compose(self.pose(part.side_link), Pose(part.side)).position
        found = wrapped(part.kind, compose(self.pose(part.link), part.pose), part.size, at[1], there[1], side)
        if found is None:
            return at
        self._add(at, (part.link, found.begin), divisor)
        self.length += found.length / divisor
        return part.link, found.end


class _Trace(Walk):
    """A way along a path that remembers where it went: straight pieces, and those of arcs."""

    def __init__(self, source: Source, body: BodyCore, world: int) -> None:
        super().__init__(source, body, world)
        self.pieces: list[tuple[Vector3, Vector3]] = []

    def _add(self, a: tuple[int, Vector3], b: tuple[int, Vector3], divisor: float) -> None:
        super()._add(a, b, divisor)
        self.pieces.append((a[1], b[1]))

    def _around(
        self, part: PathPart, at: tuple[int, Vector3], there: tuple[int, Vector3], divisor: float
    ) -> tuple[int, Vector3]:
        count = len(self.pieces)
        after = super()._around(part, at, there, divisor)
        if len(self.pieces) > count:
            self._add_arc(part, self.pieces[-1][1], after[1])
        return after

    def _add_arc(self, part: PathPart, begin: Vector3, end: Vector3) -> None:
        """Add the pieces of an arc of less than half a turn on a sphere or cylinder."""
        frame = compose(self.pose(part.link), part.pose)
        into = inverse(frame)
        a, b = compose(into, Pose(begin)).position, compose(into, Pose(end)).position
        last = begin
        for number in range(1, _ARC_PIECES + 1):
            share = number / _ARC_PIECES
            x, y, z = (p + share * (q - p) for p, q in zip(a, b, strict=True))
            out = part.size / (hypot(x, y, z if part.kind is PathKind.SPHERE else 0.0) or part.size)
            point = (out * x, out * y, out * z if part.kind is PathKind.SPHERE else z)
            there = compose(frame, Pose(point)).position
            self.pieces.append((last, there))
            last = there


def pieces(source: Source, body: BodyCore, path: Sequence[PathPart]) -> list[tuple[Vector3, Vector3]]:
    """Start and end of each straight piece of a path in the first world [m]; none of one over joints.

    An arc has several.
    """
    trace = _Trace(source, body, 0)
    trace.follow(path)
    return trace.pieces


def forces_of_tendon(constraint: UserConstraint) -> tuple[float, float]:
    """Force of a tendon in the last substep, and that of its limit without its sign [N]."""
    forces = forces_of(constraint, _ROWS)
    return float(forces.sum()), abs(float(forces[2:].sum()))


def measured(source: Source, body: BodyCore, path: Sequence[PathPart]) -> tuple[Array, Array]:
    """Length of a path of a body in each world, and its velocity, (count,) each."""
    walks = [Walk(source, body, world) for world in range(source.count)]
    for walk in walks:
        walk.follow(path)
    return np.array([it.length for it in walks]), np.array([it.velocity for it in walks])


def measured_wrench(
    source: Source, body: BodyCore, site: PathPart, origin: PathPart | None, wrench: Wrench
) -> tuple[Array, Array]:
    """Length and velocity of an actuator of a site in each world, (count,) each.

    The length is the pose of the site relative to the origin, along a wrench in the axes of the origin; 0 if
    there is none. Then the velocity is that along the axes of the site.
    """
    walks = [Walk(source, body, world) for world in range(source.count)]
    for walk in walks:
        follow_wrench(walk, body, site, origin, wrench)
    return np.array([it.length for it in walks]), np.array([it.velocity for it in walks])


def follow_wrench(
    walk: Walk, body: BodyCore, site: PathPart, origin: PathPart | None, wrench: Wrench
) -> None:
    """Add the length and the velocity of an actuator of a site to a walk; see `measured_wrench`."""
    own = compose(walk.pose(site.link), site.pose)
    around = own if origin is None else compose(walk.pose(origin.link), origin.pose)
    force = rotate(around.orientation, wrench[:3])
    torque = rotate(around.orientation, wrench[3:])
    walk.velocity += walk.power(site.link, own.position, force, torque)
    if origin is None:
        return
    shared = _shared_link(body, site.link, origin.link)
    walk.velocity -= walk.power(shared, own.position, force, torque)
    walk.velocity -= walk.power(origin.link, around.position, force, torque)
    walk.velocity += walk.power(shared, around.position, force, torque)
    apart = compose(inverse(around), own)
    x, y, z, w = apart.orientation
    size = hypot(x, y, z)
    angle = 2.0 * atan2(size, abs(w)) * (1.0 if w >= 0.0 else -1.0)
    turn = (x, y, z) if size == 0.0 else tuple(it * angle / size for it in (x, y, z))
    walk.length += sum(a * b for a, b in zip((*apart.position, *turn), wrench, strict=True))


def _shared_link(body: BodyCore, a: int, b: int) -> int:
    """The last link on the ways from the base to two links; the world if one is in it."""
    if WORLD in (a, b):
        return WORLD
    ways = []
    for link in (a, b):
        way = [link]
        while way[-1] >= 0:
            way.append(body.spec.links[way[-1]].parent)
        ways.append(way)
    return next(link for link in ways[0] if link in ways[1])
