"""Inverse masses of bodies and joints where all joints are at their references, as MuJoCo estimates them.

That of a body is the mean over all directions of how much its centre of mass is accelerated by a force there,
its inverse inertia likewise of a torque; that of a joint is by a force or torque of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.description import Pose
from carom.description.joint import BALL_TYPES, SLIDES
from carom.description.pose import IDENTITY
from carom.description.transform import compose, rotation_matrix
from carom.formats.mjcf.compiled.model import CompiledBody
from carom.native.products import crosses, dots, product

Matrix = NDArray[np.float64]
_MIN_PIVOT = 1e-15
_ALIGNED = 1e-12


@dataclass(eq=False, slots=True)
class _Part:
    """A body, the dofs that move it, and its Jacobian: (6, dofs), of its centre of mass, linear first."""

    body: CompiledBody
    dofs: list[int]
    jacobian: Matrix


class _Tree:
    """A body of the world with all bodies in it; a dof is a linear and an angular velocity at the origin."""

    def __init__(self, root: CompiledBody) -> None:
        self.parts: list[_Part] = []
        self.armature: list[float] = []
        self.joints: dict[str, list[int]] = {}
        self._linear: list[Matrix] = []
        self._angular: list[Matrix] = []
        pending: list[tuple[CompiledBody, Pose, list[int]]] = [(root, IDENTITY, [])]
        while pending:
            body, around, dofs = pending.pop()
            frame = compose(around, body.pose)
            dofs = [*dofs, *self._add_dofs(body, frame)]
            self.parts.append(_Part(body, dofs, self._jacobian(body, frame, dofs)))
            pending += [(child, frame, dofs) for child in body.children]

    def _add_dofs(self, body: CompiledBody, frame: Pose) -> list[int]:
        first, turn = len(self.armature), np.array(rotation_matrix(frame.orientation))
        if body.is_free:
            for axis in np.eye(3):
                self._add(np.zeros(3), axis, body.free_armature)
            for axis in turn.T:
                self._add(axis, crosses(np.array(frame.position), axis), body.free_armature)
        for each in body.joints:
            joint, begin = each.joint, len(self.armature)
            if joint.type in SLIDES:
                self._add(np.zeros(3), dots(turn, np.array(joint.axis)), joint.armature)
            else:
                anchor = np.array(compose(frame, Pose(each.anchor)).position)
                is_ball = joint.type in BALL_TYPES
                for axis in turn.T if is_ball else [dots(turn, np.array(joint.axis))]:
                    self._add(axis, crosses(anchor, axis), joint.armature)
            self.joints[joint.name] = list(range(begin, len(self.armature)))
        return list(range(first, len(self.armature)))

    def _add(self, angular: Matrix, linear: Matrix, armature: float) -> None:
        self._angular.append(angular)
        self._linear.append(linear)
        self.armature.append(armature)

    def _jacobian(self, body: CompiledBody, frame: Pose, dofs: list[int]) -> Matrix:
        if not dofs:
            return np.zeros((6, 0))
        x, y, z = body.inertia.centre.tolist()
        centre = np.array(compose(frame, Pose((x, y, z))).position)
        angular = np.array([self._angular[dof] for dof in dofs])
        linear = np.array([self._linear[dof] for dof in dofs]) + crosses(angular, centre)
        turn = np.array(rotation_matrix(frame.orientation))
        # Along the axes of the body, in which its tensor is given.
        return np.vstack([product(turn.T, linear.T), product(turn.T, angular.T)])

    def mass_matrix(self) -> Matrix:
        total = np.diag(np.array(self.armature))
        for part in self.parts:
            inertia = part.body.inertia
            if not part.dofs or inertia.mass == 0.0:
                continue
            linear, angular = part.jacobian[:3], part.jacobian[3:]
            own = inertia.mass * product(linear.T, linear)
            own += product(angular.T, product(inertia.tensor, angular))
            total[np.ix_(part.dofs, part.dofs)] += own
        return total


@dataclass(frozen=True, slots=True)
class TendonInertia:
    """What the armature of a tendon adds to a tree of joints at their references.

    Attributes:
        armature: Inertia along the tendon [kg].
        arms: Change of its length per position of each joint that changes it, by name.
    """

    armature: float
    arms: Mapping[str, float]


class InverseMasses:
    """Inverse masses of a body of the world, of all in it, and of its joints [1/kg, 1/(kg m²)].

    Those of what no force moves are 0, and all are if some joint has no inertia.

    Attributes:
        bodies: Inverse mass and inverse inertia of each body, by name.
        joints: Inverse mass of each joint, by name.
        free: Inverse mass and inverse inertia of the frame of a free body; 0 of one that is not free.
    """

    def __init__(self, root: CompiledBody, tendons: Sequence[TendonInertia] = ()) -> None:
        """`tendons` add to its inertia."""
        if not _moves(root):
            self._dofs, self._count, self._lower = {}, 0, None
            self.bodies: dict[str, tuple[float, float]] = dict.fromkeys(_names(root), (0.0, 0.0))
            self.free: tuple[float, float] = (0.0, 0.0)
            self.joints: dict[str, float] = {}
            return
        tree = _Tree(root)
        self._dofs = tree.joints
        self._count = len(tree.armature)
        matrix = tree.mass_matrix()
        for tendon in tendons:
            arms = np.zeros(self._count)
            for name, arm in tendon.arms.items():
                arms[tree.joints[name]] += arm
            matrix += tendon.armature * np.outer(arms, arms)
        self._lower = _cholesky(matrix)
        # Forces: of each dof, and those of each body.
        count = self._count
        forces = np.zeros((count, count + 6 * len(tree.parts)))
        forces[:, :count] = np.eye(count)
        for number, part in enumerate(tree.parts):
            first = count + 6 * number
            forces[part.dofs, first : first + 6] = part.jacobian.T
        answers = self._answers(forces)
        of_dofs, of_bodies = answers[:count], answers[count:].reshape(-1, 2, 3)
        self.bodies = {
            part.body.name: (_mean(linear), _mean(angular))
            for part, (linear, angular) in zip(tree.parts, of_bodies, strict=True)
        }
        own = of_dofs[:6] if root.is_free else np.zeros(6)
        self.free = (_mean(own[:3]), _mean(own[3:]))
        self.joints = {name: _mean(of_dofs[dofs]) for name, dofs in tree.joints.items()}
        for body in (root, *(() if root.joints or root.is_free else root.children)):
            if _only_slides(body):
                # By MuJoCo's rule its mass counts along all axes, and no armature.
                weight = 1.0 / body.inertia.mass
                self.bodies[body.name] = weight, 0.0
                self.joints.update((each.joint.name, weight) for each in body.joints)

    def along(self, shares: Iterable[tuple[str, float]]) -> float:
        """The inverse mass along a sum of positions of joints, each by its name and times a share."""
        force = np.zeros((self._count, 1))
        for name, share in shares:
            force[self._dofs[name]] += share
        return float(self._answers(force)[0])

    def _answers(self, forces: Matrix) -> Matrix:
        """For each column of forces on the dofs, the acceleration that it causes along itself."""
        answers, lower = np.zeros(forces.shape[1]), self._lower
        if lower is None:
            return answers
        rest = forces.copy()
        for row in range(self._count):
            rest[row] /= lower[row, row]
            answers += rest[row] * rest[row]
            rest[row + 1 :] -= lower[row + 1 :, row, None] * rest[row]
        return answers


def _moves(body: CompiledBody) -> bool:
    """Whether a body of the world or one in it has joints."""
    return body.is_free or bool(body.joints) or any(map(_moves, body.children))


def _names(body: CompiledBody) -> list[str]:
    """The names of a body and of all in it."""
    return [body.name, *(name for child in body.children for name in _names(child))]


def _only_slides(body: CompiledBody) -> bool:
    """Whether a body, which hangs from nothing that moves, slides along its own axes only and has no others.

    Its centre of mass is at its origin, its principal axes are its own, and no `simple="false"` says
    otherwise.
    """
    inertia = body.inertia
    if not body.joints or body.children or body.is_free or inertia.mass <= 0.0:
        return False
    if body.element.attributes.get("simple") == "false":
        return False
    if any(each.joint.type not in SLIDES or any(each.anchor) for each in body.joints):
        return False
    if any(sum(abs(it) > _ALIGNED for it in each.joint.axis) != 1 for each in body.joints):
        return False
    tensor = inertia.tensor
    scale = float(np.abs(tensor).max())
    if (
        np.abs(inertia.centre).max() > _ALIGNED
        or np.abs(tensor - np.diag(np.diag(tensor))).max() > _ALIGNED * scale
    ):
        return False
    if inertia.axes is not None:
        return bool(np.abs(inertia.axes - np.eye(3)).max() <= _ALIGNED)
    if len(body.visuals) == 1:
        return body.visuals[0].frame.orientation == IDENTITY.orientation
    # Those of several geoms together are sorted.
    return bool(tensor[0, 0] >= tensor[1, 1] >= tensor[2, 2])


def _mean(values: Matrix) -> float:
    return sum(values.tolist()) / len(values)


def _cholesky(matrix: Matrix) -> Matrix | None:
    """The lower triangular factor of a symmetric matrix; None if it is not positive definite."""
    rest, lower = matrix.copy(), np.zeros_like(matrix)
    for k in range(len(matrix)):
        pivot = rest[k, k]
        if not pivot > _MIN_PIVOT:
            return None
        lower[k:, k] = rest[k:, k] / np.sqrt(pivot)
        rest[k + 1 :, k + 1 :] -= lower[k + 1 :, k, None] * lower[None, k + 1 :, k]
    return lower
