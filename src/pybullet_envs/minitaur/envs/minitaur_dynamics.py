"""Parameters of a Minitaur that can be changed: masses, inertias, friction and motor strength."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import pybullet
from pybullet_envs.minitaur_bases import MinitaurBody


class MinitaurDynamics(MinitaurBody):
    """A Minitaur that stores the masses and inertias of its file.

    Lists for the base have a value for each link of the chassis; lists for the legs have one for each of the
    16 leg links, and then one for each of the 8 motors.
    """

    def _record_dynamics(self) -> None:
        base, legs = self._chassis_link_ids, self._moved_links()
        self._base_mass_urdf = [self._mass(link) for link in base]
        self._leg_masses_urdf = [self._mass(link) for link in legs]
        self._base_inertia_urdf = [self._inertia(link) for link in base]
        self._leg_inertia_urdf = [self._inertia(link) for link in legs]

    def _moved_links(self) -> list[int]:
        return self._leg_link_ids + self._motor_link_ids

    def _inertia(self, link: int) -> tuple[float, float, float]:
        return self._pybullet_client.getDynamicsInfo(self.quadruped, link)[2]

    @property
    def chassis_link_ids(self) -> list[int]:
        """Indices of the links of the chassis; -1 is the base."""
        return self._chassis_link_ids

    def GetBaseMassesFromURDF(self) -> list[float]:
        """Masses of the chassis in the file [kg]."""
        return self._base_mass_urdf

    def GetBaseInertiasFromURDF(self) -> list[tuple[float, float, float]]:
        """Principal moments of inertia of the chassis, as loaded [kg m²]."""
        return self._base_inertia_urdf

    def GetLegMassesFromURDF(self) -> list[float]:
        """Masses of legs and motors in the file [kg]."""
        return self._leg_masses_urdf

    def GetLegInertiasFromURDF(self) -> list[tuple[float, float, float]]:
        """Principal moments of inertia of legs and motors, as loaded [kg m²]."""
        return self._leg_inertia_urdf

    def SetBaseMasses(self, base_mass: Any) -> None:
        """Sets the masses of the chassis [kg].

        Raises:
            ValueError: The number of values is not the number of links.
        """
        self._set_each(self._chassis_link_ids, base_mass, "mass")

    def SetLegMasses(self, leg_masses: Any) -> None:
        """Sets the masses of legs and motors [kg].

        Raises:
            ValueError: The number of values is not the number of links.
        """
        self._set_each(self._moved_links(), leg_masses, "mass")

    def SetBaseInertias(self, base_inertias: Any) -> None:
        """Sets the principal moments of inertia of the chassis [kg m²].

        Raises:
            ValueError: The number of values is not the number of links, or one is negative.
        """
        self._set_each(self._chassis_link_ids, base_inertias, "localInertiaDiagonal")

    def SetLegInertias(self, leg_inertias: Any) -> None:
        """Sets the principal moments of inertia of legs and motors [kg m²].

        Raises:
            ValueError: The number of values is not the number of links, or one is negative.
        """
        self._set_each(self._moved_links(), leg_inertias, "localInertiaDiagonal")

    def _set_each(self, links: Sequence[int], values: Any, what: str) -> None:
        if len(values) != len(links):
            raise ValueError(f"{len(values)} values of {what} for {len(links)} links")
        if (np.asarray(values) < 0).any():
            raise ValueError(f"values of {what} should be non-negative")
        self._set_dynamics(links, values, what)

    def SetFootRestitution(self, foot_restitution: float) -> None:
        """Sets the restitution of all feet."""
        self._set_dynamics(self._foot_link_ids, [foot_restitution] * self.GetNumKneeJoints(), "restitution")

    def SetJointFriction(self, joint_frictions: Sequence[float]) -> None:
        """Sets the friction of the knees [N m]."""
        for knee, friction in zip(self._foot_link_ids, joint_frictions, strict=False):
            self._pybullet_client.setJointMotorControl2(
                self.quadruped, knee, pybullet.VELOCITY_CONTROL, targetVelocity=0, force=friction
            )

    def GetNumKneeJoints(self) -> int:
        """The number of knees: two for each leg."""
        return len(self._foot_link_ids)

    def SetMotorGains(self, kp: float, kd: float) -> None:
        """Sets the position gain and the velocity gain of all motors."""
        self._kp = kp
        self._kd = kd
        if self._motor_model is not None:
            self._motor_model.set_motor_gains(kp, kd)

    def GetMotorGains(self) -> tuple[float, float]:
        """Position gain and velocity gain of the motors."""
        return self._kp, self._kd

    def SetMotorStrengthRatio(self, ratio: float) -> None:
        """Sets the torque factor of all motors, if there is a motor model."""
        self.SetMotorStrengthRatios([ratio] * self.num_motors)

    def SetMotorStrengthRatios(self, ratios: Any) -> None:
        """Sets the torque factor of each motor, (8,), if there is a motor model."""
        if self._motor_model is not None:
            self._motor_model.set_strength_ratios(ratios)
