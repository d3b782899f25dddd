"""What a joint has in one world and in many: what its file says, and its damping, armature and spring."""

from __future__ import annotations

from math import inf
from typing import Any, Generic, TypeVar

from carom.description import JointType
from carom.description.pose import Vector3
from carom.model.body_spec import LinkSpec

Number = TypeVar("Number")
Given = TypeVar("Given")
LinkOf = TypeVar("LinkOf")


class CommonJoint(Generic[Number, Given, LinkOf]):
    """Properties of a joint; in one world numbers are plain, in many they are copies (count,)."""

    __slots__ = ()

    index: int

    @property
    def spec(self) -> LinkSpec:
        """The specification of the joint and the link it moves, from the file."""
        raise NotImplementedError

    @property
    def type(self) -> JointType:
        """The type of the joint."""
        return self.spec.joint_type

    @property
    def axis(self) -> Vector3:
        """Unit axis in the frame of the link it moves."""
        return self.spec.joint_axis

    @property
    def parent(self) -> LinkOf:
        """The parent link; it may be the base."""
        return self._link(self.spec.parent)

    @property
    def child(self) -> LinkOf:
        """The child link, which the joint moves."""
        return self._link(self.index)

    @property
    def degrees_of_freedom(self) -> int:
        """0 for a fixed joint, 3 for a spherical or planar one, 1 for the others."""
        raise NotImplementedError

    @property
    def effort_limit(self) -> float:
        """Maximum force of the motor according to the file (effort); inf if the file states none."""
        return self.spec.effort or inf

    # Terms of the joint itself

    @property
    def damping(self) -> Number:
        """Viscous damping [N m s/rad or N s/m]; settable, as all terms are.

        It is implicit in velocity, and stable however large it is, in bodies that `World.load` has read; in
        those that PyBullet's readings have loaded it is a torque by the velocity before the step.
        """
        return self._term("joint_damping")

    @damping.setter
    def damping(self, value: Given) -> None:
        self._change(joint_damping=value)

    @property
    def armature(self) -> Number:
        """Inertia of the drive, seen at the joint [kg m² or kg].

        It is the inertia of the rotor times the square of the gear ratio, and part of the mass matrix.
        """
        return self._term("joint_armature")

    @armature.setter
    def armature(self, value: Given) -> None:
        self._change(joint_armature=value)

    @property
    def stiffness(self) -> Number:
        """Stiffness of the joint's own spring [N m/rad or N/m], implicit in velocity."""
        return self._term("joint_stiffness")

    @stiffness.setter
    def stiffness(self, value: Given) -> None:
        self._change(joint_stiffness=value)

    def _link(self, number: int) -> LinkOf:
        """A link of the body."""
        raise NotImplementedError

    def _term(self, name: str) -> Number:
        """A term by its name in `LinkDynamics`."""
        raise NotImplementedError

    def _change(self, **changes: Any) -> None:
        """Change terms."""
        raise NotImplementedError

    def _require_one_freedom(self) -> None:
        count = self.degrees_of_freedom
        if count != 1:
            name = self.spec.joint_name
            raise ValueError(
                f"joint {name!r} is {self.type.value}: it has {count} degrees of freedom, not one"
            )

    def _require_terms(self) -> None:
        if not self.degrees_of_freedom:
            name = self.spec.joint_name
            raise ValueError(f"joint {name!r} is fixed: it has no damping, armature and spring")
