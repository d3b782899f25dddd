"""The humanoids that learning scripts load from MJCF files."""

from __future__ import annotations

from tools.assets.gym_runners import FLOOR, X, Y, Z
from tools.assets.mjcf_text import Body, Geom, Hinge, Model
from tools.assets.parts import Vector3

HARDLY_TURNED = (1.0, 0.0, -0.002, 0.0)
ABOVE: Vector3 = (0.0, 0.0, 0.065)


def _rod(start: Vector3, end: Vector3, radius: float) -> Geom:
    return Geom("capsule", (radius,), ends=(start, end))


def _across(x: float, z: float, half: float, radius: float) -> Geom:
    """A capsule from side to side."""
    return _rod((x, -half, z), (x, half, z), radius)


def _foot(side: str, sign: float) -> Body:
    """Two soles that spread towards the toes, on an ankle with two joints."""
    outer = _rod((-0.07, 0.02 * sign, 0.0), (0.14, 0.04 * sign, 0.0), 0.027)
    inner = _rod((-0.07, 0.0, 0.0), (0.14, -0.02 * sign, 0.0), 0.027)
    ankle = (
        Hinge(f"{side}_ankle_y", Y, (-50.0, 50.0), (0.0, 0.0, 0.08)),
        Hinge(f"{side}_ankle_x", (1.0, 0.0, 0.5), (-50.0, 50.0), (0.0, 0.0, 0.04)),
    )
    return Body(f"{side}_foot", (0.0, 0.0, -0.39), joints=ankle, geoms=(outer, inner))


def _ball_foot(side: str) -> Body:
    """A ball."""
    return Body(f"{side}_foot", (0.0, 0.0, -0.45), geoms=(Geom("sphere", (0.075,), pos=(0.0, 0.0, 0.1)),))


def _leg(side: str, sign: float, foot: Body, back: float) -> Body:
    """A leg; `sign` is that of y on its side, `back` how far the hip bends back [degrees]."""
    shin = Body(
        f"{side}_shin",
        (0.0, -0.01 * sign, -0.403),
        joints=(Hinge(f"{side}_knee", (0.0, -1.0, 0.0), (-160.0, -2.0), (0.0, 0.0, 0.02)),),
        geoms=(_rod((0.0, 0.0, 0.0), (0.0, 0.0, -0.3), 0.049),),
        bodies=(foot,),
    )
    hip = (
        Hinge(f"{side}_hip_x", (-sign, 0.0, 0.0), (-25.0, 5.0)),
        Hinge(f"{side}_hip_z", (0.0, 0.0, -sign), (-60.0, 35.0)),
        Hinge(f"{side}_hip_y", Y, (back, 20.0)),
    )
    thigh = _rod((0.0, 0.0, 0.0), (0.0, -0.01 * sign, -0.34), 0.06)
    return Body(f"{side}_thigh", (0.0, 0.1 * sign, -0.04), joints=hip, geoms=(thigh,), bodies=(shin,))


def _arm(side: str, sign: float) -> Body:
    """An arm; `sign` is that of y on its side."""
    forearm = Body(
        f"{side}_lower_arm",
        (0.18, 0.18 * sign, -0.18),
        joints=(Hinge(f"{side}_elbow", (0.0, -1.0, -sign), (-90.0, 50.0)),),
        geoms=(
            _rod((0.01, -0.01 * sign, 0.01), (0.17, -0.17 * sign, 0.17), 0.031),
            Geom("sphere", (0.04,), pos=(0.18, -0.18 * sign, 0.18)),
        ),
    )
    reach = (-60.0, 85.0) if sign > 0.0 else (-85.0, 60.0)
    shoulder = (
        Hinge(f"{side}_shoulder1", (2.0, -sign, 1.0), reach),
        Hinge(f"{side}_shoulder2", (0.0, sign, 1.0), reach),
    )
    upper = _rod((0.0, 0.0, 0.0), (0.16, 0.16 * sign, -0.16), 0.04)
    place = (0.0, 0.17 * sign, 0.06)
    return Body(f"{side}_upper_arm", place, joints=shoulder, geoms=(upper,), bodies=(forearm,))


def _person(right_leg: Body, left_leg: Body, stands_free: bool = True) -> Body:
    pelvis = Body(
        "pelvis",
        (0.0, 0.0, -0.165),
        HARDLY_TURNED,
        joints=(Hinge("abdomen_x", X, (-35.0, 35.0), (0.0, 0.0, 0.1)),),
        geoms=(_across(-0.02, 0.0, 0.07, 0.09),),
        bodies=(right_leg, left_leg),
    )
    waist = Body(
        "lwaist",
        (-0.01, 0.0, -0.26),
        HARDLY_TURNED,
        joints=(
            Hinge("abdomen_z", Z, (-45.0, 45.0), ABOVE),
            Hinge("abdomen_y", Y, (-75.0, 30.0), ABOVE),
        ),
        geoms=(_across(0.0, 0.0, 0.06, 0.06),),
        bodies=(pelvis,),
    )
    return Body(
        "torso",
        (0.0, 0.0, 1.4),
        geoms=(
            _across(0.0, 0.0, 0.07, 0.07),
            Geom("sphere", (0.09,), "head", (0.0, 0.0, 0.19)),
            _across(-0.01, -0.12, 0.06, 0.06),
        ),
        bodies=(waist, _arm("right", -1.0), _arm("left", 1.0)),
        free="root" if stands_free else None,
        held=None if stands_free else "root",
    )


def _model(friction: float, *world: Body | Geom) -> Model:
    about = "A person of capsules and balls."
    return Model("humanoid", about, world, (friction, 0.1, 0.1), angle="degree")


def humanoid_symmetric(friction: float, stands_free: bool = True) -> Model:
    """Balls for feet; the torso hangs in the air unless it stands free."""
    right = _leg("right", -1.0, _ball_foot("right"), -120.0)
    left = _leg("left", 1.0, _ball_foot("left"), -120.0)
    return _model(friction, _person(right, left, stands_free))


def humanoid() -> Model:
    """Feet with two soles, and a floor."""
    right = _leg("right", -1.0, _foot("right", -1.0), -110.0)
    left = _leg("left", 1.0, _foot("left", 1.0), -120.0)
    return _model(0.5, Geom("plane", (100.0, 100.0, 0.2), "floor", rgba=FLOOR), _person(right, left))
