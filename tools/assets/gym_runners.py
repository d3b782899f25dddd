"""The walkers, hoppers and pendulums that learning scripts load from MJCF files."""

from __future__ import annotations

from tools.assets.mjcf_text import Body, Geom, Hinge, Model
from tools.assets.parts import Vector3

X: Vector3 = (1.0, 0.0, 0.0)
Y: Vector3 = (0.0, 1.0, 0.0)
Z: Vector3 = (0.0, 0.0, 1.0)
BACK_Y: Vector3 = (0.0, -1.0, 0.0)

GREY = (0.75, 0.77, 0.8, 1.0)
BLUE = (0.2, 0.4, 0.7, 1.0)
ORANGE = (0.9, 0.5, 0.15, 1.0)
GREEN = (0.35, 0.6, 0.35, 1.0)
SAND = (0.85, 0.65, 0.4, 1.0)
RED = (0.8, 0.25, 0.2, 1.0)
FLOOR = (0.8, 0.85, 0.9, 1.0)
MODEST: Vector3 = (0.8, 0.1, 0.1)
"""Friction of the runners that stay in a plane."""
ONLY_OTHERS, NOTHING = (1, 0), (0, 1)
"""Groups and masks of runners whose links do not touch each other, and of what touches nothing at all."""


def _rod(start: Vector3, end: Vector3, radius: float, name: str = "") -> Geom:
    return Geom("capsule", (radius,), name, ends=(start, end))


def _upright(top: float, bottom: float, radius: float) -> Geom:
    return _rod((0.0, 0.0, top), (0.0, 0.0, bottom), radius)


def _in_plane(names: tuple[str, str, str]) -> tuple[Hinge, ...]:
    """Joints that leave a body free in the plane of x and z."""
    return (
        Hinge(names[0], X, slides=True),
        Hinge(names[1], Z, slides=True),
        Hinge(names[2], Y),
    )


def _leg(suffix: str, foot: tuple[Vector3, Vector3]) -> Body:
    """Thigh, leg and foot; all places are those of the standing robot."""
    foot_body = Body(
        f"foot{suffix}",
        joints=(Hinge(f"foot{suffix}_joint", BACK_Y, (-45.0, 45.0), (0.0, 0.0, 0.1)),),
        geoms=(_rod(*foot, 0.06),),
    )
    shank = Body(
        f"leg{suffix}",
        joints=(Hinge(f"leg{suffix}_joint", BACK_Y, (-150.0, 0.0), (0.0, 0.0, 0.6)),),
        geoms=(_upright(0.6, 0.1, 0.04),),
        bodies=(foot_body,),
    )
    return Body(
        f"thigh{suffix}",
        joints=(Hinge(f"thigh{suffix}_joint", BACK_Y, (-150.0, 0.0), (0.0, 0.0, 1.05)),),
        geoms=(_upright(1.05, 0.6, 0.05),),
        bodies=(shank,),
    )


def hopper() -> Model:
    """One leg."""
    leg = _leg("", ((-0.13, 0.0, 0.1), (0.26, 0.0, 0.1)))
    torso = Body(
        "torso",
        joints=_in_plane(("ignore1", "ignore2", "ignore3")),
        geoms=(_upright(1.45, 1.05, 0.05),),
        bodies=(leg,),
    )
    return Model("hopper", "A hopper on one leg.", (torso,), MODEST, ORANGE, "degree")


def walker2d() -> Model:
    """Two legs."""
    foot = ((0.0, 0.0, 0.1), (0.2, 0.0, 0.1))
    torso = Body(
        "torso",
        joints=_in_plane(("ignorex", "ignorez", "ignorey")),
        geoms=(_upright(1.45, 1.05, 0.05),),
        bodies=(_leg("", foot), _leg("_left", foot)),
    )
    return Model(
        "walker2d",
        "A walker on two legs that stays in a plane.",
        (torso,),
        MODEST,
        BLUE,
        "degree",
        ONLY_OTHERS,
    )


