"""Moment arms of actuators of tendons and sites: how much of their force acts along a joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.joints import link_axes, vector_of
from carom.checks import Array
from carom.description.tendon import WORLD
from carom.description.transform import compose, inverse, rotate
from carom.layouts.codes import PathKind, UserConstraintKind
from carom.scene.sensors.source import Source
from carom.scene.tendons.measure import Walk, follow_wrench

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.user_constraints import UserConstraint


def pulling(body: BodyCore, joint: int) -> list[UserConstraint]:
    """The constraints by which actuators of tendons and sites of a body act on one of its joints."""
    if all(it.joint or it.link for it in body.spec.actuators):
        return []
    return [
        it
        for it in body.world.user_constraints.all
        if it.parent is body and it.kind is UserConstraintKind.TRANSMISSION and _pulls(body, it, joint)
    ]


def moment_arm(source: Source, body: BodyCore, transmission: UserConstraint, joint: int) -> Array:
    """How fast an actuator gets longer, with a gear of 1, if only one joint moves, with a velocity of 1.

    A force of the actuator acts with so much along the joint.

    Args:
        source: The worlds.
        body: The body.
        transmission: The constraint by which the actuator acts.
        joint: Index of a revolute or prismatic joint.

    Returns:
        The moment arm in each world [m for forces on revolute joints], (count,).
    """
    walks = [_UnitWalk(source, body, world, joint) for world in range(source.count)]
    for walk in walks:
        if transmission.is_wrench:
            origin = transmission.second_path[0] if transmission.second_path else None
            wrench = body.spec.actuators[transmission.actuator].wrench
            follow_wrench(walk, body, transmission.path[0], origin, wrench)
        else:
            walk.follow(transmission.path)
    return np.array([it.velocity for it in walks])


def _pulls(body: BodyCore, transmission: UserConstraint, joint: int) -> bool:
    """Whether the length of an actuator can depend on a joint."""
    parts = [it for it in (*transmission.path, *transmission.second_path) if it.kind is not PathKind.PULLEY]
    if any(it.kind is PathKind.JOINT and it.link == joint for it in parts):
        return True
    in_space = [it for it in parts if it.kind not in (PathKind.JOINT, PathKind.BALL)]
    moved = [it.link != WORLD and joint in _way(body, it.link) for it in in_space]
    # What moves all parts alike changes no length between them; one site by itself is pushed.
    return any(moved) and (len(moved) == 1 or not all(moved))


def _way(body: BodyCore, link: int) -> list[int]:
    """A link and those between it and the base."""
    way = []
    while link >= 0:
        way.append(link)
        link = body.spec.links[link].parent
    return way


class _UnitWalk(Walk):
    """A way along a path while only one joint moves, with a velocity of 1."""

    def __init__(self, source: Source, body: BodyCore, world: int, joint: int) -> None:
        self._joint = joint
        super().__init__(source, body, world)

    def rates(self, link: int) -> Array:
        """See `Walk`."""
        return np.full(self._body.velocity_count[link], 1.0 if link == self._joint else 0.0)

    def twists(self) -> Array:
        """See `Walk`."""
        body, first = self._body, self._body.first_link + 1
        found = np.zeros((len(self._poses), 6))
        own = self.pose(self._joint)
        angular, linear = (
            np.array(rotate(own.orientation, vector_of(it))) for it in link_axes(body, self._joint)[0]
        )
        origin = compose(own, inverse(body.link_inertial_frame(self._joint))).position
        for link in range(body.joint_count):
            if self._joint not in _way(body, link):
                continue
            arm = self._poses[first + link, :3] - np.array(origin)
            found[first + link, :3] = np.cross(angular, arm) + linear
            found[first + link, 3:] = angular
        return found
