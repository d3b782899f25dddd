"""Constraints made from tendons, from their couplings, and from actuators of tendons and sites."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.actuator import ActuatorSpec
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.sensor import SensorObject
from carom.description.tendon import WORLD, Path, PathPart, TendonSpec
from carom.description.transform import compose, inverse
from carom.errors import DescriptionError
from carom.layouts.codes import BALLS, PathKind, UserConstraintKind
from carom.scene.named_constraints.named_constraint import yield_as
from carom.scene.sensors.frames import frame_of
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.tendons.measure import measured
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_UNBOUNDED = 1e30


def inertial_path(body: BodyCore, path: Path) -> Path:
    """A path with its poses in inertial frames of links instead of link frames.

    Raises:
        DescriptionError: There is no such link, or its joint is of another kind.
    """
    return tuple(_inertial(body, part) for part in path)


def _inertial(body: BodyCore, part: PathPart) -> PathPart:
    for link in (part.link, part.side_link):
        if link != WORLD and not -1 <= link < body.joint_count:
            raise DescriptionError(f"body {body.name!r} has no link {link}, on which a tendon has a part")
    if part.kind is PathKind.JOINT:
        if part.link < 0 or body.velocity_count[part.link] != 1:
            raise DescriptionError(f"link {part.link} of {body.name!r} has no revolute or prismatic joint")
        return part
    if part.kind is PathKind.BALL:
        if part.link < 0 or body.joint_types[part.link] not in BALLS:
            raise DescriptionError(f"link {part.link} of {body.name!r} has no spherical joint")
        return part
    pose, side = part.pose, part.side
    if part.link != WORLD:
        pose = compose(inverse(body.link_inertial_frame(part.link)), pose)
    if side is not None and part.side_link != WORLD:
        side = compose(inverse(body.link_inertial_frame(part.side_link)), Pose(side)).position
    return replace(part, pose=pose, side=side)


def present_length(body: BodyCore, path: Path) -> float:
    """Length of a path whose poses are in inertial frames, for the present coordinates."""
    source = LoneSource(body.world, within_change=True)
    return float(measured(source, body, path)[0][0])


def new_tendon(body: BodyCore, spec: TendonSpec, name: str | None = None) -> UserConstraint:
    """The constraint of a tendon, to be put into its world.

    Without a range in which its spring is slack, the spring is at rest at its present length.
    """
    spec.check()
    made = _new(UserConstraintKind.TENDON, body, spec.name if name is None else name)
    made.path = inertial_path(body, spec.path)
    rest = spec.spring_range
    if rest is None:
        length = present_length(body, made.path) if spec.stiffness or any(spec.stiffness_terms) else 0.0
        rest = length, length
    made.spring = (spec.stiffness, spec.damping, *rest)
    made.polynomial = (*spec.stiffness_terms, 0.0, 0.0)
    made.armature = spec.armature
    made.look = spec.look
    made.range = (*spec.range, spec.friction, spec.limit_margin)
    if spec.limit_compliance is not None:
        yield_as(made, spec.limit_compliance)
    return made


def new_tendon_coupling(
    follower: UserConstraint,
    leader: UserConstraint | None,
    coefficients: tuple[float, float, float, float, float],
    name: str,
) -> UserConstraint:
    """The constraint that couples two tendons of one body; both are counted from their present lengths."""
    body = follower.parent
    made = _new(UserConstraintKind.TENDON_COUPLING, body, name)
    made.path, made.second_path = follower.path, () if leader is None else leader.path
    constant, first, second, third, fourth = coefficients
    made.relative_position_target, made.polynomial = constant, (first, second, third, fourth)
    other = 0.0 if leader is None else present_length(body, leader.path)
    made.range = (present_length(body, follower.path), other, 0.0, 0.0)
    made.erp = 1.0
    made.max_impulse = made.max_force = _UNBOUNDED
    return made


def new_transmission(
    body: BodyCore, number: int, spec: ActuatorSpec, frame: Callable[[str], tuple[int, Pose]] | None = None
) -> UserConstraint:
    """The constraint by which an actuator acts on a tendon or at a site.

    Args:
        body: The body that has the actuator.
        number: Its number there.
        spec: The actuator.
        frame: Link of a site, `WORLD` for the world, and the site's pose in the link frame or the world, by
            its name; None for sites of the body.

    Raises:
        DescriptionError: There is no such tendon or site.
    """
    made = _new(UserConstraintKind.TRANSMISSION, body, spec.name)
    made.actuator = number
    if spec.tendon:
        made.path = tendon_of(body, spec.tendon).path
        return made
    if spec.slider_site:
        slider = replace(_site_part(body, spec.slider_site, frame), kind=PathKind.CRANK, size=spec.rod)
        made.path = (slider, _site_part(body, spec.site, frame))
        return made
    made.is_wrench = True
    made.path = (_site_part(body, spec.site, frame),)
    if spec.reference_site:
        made.second_path = (_site_part(body, spec.reference_site, frame),)
    fx, fy, fz, tx, ty, tz = spec.wrench
    made.spring, made.range = (fx, fy, fz, 0.0), (tx, ty, tz, 0.0)
    return made


def tendon_of(body: BodyCore, name: str) -> UserConstraint:
    """The tendon of a body with a name.

    Raises:
        DescriptionError: There is none.
    """
    tendons = tendons_of(body)
    for tendon in tendons:
        if tendon.name == name:
            return tendon
    known = ", ".join(repr(it.name) for it in tendons) or "none"
    raise DescriptionError(f"body {body.name!r} has no tendon {name!r}; it has {known}")


def tendons_of(body: BodyCore) -> list[UserConstraint]:
    """The constraints that are tendons of a body."""
    users = body.world.user_constraints
    return [it for it in users.all if it.parent is body and it.kind is UserConstraintKind.TENDON]


def transmission_of(body: BodyCore, actuator: int) -> UserConstraint:
    """The constraint by which an actuator of a body acts on a tendon or at a site."""
    users = body.world.user_constraints
    kind = UserConstraintKind.TRANSMISSION
    return next(it for it in users.all if it.parent is body and it.kind is kind and it.actuator == actuator)


def _site_part(body: BodyCore, name: str, frame: Callable[[str], tuple[int, Pose]] | None) -> PathPart:
    if frame is None:
        found = frame_of(body, SensorObject.SITE, name)
        return PathPart(PathKind.SITE, found.link, found.pose)
    link, pose = frame(name)
    return _inertial(body, PathPart(PathKind.SITE, link, pose))


def _new(kind: UserConstraintKind, body: BodyCore, name: str) -> UserConstraint:
    axis: Vector3 = (0.0, 0.0, 0.0)
    made = body.world.user_constraints.new(kind, body, -1, None, -1, axis, IDENTITY, IDENTITY)
    made.name = name
    return made
