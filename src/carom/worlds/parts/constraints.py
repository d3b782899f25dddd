"""Constraints of many worlds: where they hold, by how much they miss, and their forces."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array
from carom.native.gates import gated
from carom.pose import Pose, turned
from carom.scene.named import Named
from carom.scene.named_constraints.connect import Connect
from carom.scene.named_constraints.guides import Slide, handles_of
from carom.scene.named_constraints.joint_coupling import JointCoupling
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.worlds.parts.holding import HoldingBatch

if TYPE_CHECKING:
    from carom.engine.engine import Engine
    from carom.scene.bodies import Bodies
    from carom.scene.user_constraints import UserConstraint
    from carom.world.world import World
    from carom.worlds.body import BodyBatch
    from carom.worlds.parts.joint import JointBatch
    from carom.worlds.parts.links import LinkBatch


class ConstraintBatch(HoldingBatch):
    """A constraint in all worlds, of any kind; get it from `worlds.constraints`."""

    def __init__(self, one: NamedConstraint, scene: World, engine: Engine, bodies: Bodies[BodyBatch]) -> None:
        self._bodies = bodies
        super().__init__(one, scene, engine)

    @property
    def first(self) -> LinkBatch | JointBatch:
        """The first link, or of a gear the joint that follows."""
        it = self._core
        body = self._bodies[it.parent.id]
        return body.joints[it.parent_link] if self.kind == "gear" else body.links[it.parent_link]

    @property
    def second(self) -> LinkBatch | JointBatch | None:
        """The second link, or of a gear the joint that leads; None for the world."""
        it = self._core
        if it.child is None:
            return None
        body = self._bodies[it.child.id]
        return body.joints[it.child_link] if self.kind == "gear" else body.links[it.child_link]

    @property
    @gated("_scene.call_lock")
    def error(self) -> Array:
        """By how much it misses, as `error` of the constraint of one world: (count, 3) [m], or (count,).

        Raises:
            NotImplementedError: It couples tendons.
        """
        one = self._one
        if isinstance(one, JointCoupling):
            return self._gear_error(one)
        if not isinstance(one, Connect):
            raise NotImplementedError(
                f"the error of {self.name!r} is measured in one world: worlds.extract(number).constraints"
            )
        apart = self._frame(self._core, first=True).position - self._frame(self._core, first=False).position
        if isinstance(one, Slide):
            along = self._axis()
            apart = apart - (apart * along).sum(axis=1, keepdims=True) * along
        return apart

    @property
    @gated("_scene.call_lock")
    def force(self) -> Array:
        """The force on the first link, in world axes [N], (count, 3), or of others than links (count,).

        It is that of the last substep, and 0 where it is disabled.
        """
        one = self._one
        rows = [self._impulses(row) for row in self._rows()]
        if not isinstance(one, Connect):
            return rows[0][:, 0]
        if not isinstance(one, Slide):
            return np.sum([each[:, :3] for each in rows], axis=0)
        along = self._axis()
        # As `kernels.solver.user_constraints.held_directions`.
        columns = self._frame(self._core, first=True).rotation
        across, other = (np.cross(columns[:, :, place], along) for place in (0, 1))
        sizes = np.sqrt(np.square(across).sum(axis=1, keepdims=True))
        across = np.where(sizes <= 1e-6, other, across)
        across /= np.sqrt(np.square(across).sum(axis=1, keepdims=True))
        return rows[0][:, :1] * across + rows[0][:, 1:2] * np.cross(along, across)

    @property
    def _core(self) -> UserConstraint:
        return self._one._parts[0]

    def _frame(self, it: UserConstraint, *, first: bool) -> Pose:
        """World poses of the frame on the first link, or on the second."""
        body, link, frame = (it.parent, it.parent_link, it.parent_frame)
        count = self._engine.arrays.world_count
        if not first:
            if it.child is None:
                place, turn = it.child_frame.position, it.child_frame.orientation
                return Pose(np.tile(place, (count, 1)), np.tile(turn, (count, 1)))
            body, link, frame = it.child, it.child_link, it.child_frame
        return self._bodies[body.id].links[link].inertial_pose * frame

    def _axis(self) -> Array:
        it = self._core
        pose = self._bodies[it.parent.id].links[it.parent_link].inertial_pose
        return turned(pose.quaternion, np.array(it.axis))

    def _gear_error(self, one: JointCoupling) -> Array:
        it = self._core
        follower: Any = self._bodies[it.parent.id].joints[it.parent_link]
        leader: Any = None if it.child is None else self._bodies[it.child.id].joints[it.child_link]
        at = np.zeros(self._engine.arrays.world_count) if leader is None else leader.position
        return follower.position - np.polynomial.polynomial.polyval(at, one.coefficients)


class ConstraintBatches(Named[ConstraintBatch]):
    """The constraints of many worlds, by name, number, or the constraint of the original world."""

    def __repr__(self) -> str:
        return f"<ConstraintBatches: {', '.join(map(repr, self.names)) or 'none'}>"


class ConstraintQueries:
    """Base class of `Worlds`: its constraints."""

    _scene: World
    _engine: Engine
    _bodies: Bodies[BodyBatch]

    @property
    @gated("_scene.call_lock")
    def constraints(self) -> ConstraintBatches:
        """The constraints, by name, number, or the constraint of the original world."""
        return ConstraintBatches("constraint", [*self._made_constraints()])

    def _made_constraints(self) -> Iterable[ConstraintBatch]:
        for one in handles_of(self._scene.user_constraints.all):
            yield ConstraintBatch(one, self._scene, self._engine, self._bodies)
