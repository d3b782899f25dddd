"""What the armature of tendons adds to the equations of motion of a body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.algorithms.forward_kinematics import forward_kinematics
from carom.algorithms.link_motions import link_motions
from carom.algorithms.sweeps import sweeps_of
from carom.checks import Array
from carom.description.pose import Pose
from carom.description.tendon import WORLD, PathPart
from carom.description.transform import compose
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES, PathKind, UserConstraintKind
from carom.native.gates import gated
from carom.native.products import dots, length

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.user_constraints import UserConstraint

Numbers = Sequence[float] | np.ndarray


@gated("world.call_lock")
def tendon_inertia(body: Body, positions: Numbers) -> Array:
    """What the armature of a body's tendons adds to its mass matrix; `mass_matrix` is without it.

    Each tendon adds its armature times J J^T, where J are its moment arms: how fast it gets longer per
    velocity. A part that goes around a sphere or cylinder counts as not there.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,); for a free body, base position (3) and quaternion (4)
            of its inertial frame before them.

    Returns:
        Symmetric matrix (dofs, dofs), rows in the order of velocities: for a free body, angular (3) and
        linear (3) velocity of the base in its own axes before those of the joints.

    Raises:
        ValueError: A sequence has the wrong length, or a number is not finite.
    """
    dofs = sweeps_of(body).dofs
    matrix = np.zeros((dofs, dofs))
    for tendon in _heavy(body):
        arms = _moment_arms(body, tendon, positions)
        matrix += tendon.armature * np.outer(arms, arms)
    return matrix


@gated("world.call_lock")
def tendon_bias_forces(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """The forces (dofs,) that the armature of tendons adds to `bias_forces`, since moment arms change.

    Args:
        body: The body.
        positions: As in `tendon_inertia`.
        velocities: Joint rates, shape (n,); for a free body, angular (3) and linear (3) velocity of the base
            in its own axes before them.

    Returns:
        Forces in the order of the velocities, those of a free base torque before force [N m or N].

    Raises:
        ValueError: A sequence has the wrong length, or a number is not finite.
    """
    forces = np.zeros(sweeps_of(body).dofs)
    for tendon in _heavy(body):
        acceleration = _Course(body, tendon, positions, velocities).acceleration
        forces += tendon.armature * acceleration * _moment_arms(body, tendon, positions)
    return forces


def _heavy(body: Body) -> list[UserConstraint]:
    return [
        it
        for it in body.world.user_constraints.all
        if it.parent is body and it.kind is UserConstraintKind.TENDON and it.enabled and it.armature > 0.0
    ]


def _moment_arms(body: Body, tendon: UserConstraint, positions: Numbers) -> Array:
    """How fast a tendon gets longer per velocity, (dofs,)."""
    units = np.eye(sweeps_of(body).dofs)
    return np.array([_Course(body, tendon, positions, unit).velocity for unit in units])


class _Point(NamedTuple):
    """A point of a link, whose joints have constant rates, in world axes: (3,) each."""

    position: Array
    velocity: Array
    acceleration: Array


class _Course:
    """The path of a tendon while joints have constant rates.

    Attributes:
        velocity: How fast it gets longer [m/s].
        acceleration: Derivative of this velocity [m/s²].
    """

    def __init__(self, body: Body, tendon: UserConstraint, positions: Numbers, velocities: Numbers) -> None:
        self._body, self._path = body, tendon.path
        self._positions = np.asarray(positions, dtype=float)
        self._velocities = np.asarray(velocities, dtype=float)
        self.velocity = self.acceleration = 0.0
        for part in self._path:
            if part.kind is PathKind.JOINT:
                self.velocity += part.size * float(self._velocities[self._dof(part.link)])
        for a, b, divisor in self._segments():
            apart, rates, changes = (there - here for here, there in zip(a, b, strict=True))
            distance = length(apart)
            if distance > 0.0:
                along = apart / distance
                rate = float(dots(along, rates))
                self.velocity += rate / divisor
                across = float(dots(rates, rates)) - rate * rate
                self.acceleration += (float(dots(along, changes)) + across / distance) / divisor

    def _dof(self, link: int) -> int:
        """Index of the velocity of a joint of one freedom."""
        before = 0 if self._body.fixed_base else int(BASE_VELOCITIES)
        return before + sum(self._body.velocity_count[:link])

    def _segments(self) -> Iterator[tuple[_Point, _Point, float]]:
        """The straight ways from site to site, and by what their lengths are divided."""
        divisor, last = 1.0, None
        for part in self._path:
            if part.kind is PathKind.PULLEY:
                divisor, last = part.size, None
            elif part.kind is PathKind.SITE:
                point = self._point(part)
                if last is not None:
                    yield last, point, divisor
                last = point
            else:
                last = None

    def _point(self, part: PathPart) -> _Point:
        zero = np.zeros(3)
        if part.link == WORLD:
            return _Point(np.array(part.pose.position), zero, zero)
        body, joints = self._body, self._positions
        base = None
        if not body.fixed_base:
            base, joints = joints[:BASE_POSITIONS], joints[BASE_POSITIONS:]
        (frame,) = forward_kinematics(body, joints, [part.link], in_base_frame=base is not None)
        if base is not None:
            x, y, z, qx, qy, qz, qw = base.tolist()
            frame = compose(Pose((x, y, z), (qx, qy, qz, qw)), frame)
        pose = compose(frame, body.link_inertial_frame(part.link))
        steady = np.zeros(len(self._velocities))
        if base is not None:
            # The derivative of the vector, where the components of the base's velocity stay the same.
            steady[3:6] = np.cross(self._velocities[:3], self._velocities[3:6])
        motion = link_motions(body, self._positions, self._velocities, steady, [part.link])
        point = np.array(compose(pose, part.pose).position)
        reach, omega = point - np.array(frame.position), motion.angular_velocities[0]
        turning = np.cross(omega, reach)
        return _Point(
            point,
            motion.linear_velocities[0] + turning,
            motion.linear_accelerations[0]
            + np.cross(motion.angular_accelerations[0], reach)
            + np.cross(omega, turning),
        )
