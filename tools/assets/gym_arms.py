"""The arms that push, strike and throw, which learning scripts load from MJCF files."""

from __future__ import annotations

from itertools import pairwise

from tools.assets.gym_runners import BLUE, GREY, MODEST, ORANGE, RED, X, Y, Z
from tools.assets.mjcf_text import Body, Geom, Hinge, Model
from tools.assets.parts import ZERO, Vector3

SOLID, GIVING_WAY, WALL = (1, 1), (1, 0), (0, 1)
"""Groups and masks: of what touches all, what others touch, and what touches others."""
UNTOUCHED = (0, 0)
Colour = tuple[float, float, float, float]
DARK = (0.15, 0.16, 0.18, 1.0)
FAR = (-10.3213, 10.3)
"""How far things slide [m]."""

TABLE = Geom("plane", (1.0, 1.0, 0.1), "table", (0.0, 0.5, -0.325), touch=SOLID)


def _rod(start: Vector3, end: Vector3, radius: float, touch: tuple[int, int] | None = None) -> Geom:
    return Geom("capsule", (radius,), ends=(start, end), touch=touch)


def _across(half: float, radius: float, touch: tuple[int, int] | None = None) -> Geom:
    """A capsule along y."""
    return _rod((0.0, -half, 0.0), (0.0, half, 0.0), radius, touch)


def _eyes() -> tuple[Geom, ...]:
    """Two eyes on top of the shoulder, with pupils."""
    return tuple(
        Geom("sphere", (radius,), pos=(x, y, 0.2), rgba=colour)
        for y, radius, colour in ((0.05, 0.05, GREY), (0.09, 0.03, DARK))
        for x in (-0.06, 0.06)
    )


def _arm(pan: tuple[float, float], lift: tuple[float, float], elbow: tuple[float, float], hand: Body) -> Body:
    """A shoulder with three joints, an elbow, a forearm that turns, and what is on it.

    Args:
        pan: Bounds of the first joint [rad].
        lift: Of the second.
        elbow: Of the elbow.
        hand: The forearm and all that it carries.
    """
    turning = _rod((-0.1, 0.0, 0.0), (0.1, 0.0, 0.0), 0.02)
    forearm_roll = Body(
        "forearm_roll_link",
        joints=(Hinge("forearm_roll_joint", X, (-1.5, 1.5)),),
        geoms=(turning,),
        bodies=(hand,),
    )
    elbow_flex = Body(
        "elbow_flex_link",
        (0.4, 0.0, 0.0),
        joints=(Hinge("elbow_flex_joint", Y, elbow),),
        geoms=(_across(0.02, 0.06),),
        bodies=(forearm_roll,),
    )
    upper_arm = Body("upper_arm_link", geoms=(_rod(ZERO, (0.4, 0.0, 0.0), 0.06),), bodies=(elbow_flex,))
    upper_arm_roll = Body(
        "upper_arm_roll_link",
        joints=(Hinge("upper_arm_roll_joint", X, (-1.5, 1.7)),),
        geoms=(turning,),
        bodies=(upper_arm,),
    )
    shoulder_lift = Body(
        "shoulder_lift_link",
        (0.1, 0.0, 0.0),
        joints=(Hinge("shoulder_lift_joint", Y, lift),),
        geoms=(_across(0.1, 0.1),),
        bodies=(upper_arm_roll,),
    )
    column = _rod((0.0, 0.0, -0.4), (0.0, 0.0, 0.2), 0.1)
    return Body(
        "shoulder_pan_link",
        (0.0, -0.6, 0.0),
        joints=(Hinge("shoulder_pan_joint", Z, pan),),
        geoms=(*_eyes(), column),
        bodies=(shoulder_lift,),
    )


def _straight_arm(fingertip: Geom | tuple[Geom, ...], *palm: Geom) -> Body:
    """The arm whose forearm goes straight on, with a wrist."""
    tip = Body("fingertip", geoms=fingertip if isinstance(fingertip, tuple) else (fingertip,))
    wrist_roll = Body(
        "wrist_roll_link",
        joints=(Hinge("wrist_roll_joint", X, (-1.5, 1.5)),),
        geoms=palm,
        bodies=(tip,),
    )
    wrist_flex = Body(
        "wrist_flex_link",
        (0.321, 0.0, 0.0),
        joints=(Hinge("wrist_flex_joint", Y, (-1.094, 0.0)),),
        geoms=(_across(0.02, 0.01),),
        bodies=(wrist_roll,),
    )
    forearm = Body("forearm_link", geoms=(_rod(ZERO, (0.291, 0.0, 0.0), 0.05),), bodies=(wrist_flex,))
    return _arm((-2.2854, 1.714602), (-0.5236, 1.3963), (-2.3213, 0.0), forearm)


def _sliding(name: str, pos: Vector3, *geoms: Geom) -> Body:
    """A thing that slides along x and y."""
    joints = (Hinge(f"{name}_x", X, FAR, slides=True), Hinge(f"{name}_y", Y, FAR, slides=True))
    return Body(name, pos, joints=joints, geoms=geoms)


def _disc(radius: float, half: float, rgba: Colour, touch: tuple[int, int]) -> Geom:
    return Geom("cylinder", (radius, half), rgba=rgba, touch=touch)


