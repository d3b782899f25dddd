"""What a collision shape has in one world and in many: how it touches others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from carom.checks import Array
from carom.description import Collision, Geometry
from carom.description import Pose as FramePose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Number = TypeVar("Number")
Given = TypeVar("Given")

COEFFICIENTS = {
    "friction": "lateral_friction",
    **{name: name for name in ("rolling_friction", "spinning_friction", "restitution")},
}
"""Coefficients of the surface of a shape, none of which may be negative: their names in `LinkDynamics`."""
MOTIONS = ("surface_velocity", "surface_spin")
"""How the surface moves in the shape, three numbers each."""
LOOKS = ("colour", "texture")
SIZE = "size"


def check_name(name: str) -> None:
    """Raise `TypeError` unless it is a parameter of shapes."""
    known = (*COEFFICIENTS, *MOTIONS, SIZE, *LOOKS)
    if name not in known:
        raise TypeError(f"shapes have no parameter {name!r}; they have {', '.join(known)}")


class CommonShape(Generic[Number, Given]):
    """Parameters of a shape; in one world numbers are plain, in many they are copies (count,).

    Each can be set: in many worlds to one number for all, or one for each.
    """

    __slots__ = ()

    @property
    def friction(self) -> Number:
        """Coefficient of sliding friction; settable, as the others are.

        Raises:
            ValueError: The value set is negative or not finite.
        """
        return self._read("friction")

    @friction.setter
    def friction(self, value: Given) -> None:
        self.change(friction=value)

    @property
    def rolling_friction(self) -> Number:
        """Torque about the tangents per normal force [m]."""
        return self._read("rolling_friction")

    @rolling_friction.setter
    def rolling_friction(self, value: Given) -> None:
        self.change(rolling_friction=value)

    @property
    def spinning_friction(self) -> Number:
        """Torque about the normal per normal force [m]."""
        return self._read("spinning_friction")

    @spinning_friction.setter
    def spinning_friction(self, value: Given) -> None:
        self.change(spinning_friction=value)

    @property
    def restitution(self) -> Number:
        """Coefficient of restitution."""
        return self._read("restitution")

    @restitution.setter
    def restitution(self, value: Given) -> None:
        self.change(restitution=value)

    @property
    def surface_velocity(self) -> Array:
        """Velocity of its surface in it along its own axes [m/s], (3,), in many worlds (count, 3); settable.

        So a belt moves what lies on it, but stays where it is: friction brings what touches the surface to
        this velocity, of which only what is along the surface counts. See docs/contact.md.

        Raises:
            ValueError: What is set is not three finite numbers.
        """
        return self._motion("surface_velocity")

    @surface_velocity.setter
    def surface_velocity(self, value: ArrayLike) -> None:
        self.change(surface_velocity=value)

    @property
    def surface_spin(self) -> Array:
        """Angular velocity of its surface in it about its own axes, through its origin [rad/s], likewise.

        Settable, as that of a turntable or a roller. Where the surface moves by it counts as
        `surface_velocity` does, and what is about the normal of a contact as much as spinning friction holds.

        Raises:
            ValueError: What is set is not three finite numbers.
        """
        return self._motion("surface_spin")

    @surface_spin.setter
    def surface_spin(self, value: ArrayLike) -> None:
        self.change(surface_spin=value)

    @property
    def geometry(self) -> Geometry:
        """What it is, with its sizes [m]: in many worlds those of the scene; `size` has those of each."""
        return self._spec.geometry

    @property
    def frame(self) -> FramePose:
        """Its pose in the link frame."""
        return self._spec.frame

    def change(self, **values: Any) -> None:
        """Set some of these."""
        raise NotImplementedError

    @property
    def _spec(self) -> Collision:
        raise NotImplementedError

    def _read(self, name: str) -> Number:
        """A coefficient."""
        raise NotImplementedError

    def _motion(self, name: str) -> Array:
        """A motion of the surface."""
        raise NotImplementedError
