"""What several joints have in one world and in many: their own damping, armature, springs and friction."""

from __future__ import annotations

from typing import Any

from carom.checks import Array


class CommonJoints:
    """Terms of each of the movable joints, in one world (joints,), in many (count, joints).

    Setters take one number for all of them, or arrays of that shape, without the world for all worlds. See
    the same names of one joint.
    """

    @property
    def damping(self) -> Array:
        """Viscous damping [N m s/rad or N s/m] of each movable joint, a copy; settable, as all terms are."""
        return self._terms("damping")

    @damping.setter
    def damping(self, value: Any) -> None:
        self._set_terms("damping", value)

    @property
    def armature(self) -> Array:
        """Inertia of the drives, seen at the joints [kg m² or kg], likewise."""
        return self._terms("armature")

    @armature.setter
    def armature(self, value: Any) -> None:
        self._set_terms("armature", value)

    @property
    def stiffness(self) -> Array:
        """Stiffness of the joints' own springs [N m/rad or N/m], likewise."""
        return self._terms("stiffness")

    @stiffness.setter
    def stiffness(self, value: Any) -> None:
        self._set_terms("stiffness", value)

    @property
    def friction_loss(self) -> Array:
        """Greatest forces of dry friction [N m or N], likewise."""
        return self._terms("friction_loss")

    @friction_loss.setter
    def friction_loss(self, value: Any) -> None:
        self._set_terms("friction_loss", value)

    def _terms(self, name: str) -> Array:
        """A term of each movable joint."""
        raise NotImplementedError

    def _set_terms(self, name: str, value: Any) -> None:
        """Set a term of all movable joints; nothing changes if the value does not fit."""
        raise NotImplementedError