def _model(name: str, about: str, friction: Vector3, *world: Body | Geom) -> Model:
    return Model(name, about, world, friction, GREY, touch=UNTOUCHED)


def pusher() -> Model:
    """An arm with a fork, a cylinder to push and a disc to push it to."""
    prongs = (_rod((0.0, y, 0.0), (0.1, y, 0.0), 0.02, SOLID) for y in (-0.1, 0.1))
    tips = tuple(Geom("sphere", (0.01,), pos=(0.1, y, 0.0)) for y in (-0.1, 0.1))
    unseen = Geom("sphere", (0.05,), rgba=(1.0, 1.0, 1.0, 0.0))
    return _model(
        "pusher",
        "An arm that pushes a cylinder over a table.",
        MODEST,
        TABLE,
        _straight_arm(tips, _across(0.1, 0.02, SOLID), *prongs),
        _sliding("object", (0.45, -0.05, -0.275), unseen, _disc(0.05, 0.05, ORANGE, GIVING_WAY)),
        _sliding("target", (0.45, -0.05, -0.323), _disc(0.08, 0.001, RED, UNTOUCHED)),
    )


def striker() -> Model:
    """An arm with a paddle, a ball, and a goal of three boards, which coincide: PyBullet turns no bodies."""
    board = Geom("box", (0.032, 0.001, 0.04), pos=(0.0, 0.075, 0.04), rgba=BLUE, touch=WALL)
    side = Body("", geoms=(board,))
    coaster = Body("coaster", geoms=(_disc(0.08, 0.001, GREY, UNTOUCHED),))
    paddle = Geom("box", (0.003, 0.12, 0.05), pos=(0.017, 0.0, 0.0), touch=SOLID)
    goal = Body(
        "target",
        (0.0, 0.0, -0.323),
        geoms=(Geom("box", (0.01, 0.01, 0.01), rgba=(1.0, 1.0, 1.0, 0.0)),),
        bodies=(side, coaster, side, side),
        free="target_free",
    )
    ball = Geom("sphere", (0.05,), rgba=ORANGE, touch=GIVING_WAY)
    return _model(
        "striker",
        "An arm that strikes a ball into a goal.",
        ZERO,
        TABLE,
        _straight_arm(paddle, _across(0.1, 0.02, SOLID)),
        _sliding("object", (0.0, 0.0, -0.27), ball),
        goal,
    )


def _claw(name: str = "") -> Body:
    """One of the bent wires that hold the ball."""
    bends = ((0.0, 0.025, 0.0), (0.0, 0.075, 0.075), (0.0, 0.075, 0.15), (0.0, 0.0, 0.225))
    wires = tuple(_rod(start, end, 0.005, SOLID) for start, end in pairwise(bends))
    return Body(name, geoms=wires)


def _basket() -> tuple[Geom, ...]:
    """A floor, four walls and posts in the corners."""
    floor = Geom("box", (0.075, 0.075, 0.001), pos=(0.0, 0.0, 0.005), rgba=BLUE, touch=SOLID)
    walls = (
        Geom("box", size, pos=(x, y, 0.034), rgba=BLUE, touch=GIVING_WAY)
        for size, x, y in (
            ((0.075, 0.001, 0.03), 0.0, 0.075),
            ((0.075, 0.001, 0.03), 0.0, -0.075),
            ((0.001, 0.075, 0.03), 0.075, 0.0),
            ((0.001, 0.075, 0.03), -0.076, 0.0),
        )
    )
    posts = (
        _rod((x, y, 0.0075), (x, y, 0.06), 0.005, GIVING_WAY)
        for x in (0.073, -0.073)
        for y in (0.073, -0.073)
    )
    return floor, *walls, *posts


def thrower() -> Model:
    """An arm with a claw of seven wires, which coincide likewise, a ball, and a basket."""
    wrist_roll = Body(
        "wrist_roll_link",
        joints=(Hinge("wrist_roll_joint", Y, (0.0, 2.25)),),
        geoms=(_across(0.05, 0.01, SOLID),),
        bodies=(_claw("fingertip"), *(_claw() for _ in range(6))),
    )
    wrist_flex = Body(
        "wrist_flex_link",
        (0.0, 0.0, 0.321),
        joints=(Hinge("wrist_flex_joint", Z, (-1.0, 1.0)),),
        geoms=(_across(0.02, 0.01),),
        bodies=(wrist_roll,),
    )
    forearm = Body(
        "forearm_link",
        geoms=(_rod(ZERO, (0.0, 0.0, 0.291), 0.05),),
        bodies=(wrist_flex,),
    )
    ball = Geom("sphere", (0.03,), rgba=ORANGE, touch=SOLID)
    return _model(
        "thrower",
        "An arm that throws a ball into a basket.",
        MODEST,
        Geom("plane", (1.0, 1.0, 0.1), pos=(0.0, 0.5, -0.325), touch=SOLID),
        _arm((-0.4854, 1.214602), (-0.5236, 0.7963), (-0.7, 0.7), forearm),
        Body("object", (0.5, -0.8, 0.275), geoms=(ball,), free="object_free"),
        _sliding("target", (0.575, 0.5, -0.328), *_basket()),
    )
