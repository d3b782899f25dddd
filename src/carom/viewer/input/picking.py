"""Pulling bodies with the mouse: a soft constraint between a point of a link and the mouse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any

from carom.description import Pose
from carom.description.pose import Vector3
from carom.description.transform import compose
from carom.layouts.codes import UserConstraintKind
from carom.model.body_spec import BASE
from carom.scene.joint_constraints import moving_links

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore
    from carom.scene.user_constraints import UserConstraint

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
# The maximum force of a pull, per mass of the body [N/kg] and at least [N]: enough to lift and swing a body,
# but not to pull it through others.
FORCE_BY_MASS = 100.0
MIN_FORCE = 5.0
_PATIENCE = 0.02


@dataclass(slots=True)
class _Hand:
    """The pull of one page.

    Attributes:
        body: Number of the body.
        link: Index of the link; -1 is the base.
        point: The pulled point of the link, in the link's inertial frame [m].
        target: The position of the mouse pointer, in the world [m].
        constraint: The constraint; None until it is made.
        moved: Whether the target has changed since the constraint was updated.
    """

    body: int
    link: int
    point: Vector3
    target: Vector3
    constraint: UserConstraint | None = None
    moved: bool = False


class Picking:
    """The pulls of all pages. For use by one thread; only `apply` changes the world, under its lock.

    While the simulation is `paused`, bodies with a free base are moved at once; their velocity stays. Mocap
    bodies always are, without a constraint.
    """

    def __init__(self, world: WorldCore, lock: Any, paused: Callable[[], bool]) -> None:
        self._paused = paused
        self._world = world
        self._world_lock = lock
        self._picking: dict[int, _Hand] = {}
        self._released: list[_Hand] = []

    def take(self, page: int, body: int, link: int, point: Vector3, target: Vector3) -> None:
        """Starts the pull of a page at a point of a link, given in the link's inertial frame."""
        self.release(page)
        if all(map(isfinite, (*point, *target))):
            self._picking[page] = _Hand(body, link, point, target)

    def move(self, page: int, target: Vector3) -> None:
        """Moves the target of a page's pull, in the world [m]."""
        hand = self._picking.get(page)
        if hand is not None and all(map(isfinite, target)):
            hand.target = target
            hand.moved = True

    def release(self, page: int) -> None:
        """Ends the pull of a page, after it has moved where the page had it last."""
        hand = self._picking.pop(page, None)
        if hand is not None and (hand.moved or hand.constraint is not None):
            self._released.append(hand)

    def apply(self, patience: float = _PATIENCE) -> None:
        """Makes, moves and removes the constraints; if no step ends in `patience` [s], at the next call."""
        if not self._released and not any(
            hand.moved or hand.constraint is None for hand in self._picking.values()
        ):
            return
        if not self._world_lock.acquire(timeout=patience):
            return
        try:
            self._let_go()
            for page, hand in list(self._picking.items()):
                if not self._hold(hand):
                    del self._picking[page]
        finally:
            self._world_lock.release()

    def _let_go(self) -> None:
        constraints = self._world.user_constraints
        for hand in self._released:
            # A hand that holds nothing yet takes hold first.
            while hand.moved and self._hold(hand):
                pass
            # The constraint is gone if its body has been removed in the meantime.
            if hand.constraint is not None and constraints.get(hand.constraint.id) is hand.constraint:
                self._world.remove_constraint(hand.constraint)
        self._released.clear()

    def _carry(self, hand: _Hand) -> None:
        """Moves a body with a free base so that the pulled point is at the mouse."""
        body = self._world.bodies[hand.body]
        if body.spec.soft is not None or (body.fixed_base and not follows_hand(body, hand.link)):
            return
        base, *_ = poses = self._world.link_pose[body.first_link : body.first_link + 1 + body.joint_count]
        held = Pose(tuple(poses[hand.link - BASE][:3]), tuple(poses[hand.link - BASE][3:]))
        point = compose(held, Pose(hand.point, _NO_TURN)).position
        position = [float(base[i]) + hand.target[i] - point[i] for i in range(3)]
        body.set_inertial_pose(position, base[3:].tolist())

    def _hold(self, hand: _Hand) -> bool:
        """Updates the constraint of a pull; false if the body or link no longer exists."""
        world = self._world
        if hand.constraint is not None:
            if world.user_constraints.get(hand.constraint.id) is not hand.constraint:
                return False
            hand.constraint.child_frame = Pose(hand.target, _NO_TURN)
            world.user_constraints.write(world.contact_arrays, world.arrays.state)
            if hand.moved and self._paused():
                self._carry(hand)
            hand.moved = False
            return True
        body = world.bodies.get(hand.body)
        if body is None or not BASE <= hand.link < body.joint_count:
            return False
        if follows_hand(body, hand.link):
            self._carry(hand)
            hand.moved = False
            return True
        if not moving_links(body)[hand.link - BASE]:
            return False
        hand.constraint = world.constrain_links(
            UserConstraintKind.POINT_TO_POINT,
            body,
            hand.link,
            None,
            BASE,
            parent_frame=Pose(hand.point, _NO_TURN),
            child_frame=Pose(hand.target, _NO_TURN),
            hidden=True,
        )
        mass = sum(body.dynamics(link).mass for link in range(BASE, body.joint_count))
        hand.constraint.max_force = max(MIN_FORCE, FORCE_BY_MASS * mass)
        hand.constraint.max_impulse = hand.constraint.max_force * world.parameters.substep_time
        return True


def follows_hand(body: BodyCore, link: int) -> bool:
    """Whether a link belongs to the base of a mocap body, which the mouse moves as it is, not by forces."""
    return body.spec.is_mocap and not moving_links(body)[link - BASE]