def _limb(
    name: str,
    pos: Vector3,
    reach: tuple[float, float],
    middle: Vector3,
    turn: float,
    half: float,
    mass: float | None = None,
    bodies: tuple[Body, ...] = (),
) -> Body:
    """A part of a leg of the cheetah."""
    geom = Geom("capsule", (0.046, half), pos=middle, turn=(Y, turn))
    return Body(name, pos, joints=(Hinge(name, Y, reach),), geoms=(geom,), bodies=bodies, mass=mass)


def half_cheetah() -> Model:
    """A back leg and a front leg."""
    back_foot = _limb("bfoot", (-0.28, 0.0, -0.14), (-0.4, 0.785), (0.03, 0.0, -0.097), -0.27, 0.094, 10.0)
    back_shin = _limb(
        "bshin", (0.16, 0.0, -0.25), (-0.785, 0.785), (-0.14, 0.0, -0.07), -2.03, 0.15, bodies=(back_foot,)
    )
    back = _limb(
        "bthigh", (-0.5, 0.0, 0.0), (-0.52, 1.05), (0.1, 0.0, -0.13), -3.8, 0.145, bodies=(back_shin,)
    )
    front_foot = _limb("ffoot", (0.13, 0.0, -0.18), (-3.1, -0.3), (0.045, 0.0, -0.07), -0.6, 0.07, 10.0)
    front_shin = _limb(
        "fshin", (-0.14, 0.0, -0.24), (-1.2, 1.1), (0.065, 0.0, -0.09), -0.6, 0.106, bodies=(front_foot,)
    )
    front = _limb(
        "fthigh", (0.5, 0.0, 0.0), (-1.5, 0.8), (-0.07, 0.0, -0.12), 0.52, 0.133, bodies=(front_shin,)
    )
    torso = Body(
        "torso",
        (0.0, 0.0, 0.7),
        joints=_in_plane(("ignorex", "ignorez", "ignorey")),
        geoms=(
            _rod((-0.5, 0.0, 0.0), (0.5, 0.0, 0.0), 0.046),
            Geom("capsule", (0.046, 0.15), pos=(0.6, 0.0, 0.1), turn=(Y, 0.87)),
        ),
        bodies=(back, front),
    )
    return Model(
        "cheetah", "A cheetah with two legs that stays in a plane.", (torso,), MODEST, SAND, touch=ONLY_OTHERS
    )


ANT_LEGS = (
    ("front_left", 1.0, 1.0, (30.0, 100.0)),
    ("front_right", -1.0, 1.0, (-100.0, -30.0)),
    ("left_back", -1.0, -1.0, (-100.0, -30.0)),
    ("right_back", 1.0, -1.0, (30.0, 100.0)),
)
"""Name, directions along x and y, and bounds of the ankle [degrees]."""


def ant() -> Model:
    """Four legs with two joints each."""
    legs: list[Body] = []
    for number, (name, x, y, reach) in enumerate(ANT_LEGS, start=1):
        knee = (0.2 * x, 0.2 * y, 0.0)
        foot = Body(
            f"{name}_foot",
            knee,
            joints=(Hinge(f"ankle_{number}", (-x * y, 1.0, 0.0), reach),),
            geoms=(_rod((0.0, 0.0, 0.0), (0.4 * x, 0.4 * y, 0.0), 0.08),),
        )
        upper = Body(
            f"aux_{number}",
            knee,
            joints=(Hinge(f"hip_{number}", Z, (-40.0, 40.0)),),
            geoms=(_rod((0.0, 0.0, 0.0), knee, 0.08),),
            bodies=(foot,),
        )
        root = _rod((0.0, 0.0, 0.0), knee, 0.08)
        legs.append(Body(f"{name}_leg", geoms=(root,), bodies=(upper,)))
    torso = Body("torso", (0.0, 0.0, 0.75), geoms=(Geom("sphere", (0.25,)),), bodies=tuple(legs), free="root")
    return Model("ant", "An ant with four legs.", (torso,), (1.5, 0.1, 0.1), SAND, "degree", ONLY_OTHERS)


RAIL = Geom("capsule", (0.02, 1.0), "rail", turn=(Y, 1.5707963267948966), rgba=GREY)
CART = Geom("capsule", (0.1, 0.1), "cart", turn=(Y, 1.5707963267948966), rgba=GREEN)
SLIDER = Hinge("slider", X, (-1.0, 1.0), slides=True)


