"""`DriveAPI`: springs and dampers with targets, as actuators."""

from __future__ import annotations

from math import degrees, inf, radians
from typing import Any

from carom.description.actuator import GeneralActuator, Motor, PositionActuator, VelocityActuator
from carom.formats.usd.scene import Drive
from carom.formats.usd.stage import Stage


def read_drive(stage: Stage, prim: Any, joint: str, token: str, *, angular: bool) -> Drive | None:
    """The drive of a degree of freedom: `angular`, `linear`, `rotX` and so on; None if there is none.

    With stiffness it is a position servo with the target as its control; with damping alone a velocity servo;
    with neither a motor. Of both targets that of the velocity is then part of the servo.

    Raises:
        DescriptionError: A gain or the greatest force is negative.
    """
    if not prim.HasAPI(stage.pxr.UsdPhysics.DriveAPI, token):
        return None
    names = ("stiffness", "damping", "maxForce", "targetPosition", "targetVelocity")
    defaults = (0.0, 0.0, inf, 0.0, 0.0)
    kp, kd, most, target, speed = (
        stage.number(prim, f"drive:{token}:physics:{name}", default)
        for name, default in zip(names, defaults, strict=True)
    )
    if min(kp, kd, most) < 0.0:
        raise stage.error(prim, "stiffness, damping and maxForce of a drive must not be negative")
    per_mass = str(stage.value(prim, f"drive:{token}:physics:type", "force")) == "acceleration"
    if per_mass:
        consequence = "its gains are for the mass that it moves where the stage has the bodies"
        stage.leave_out(prim, consequence, "gains of actuators do not change", f"drive:{token}:physics:type")
    # Gains of angles are per degree.
    heavy = 1.0 if per_mass else stage.mass_unit * (stage.unit**2 if angular else 1.0)
    kp, kd = (degrees(it) * heavy if angular else it * heavy for it in (kp, kd))
    most *= stage.mass_unit * stage.unit * (stage.unit if angular else 1.0)
    target, speed = (radians(it) if angular else it * stage.unit for it in (target, speed))
    bounds = (-most, most)
    if kp == 0.0 and kd == 0.0:
        return Drive(joint, Motor(joint, force_range=bounds))
    if kp == 0.0:
        return Drive(joint, VelocityActuator(joint, kv=kd, force_range=bounds), speed, per_mass)
    if speed == 0.0:
        return Drive(joint, PositionActuator(joint, kp=kp, kv=kd, force_range=bounds), target, per_mass)
    servo = GeneralActuator(joint, gain=(kp, 0.0, 0.0), bias=(kd * speed, -kp, -kd), force_range=bounds)
    return Drive(joint, servo, target, per_mass)
