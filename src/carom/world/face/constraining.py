"""Constraints between links of a world, and to the world itself."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom.checks import Array, finite, vector
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, conjugate, inverse, rotate
from carom.layouts.codes import UserConstraintKind
from carom.model.body_spec import BASE
from carom.native.gates import gated
from carom.pose import is_pose
from carom.scene.handles import present_link_frame
from carom.scene.named import Named
from carom.scene.named_constraints.connect import Connect, Weld, frame_of, from_centre, new_connection
from carom.scene.named_constraints.guides import SECOND_POINT, Hinge, Slide, handles_of
from carom.scene.named_constraints.joint_coupling import JointCoupling, new_coupling
from carom.scene.named_constraints.named_constraint import UNBOUNDED, NamedConstraint, bound_of
from carom.scene.populated import Populated
from carom.world.face.constraint_order import Kind, check_order

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.scene.body import Body
    from carom.scene.joint import Joint
    from carom.scene.link import Link
    from carom.scene.user_constraints import UserConstraint

_ON_AXES = ("hinge", "slide")
# Distance of the points that hold the axis of a hinge [m].
_SPAN = 0.1


class Constraints(Named[NamedConstraint]):
    """The constraints of a world, by name or number: of scripts and of files, in the order they came."""

    def __repr__(self) -> str:
        return f"<Constraints: {', '.join(map(repr, self.names)) or 'none'}>"


class Constraining(Populated):
    """Base class of `World`: makes constraints, and lists them."""

    @property
    @gated("call_lock")
    def constraints(self) -> Constraints:
        """The constraints, by name or number: those of `constrain`, and of files."""
        return Constraints("constraint", handles_of(self.user_constraints.all))

    @gated("call_lock")
    def constrain(
        self,
        a: Body | Link | Joint | int | str,
        b: Body | Link | Joint | int | str | None = None,
        kind: Kind = "fixed",
        *,
        at: Any = None,
        to: Any = None,
        axis: ArrayLike | None = None,
        ratio: float = 1.0,
        max_force: float = inf,
        name: str | None = None,
    ) -> NamedConstraint:
        """Constrain a link to another, or to the world, as they are now.

        Args:
            a: A link; a body, its name or number stands for its base. Of a "gear" a joint.
            b: Likewise; None for the world.
            kind: "fixed": nothing moves between them. "point": a point of one stays at that of the other.
                "hinge": they turn about an axis. "slide": they move along an axis, without turning. "gear":
                joint `a` moves by `ratio` times the motion of joint `b`.
            at: The point where they are held [m], or the pose of the frame, in world axes; the origin of the
                link frame of `a` if left out.
            to: Where the frame `at` is to be, a point or a pose in world axes: it is pulled there. As it is
                now if left out.
            axis: Of a hinge or a slide: its direction in world axes, shape (3,).
            ratio: Of a gear.
            max_force: The greatest force along, and torque about, each axis [N or N m].
            name: Its name in `constraints`; its kind, and a number if that is taken, if left out.

        Returns:
            The constraint: `first`, `second`, `error`, `force`, `enabled`, `max_force`, `remove()`, and
            `second_frame`, which moves what it holds.

        Raises:
            KeyError: There is no such body.
            TypeError: `a` or `b` is not what the kind needs.
            ValueError: There is no such kind, the name is taken, an axis is missing or not wanted, or a
                number is not finite. The world stays as it was.
        """
        check_order(self, a, b, kind)
        _check_axis(kind, axis)
        bound = bound_of(max_force)
        called = self._name(kind, name)
        if kind == "gear":
            made = [_gear(_joint(a, "a"), _joint(b, "b"), float(finite(ratio, "ratio")))]
        else:
            made = self._links_held(kind, self._link(a), None if b is None else self._link(b), at, to, axis)
        for each, end in zip(made, ("", SECOND_POINT), strict=False):
            each.name = called + end
            each.max_force = bound
            each.max_impulse = UNBOUNDED if bound >= UNBOUNDED else bound * self.parameters.substep_time
            self.add_constraint(each)
            if len(made) > 1 and each is made[0]:
                # The numbers were given before the first was added.
                made[1].id = self.user_constraints.next_id
        if kind == "hinge":
            return Hinge(*made)
        handles = {"fixed": Weld, "point": Connect, "slide": Slide, "gear": JointCoupling}
        return handles[kind](made[0])

    def _link(self, it: Body | Link | Joint | int | str) -> Link:
        """A link of this world; of a body its base."""
        from carom.scene.joint import Joint
        from carom.scene.link import Link

        if isinstance(it, Joint):
            raise TypeError(f"only kind 'gear' constrains joints; of {it!r} take its link, or kind='gear'")
        if isinstance(it, Link):
            return self[it.body].links[it.index]
        return self[it].links[BASE]

    def _name(self, kind: str, name: str | None) -> str:
        taken = {each.name for each in self.user_constraints.all}
        if name is not None:
            if not isinstance(name, str) or not name or name in taken:
                raise ValueError(f"name must be a text that no constraint has yet, not {name!r}")
            return name
        number = 1
        while (called := kind if number == 1 else f"{kind}{number}") in taken:
            number += 1
        return called

    def _links_held(
        self, kind: str, a: Link, b: Link | None, at: Any, to: Any, axis: ArrayLike | None
    ) -> list[UserConstraint]:
        """The constraints between two links, to be put into the world."""
        there = present_link_frame(a.body, a.index)
        held = _placed(at, there, "at")
        wanted = held if to is None else _placed(to, held, "to")
        frame_a = compose(inverse(there), held)
        frame_b = wanted
        if b is not None:
            frame_b = compose(inverse(present_link_frame(b.body, b.index)), wanted)
        ends = (a.body, a.index), None if b is None else (b.body, b.index)
        if kind in ("fixed", "point"):
            return [_connection(ends, frame_a, frame_b, is_weld=kind == "fixed")]
        direction = vector(cast("ArrayLike", axis), 3, "axis")
        size = float(np.sqrt(np.square(direction).sum()))
        if size == 0.0:
            raise ValueError("axis must not be 0")
        direction /= size
        if kind == "hinge":
            step = _as_tuple(rotate(conjugate(held.orientation), _as_tuple(_SPAN * direction)))
            shifted = Pose(step, (0.0, 0.0, 0.0, 1.0))
            return [
                _connection(ends, frame_a, frame_b, is_weld=False),
                _connection(ends, compose(frame_a, shifted), compose(frame_b, shifted), is_weld=False),
            ]
        inertial = compose(there, a.body.link_inertial_frame(a.index))
        along = _as_tuple(rotate(conjugate(inertial.orientation), _as_tuple(direction)))
        return [
            self.user_constraints.new(
                UserConstraintKind.PRISMATIC,
                a.body,
                a.index,
                None if b is None else b.body,
                BASE if b is None else b.index,
                along,
                from_centre(a.body, a.index, frame_a),
                frame_b if b is None else from_centre(b.body, b.index, frame_b),
            )
        ]


def _check_axis(kind: str, axis: Any) -> None:
    if (axis is None) == (kind in _ON_AXES):
        needs = "needs an axis" if axis is None else "has no axis"
        raise ValueError(f"kind {kind!r} {needs}: axis=(x, y, z) in world axes is of 'hinge' and 'slide'")


def _connection(
    ends: tuple[tuple[Any, int], tuple[Any, int] | None], frame_a: Pose, frame_b: Pose, *, is_weld: bool
) -> UserConstraint:
    first, second = ends
    if second is None:
        return new_connection("", (*first, frame_a), None, frame_b, is_weld=is_weld)
    return new_connection("", (*first, frame_a), (*second, frame_b), IDENTITY, is_weld=is_weld)


def _placed(given: Any, default: Pose, name: str) -> Pose:
    """A frame in world axes, of a point or a pose; that of a point has the axes of the default."""
    if given is None:
        return default
    if is_pose(given):
        return frame_of(given)
    return Pose(_as_tuple(vector(given, 3, name)), default.orientation)


def _as_tuple(numbers: Array | tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in numbers)
    return x, y, z


def _joint(it: Any, name: str) -> Joint:
    from carom.scene.joint import Joint

    if not isinstance(it, Joint):
        raise TypeError(f"a gear is between two joints, such as arm.joints['elbow']; {name} is {it!r}")
    return it


def _gear(follower: Joint, leader: Joint, ratio: float) -> UserConstraint:
    """A coupling that holds for the present positions."""
    if follower.body.world is not leader.body.world:
        raise ValueError("both joints of a gear must be in this world")
    offset = float(follower.position) - ratio * float(leader.position)
    coefficients = (offset, ratio, 0.0, 0.0, 0.0)
    return new_coupling(follower.body, follower.index, leader.index, coefficients, "", leader.body)