def inverted_pendulum() -> Model:
    """A pole that leans by a hair on a cart."""
    lean = _rod((0.0, 0.0, 0.0), (0.001, 0.0, 0.6), 0.049)
    pole = Body("pole", joints=(Hinge("hinge", Y),), geoms=(lean,))
    cart = Body("cart", joints=(SLIDER,), geoms=(CART,), bodies=(pole,))
    return Model("inverted pendulum", "A pole on a cart on a rail.", (RAIL, cart), rgba=ORANGE, touch=NOTHING)


def inverted_double_pendulum() -> Model:
    """Two poles on a cart."""
    upper = Body("pole2", (0.0, 0.0, 0.6), joints=(Hinge("hinge2", Y),), geoms=(_upright(0.0, 0.6, 0.045),))
    pole = Body("pole", joints=(Hinge("hinge", Y),), geoms=(_upright(0.0, 0.6, 0.045),), bodies=(upper,))
    cart = Body("cart", joints=(SLIDER,), geoms=(CART,), bodies=(pole,))
    floor = Geom("plane", (40.0, 40.0, 40.0), "floor", (0.0, 0.0, -3.0), rgba=FLOOR)
    return Model(
        "cartpole", "Two poles on a cart on a rail.", (floor, RAIL, cart), rgba=ORANGE, touch=NOTHING
    )


def swimmer() -> Model:
    """Three links in a row."""
    backwards = _rod((0.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 0.1)
    back = Body("back", (-1.0, 0.0, 0.0), joints=(Hinge("rot3", Z, (-100.0, 100.0)),), geoms=(backwards,))
    mid = Body(
        "mid",
        (0.5, 0.0, 0.0),
        joints=(Hinge("rot2", Z, (-100.0, 100.0)),),
        geoms=(backwards,),
        bodies=(back,),
    )
    torso = Body(
        "torso",
        joints=(Hinge("slider1", X, slides=True), Hinge("slider2", Y, slides=True), Hinge("rot", Z)),
        geoms=(_rod((1.5, 0.0, 0.0), (0.5, 0.0, 0.0), 0.1),),
        bodies=(mid,),
    )
    floor = Geom("plane", (40.0, 40.0, 0.1), "floor", (0.0, 0.0, -0.1), rgba=FLOOR)
    return Model("swimmer", "A swimmer of three links.", (floor, torso), (0.5, 0.1, 0.1), GREEN, "degree")


def reacher() -> Model:
    """An arm of two links in the plane, and a target."""
    corners = ((-0.3, -0.3, 0.01), (0.3, -0.3, 0.01), (0.3, 0.3, 0.01), (-0.3, 0.3, 0.01))
    sides = tuple(
        Geom("capsule", (0.02,), f"side{name}", ends=(corners[start], corners[end]), rgba=SAND)
        for name, start, end in (("S", 0, 1), ("E", 1, 2), ("N", 3, 2), ("W", 0, 3))
    )
    root = Geom("cylinder", (0.011,), "root", ends=((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)), rgba=GREY)
    link = _rod((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), 0.01)
    fingertip = Body("fingertip", (0.11, 0.0, 0.0), geoms=(Geom("sphere", (0.01,), rgba=ORANGE),))
    outer = Body(
        "body1",
        (0.1, 0.0, 0.0),
        joints=(Hinge("joint1", Z, (-3.0, 3.0)),),
        geoms=(link,),
        bodies=(fingertip,),
    )
    inner = Body("body0", (0.0, 0.0, 0.01), joints=(Hinge("joint0", Z),), geoms=(link,), bodies=(outer,))
    target = Body(
        "target",
        (0.0, 0.0, 0.01),
        joints=(
            Hinge("target_x", X, (-0.27, 0.27), slides=True),
            Hinge("target_y", Y, (-0.27, 0.27), slides=True),
        ),
        geoms=(Geom("sphere", (0.009,), rgba=RED),),
    )
    ground = Geom("plane", (1.0, 1.0, 10.0), "ground", rgba=FLOOR)
    world = (ground, *sides, root, inner, target)
    return Model("reacher", "An arm of two links and a target to reach.", world, rgba=BLUE, touch=NOTHING)
