"""Joint couplings: a joint whose position is a function of that of another, as `<mimic>` in URDF."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from carom.description.pose import IDENTITY
from carom.layouts.codes import UserConstraintKind
from carom.native.gates import gated
from carom.scene.named_constraints.named_constraint import UNBOUNDED, NamedConstraint, constraints_of
from carom.scene.named_constraints.owners import handle_of
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore, JointReset
    from carom.scene.core.world_core import WorldCore
    from carom.scene.joint import Joint

_SINGLE_DOF = 1


class JointCoupling(NamedConstraint):
    """Holds a joint, the follower, at a polynomial of the position of another one, its leader.

    A file's couplings hold from the start: followers are placed where they follow. In each substep the solver
    makes the follower's rate the one that follows from the leader's, and corrects the share
    `parameters.joint_erp` of the error. Both joints feel the force of the coupling.
    """

    __slots__ = ()

    kind = "gear"

    def __repr__(self) -> str:
        leader = "" if self.leader is None else f" of {self.leader.name!r}"
        state = "" if self.enabled else ", disabled"
        return f"<JointCoupling {self.name!r}: {self.follower.name!r} = {self.coefficients}{leader}{state}>"

    @property
    def follower(self) -> Joint:
        """The joint that follows."""
        return handle_of(self._constraint.parent).joints[self._constraint.parent_link]

    @property
    def leader(self) -> Joint | None:
        """The joint that it follows; None if it is held at a constant."""
        return (
            None
            if self._constraint.child is None
            else handle_of(self._constraint.child).joints[self._constraint.child_link]
        )

    @property
    def coefficients(self) -> tuple[float, float, float, float, float]:
        """Of the polynomial, from the constant to the fourth power; of `<mimic>` offset and multiplier."""
        return (self._constraint.relative_position_target, *self._constraint.polynomial)

    @property
    @gated("_constraint.parent.world.call_lock")
    def error(self) -> float:
        """Position of the follower minus where it should be [rad or m]."""
        return float(self.follower.position) - self.wanted(self._leads_at())[0]

    def _leads_at(self) -> float:
        return 0.0 if self.leader is None else float(self.leader.position)

    def wanted(self, x: float) -> tuple[float, float]:
        """Where the follower should be, and the change of that per change of the leader's position `x`."""
        constant, *factors = self.coefficients
        wanted, slope, power = constant, 0.0, 1.0
        for exponent, factor in enumerate(factors, start=1):
            slope += exponent * factor * power
            power *= x
            wanted += factor * power
        return wanted, slope

    @gated("_constraint.parent.world.call_lock")
    def place(self) -> None:
        """Set position and velocity of the follower to those that follow from the leader's."""
        wanted, slope = self.wanted(self._leads_at())
        rate = 0.0 if self.leader is None else slope * float(self.leader.velocity)
        self._constraint.parent.set_joint_state(self._constraint.parent_link, [wanted], [rate])

    @property
    def force(self) -> float:
        """Force or torque on the follower in the last substep [N or N m]; 0 while it is disabled.

        The leader feels this times minus the slope of the polynomial.
        """
        return float(self._forces(1)[0])


def couplings_of(world: WorldCore, bodies: Sequence[BodyCore]) -> list[JointCoupling]:
    """The couplings of some bodies of a world."""
    return [JointCoupling(each) for each in constraints_of(world, bodies, (UserConstraintKind.COUPLING,))]


def place_followers(joint: Joint) -> None:
    """Place the joints of a body that follow one of its joints, directly or through others."""
    states = follower_states(joint.body, joint.index, joint.coordinates.tolist(), joint.rates.tolist())
    if states:
        joint.body.set_joint_states(states)


def follower_states(
    body: BodyCore, joint: int, position: Sequence[float] | None, velocity: Sequence[float] | None
) -> list[JointReset]:
    """States of the joints of a body that follow one of its joints, directly or through others.

    The state of that joint is given.
    """
    couplings = [coupling for coupling in couplings_of(body.world, [body]) if coupling.enabled]
    states: dict[int, JointReset] = {joint: (joint, position, velocity)}
    pending = [joint]
    while pending:
        leader = pending.pop()
        _, at, rate = states[leader]
        for coupling in couplings:
            follower, of = coupling.follower.index, coupling.leader
            if of is not None and of.body is body and of.index == leader and follower not in states:
                wanted, slope = coupling.wanted(at[0] if at else 0.0)
                states[follower] = follower, [wanted], [slope * (rate[0] if rate else 0.0)]
                pending.append(follower)
    del states[joint]
    return list(states.values())


def new_coupling(
    body: BodyCore,
    follower: int,
    leader: int | None,
    coefficients: tuple[float, float, float, float, float],
    name: str,
    other: BodyCore | None = None,
) -> UserConstraint:
    """The constraint between two joints, to be put into their world; None for no leader.

    The leader is a joint of the same body, or of another one.

    Raises:
        ValueError: One of them is not revolute or prismatic.
    """
    of_leader = body if other is None else other
    for each, joint in ((body, follower), (of_leader, leader)):
        if joint is not None and each.velocity_count[joint] != _SINGLE_DOF:
            raise ValueError(f"joint {each.spec.links[joint].joint_name!r} is neither revolute nor prismatic")
    constant, first, second, third, fourth = coefficients
    constraint = body.world.user_constraints.new(
        UserConstraintKind.COUPLING,
        body,
        follower,
        None if leader is None else of_leader,
        -1 if leader is None else leader,
        (0.0, 0.0, 0.0),
        IDENTITY,
        IDENTITY,
    )
    constraint.relative_position_target, constraint.polynomial = constant, (first, second, third, fourth)
    constraint.erp, constraint.name = 1.0, name
    constraint.max_impulse = constraint.max_force = UNBOUNDED
    return constraint
