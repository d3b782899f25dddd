"""Tasks of inverse kinematics that are mostly kept exactly: equality constraints, and joints that stay."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from carom.controllers.configuration import Configuration
from carom.controllers.tasks import Task, TaskRows, rotation_vector
from carom.description.pose import Pose
from carom.description.transform import compose, rotation_matrix
from carom.layouts.codes import UserConstraintKind
from carom.scene.core.body_core import BodyCore
from carom.scene.handles import present_inertial_frame
from carom.scene.named_constraints.joint_coupling import JointCoupling
from carom.scene.user_constraints import UserConstraint

_POINTS = (UserConstraintKind.POINT_TO_POINT, UserConstraintKind.FIXED)
_KINDS = (*_POINTS, UserConstraintKind.COUPLING)


class EqualityTask(Task):
    """Constraints of the world are to hold: points at points, frames at frames, joints that follow joints.

    Those are `<equality>` of MJCF files, mimic joints of URDF files, and what users make. Constraints that
    are disabled have no rows.
    """

    def __init__(
        self,
        configuration: Configuration,
        names: Sequence[str] | None = None,
        *,
        cost: ArrayLike = 1.0,
        gain: float = 1.0,
    ) -> None:
        """Choose constraints.

        Args:
            configuration: A configuration of the body.
            names: Their names; None for all that act on the body and can be kept so.
            cost: Cost of errors [1/m or 1/rad], a number.
            gain: Share of the error to correct in a tick.

        Raises:
            KeyError: There is no such constraint.
            ValueError: A constraint is of another kind, or of other bodies.
        """
        super().__init__(float(np.asarray(cost, dtype=float)), gain)
        body = configuration.body
        own = [it for it in configuration.world.user_constraints.all if body in (it.parent, it.child)]
        if names is None:
            self._constraints = [it for it in own if it.kind in _KINDS]
            return
        by_name = {it.name: it for it in configuration.world.user_constraints.all}
        for name in names:
            if name not in by_name:
                known = ", ".join(repr(it.name) for it in own if it.name)
                raise KeyError(f"there is no constraint {name!r}; those of {body.name!r}: {known or 'none'}")
            if by_name[name] not in own:
                raise ValueError(f"constraint {name!r} does not act on {body.name!r}")
            if by_name[name].kind not in _KINDS:
                kind = by_name[name].kind.name.lower().replace("_", " ")
                raise ValueError(
                    f"constraint {name!r} is a {kind}: points, frames and couplings of joints can be tasks"
                )
        self._constraints = [by_name[name] for name in names]

    def rows(self, configuration: Configuration) -> TaskRows:
        """What is missing of each constraint: three rows of a point, six of a frame, one of a coupling."""
        parts = [_rows(configuration, it) for it in self._constraints if it.enabled]
        if not parts:
            return TaskRows(np.zeros(0), np.zeros((0, configuration.dofs)))
        errors, jacobians = zip(*parts, strict=True)
        return TaskRows(np.concatenate(errors), np.concatenate(jacobians))


class FreezeTask(Task):
    """Joints stay where they are; among the `constraints` of `TaskIK` they do so exactly."""

    def __init__(
        self, configuration: Configuration, joints: Sequence[int | str], *, cost: ArrayLike = 1.0
    ) -> None:
        """Choose joints by index or name, with the cost of their changes [1/rad or 1/m].

        Raises:
            KeyError: There is no joint of a name.
        """
        super().__init__(cost, 1.0)
        self._dofs = [dof for joint in joints for dof in configuration.joint_dofs(joint)]

    def rows(self, configuration: Configuration) -> TaskRows:
        """No change of these joints, a row for each of their velocity coordinates."""
        return TaskRows(np.zeros(len(self._dofs)), np.eye(configuration.dofs)[self._dofs])


def _rows(configuration: Configuration, constraint: UserConstraint) -> TaskRows:
    """The rows of one constraint."""
    if constraint.kind == UserConstraintKind.COUPLING:
        return _coupling_rows(configuration, constraint)
    first = _frame(constraint.parent, constraint.parent_link, constraint.parent_frame)
    second = constraint.child_frame
    if constraint.child is not None:
        second = _frame(constraint.child, constraint.child_link, constraint.child_frame)
    jacobian = np.zeros((6, configuration.dofs))
    for sign, body, link, frame in (
        (1.0, constraint.parent, constraint.parent_link, first),
        (-1.0, constraint.child, constraint.child_link, second),
    ):
        if body is configuration.body:
            jacobian += sign * configuration.jacobian(link, np.array(frame.position))
    error = np.zeros(6)
    error[:3] = np.subtract(second.position, first.position)
    if constraint.kind == UserConstraintKind.POINT_TO_POINT:
        return TaskRows(error[:3], jacobian[:3])
    turns = [np.array(rotation_matrix(frame.orientation)) for frame in (first, second)]
    error[3:] = rotation_vector(turns[1] @ turns[0].T)
    return TaskRows(error, jacobian)


def _coupling_rows(configuration: Configuration, constraint: UserConstraint) -> TaskRows:
    coupling = JointCoupling(constraint)
    leader = coupling.leader
    wanted, slope = coupling.wanted(0.0 if leader is None else leader.position)
    error, jacobian = np.zeros(1), np.zeros((1, configuration.dofs))
    error[0] = wanted - coupling.follower.position
    for joint, share in ((coupling.follower, 1.0), (leader, -slope)):
        if joint is not None and joint.body.id == configuration.body.id:
            jacobian[0, configuration.joint_dofs(joint.index)] += share
    return TaskRows(error, jacobian)


def _frame(body: BodyCore, link: int, frame: Pose) -> Pose:
    """A frame of a constraint in the world."""
    return compose(present_inertial_frame(body, link), frame)
