"""The R2D2 of the ROS tutorials: a body on two legs with wheels, a turning head and a gripper on a pole."""

from __future__ import annotations

from dataclasses import replace

from tools.assets.envelope import Envelope
from tools.assets.parts import (
    QUARTER_TURN,
    ZERO,
    Box,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    Link,
    Paint,
    Robot,
    Shape,
    Sphere,
    Vector3,
    diagonal,
)

ABOUT_RIGHT_ANGLE = 1.57075
"""The angle the robot's joints are turned by; a little less than a quarter turn."""

BLUE = Paint("blue", (0.0, 0.0, 0.8, 1.0), (0.3, 0.3, 0.3))
WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0), (0.3, 0.3, 0.3))
SILVER = Paint("Gray", (0.7, 0.72, 0.75, 1.0), (0.6, 0.6, 0.6))
GREY = Paint("grey", (0.5, 0.5, 0.5, 1.0))
BLACK = Paint("black", (0.15, 0.15, 0.17, 1.0))
RED = Paint("red", (0.8, 0.1, 0.08, 1.0), (0.5, 0.5, 0.5))

# Principal inertias PyBullet finds for the meshes of its own file, and where the meshes are centred.
JAW_INERTIA: dict[str, Vector3] = {
    "left": (3.113503569557e-05, 6.670314151206e-05, 6.631698389751e-05),
    "right": (3.114061725808e-05, 6.670593375015e-05, 6.631977729733e-05),
}
PAD_INERTIA: dict[str, Vector3] = {
    "left": (1.422365875431e-05, 1.993430405723e-05, 2.716658913896e-05),
    "right": (1.422580525347e-05, 1.993539418067e-05, 2.716764551468e-05),
}
JAW_CENTRE: Vector3 = (0.0431122, 0.0183957, 0.0)
PAD_CENTRE: dict[str, Vector3] = {"left": (0.0941831, 0.0113802, 0.0), "right": (0.0941831, -0.00148, 0.0)}

UNIT_INERTIA = diagonal(1.0, 1.0, 1.0)
ON_SIDE: Vector3 = (0.0, ABOUT_RIGHT_ANGLE, 0.0)
FACING_Y: Vector3 = (QUARTER_TURN, 0.0, 0.0)


def _link(
    name: str, mass: float, touching: tuple[Shape, ...], seen: tuple[Shape, ...], **place: Vector3
) -> Link:
    return Link(name, Inertial(mass, tensor=UNIT_INERTIA, **place), seen, touching)


def _one(geometry: Geometry, xyz: Vector3 = ZERO, rpy: Vector3 = ZERO) -> tuple[Shape, ...]:
    return (Shape(geometry, xyz, rpy),)


def _body() -> Link:
    panels = tuple(
        Shape(Box((width, 0.014, height)), (x, 0.196, z), paint=SILVER)
        for x, z, width, height in ((-0.05, 0.0, 0.06, 0.2), (0.05, 0.0, 0.06, 0.2), (0.0, -0.2, 0.14, 0.07))
    )
    back = Shape(Box((0.16, 0.014, 0.3)), (0.0, -0.195, -0.03), paint=SILVER)
    seen = (
        Shape(Cylinder(0.2, 0.52), (0.0, 0.0, -0.01), paint=BLUE),
        Shape(Cylinder(0.207, 0.03), (0.0, 0.0, 0.22), paint=SILVER),
        Shape(Cylinder(0.19, 0.05), (0.0, 0.0, 0.275), paint=SILVER),
        Shape(Cylinder(0.17, 0.03), (0.0, 0.0, -0.285), paint=SILVER),
        *panels,
        back,
    )
    return _link("base_link", 10.0, _one(Cylinder(0.17, 0.6)), seen)


def _leg(side: str) -> tuple[Link, Link]:
    outward = 1.0 if side == "right" else -1.0
    centre = (0.0, 0.0, -0.3)
    leg = _link(
        f"{side}_leg",
        10.0,
        _one(Box((0.6, 0.2, 0.1)), centre, ON_SIDE),
        (
            Shape(Box((0.1, 0.2, 0.6)), centre, paint=WHITE),
            Shape(Box((0.012, 0.09, 0.34)), (outward * 0.05, 0.0, -0.33), paint=BLUE),
            Shape(Cylinder(0.07, 0.012), (outward * 0.05, 0.0, -0.08), (0.0, QUARTER_TURN, 0.0), SILVER),
        ),
        xyz=centre,
        rpy=ON_SIDE,
    )
    foot = _link(
        f"{side}_base",
        10.0,
        _one(Box((0.1, 0.4, 0.1))),
        (
            Shape(Box((0.1, 0.4, 0.1)), paint=WHITE),
            Shape(Box((0.012, 0.26, 0.05)), (outward * 0.05, 0.0, 0.0), paint=BLUE),
        ),
    )
    return leg, foot


def _wheel(side: str, end: str) -> Link:
    seen = (Shape(Cylinder(0.035, 0.1), paint=GREY), Shape(Cylinder(0.018, 0.104), paint=SILVER))
    return _link(f"{side}_{end}_wheel", 1.0, _one(Cylinder(0.035, 0.1)), seen)


def _pole() -> Link:
    place, turned = (0.1, 0.0, 0.0), (0.0, ABOUT_RIGHT_ANGLE, 0.0)
    seen = (
        Shape(Cylinder(0.01, 0.2), place, turned, SILVER),
        Shape(Box((0.03, 0.07, 0.03)), (0.19, 0.0, 0.0), paint=BLACK),
    )
    return _link("gripper_pole", 0.05, _one(Cylinder(0.01, 0.2), place, turned), seen)


def _finger(side: str) -> tuple[Link, Link]:
    """The swinging jaw and the pad at its end."""
    x, y, z = JAW_CENTRE
    left = side == "left"
    jaw = Envelope.of_inertia((x, y if left else -y, z), JAW_INERTIA[side], 0.05)
    pad = Envelope.of_inertia(PAD_CENTRE[side], PAD_INERTIA[side], 0.05)
    near, far = ((None, 0.03), (0.012, None)) if left else ((-0.03, None), (None, -0.012))
    root = jaw.box(x=(None, 0.04), y=near)
    reach = jaw.box(x=(0.0, None), y=far, z=(-0.018, 0.018))
    tip = pad.box(x=(0.08, None))
    heel = pad.box(x=(None, 0.085), z=(-0.01, 0.01))
    return (
        _link(
            f"{side}_gripper", 0.05, (root, reach), (replace(root, paint=BLACK), replace(reach, paint=SILVER))
        ),
        _link(f"{side}_tip", 0.05, (tip, heel), (replace(tip, paint=BLACK), replace(heel, paint=SILVER))),
    )


def _head() -> tuple[Link, Link]:
    bands = tuple(
        Shape(Cylinder(radius, 0.014), (0.0, 0.0, z), paint=BLUE)
        for z, radius in ((0.035, 0.159), (0.128, 0.104))
    )
    head = _link(
        "head",
        10.0,
        _one(Sphere(0.16)),
        (
            Shape(Sphere(0.16), paint=WHITE),
            *bands,
            Shape(Sphere(0.018), (0.055, 0.14, 0.062), paint=RED),
            Shape(Sphere(0.02), (-0.1, 0.09, 0.09), paint=BLACK),
        ),
    )
    eye = _link(
        "box",
        1.0,
        _one(Box((0.08, 0.08, 0.08))),
        (
            Shape(Box((0.08, 0.08, 0.08)), paint=BLUE),
            Shape(Cylinder(0.03, 0.012), (0.0, 0.037, 0.0), FACING_Y, SILVER),
            Shape(Sphere(0.024), (0.0, 0.03, 0.0), paint=BLACK),
        ),
    )
    return head, eye


def _wheel_joint(side: str, end: str) -> Joint:
    forward = 0.133333333333 if end == "front" else -0.133333333333
    return Joint(
        f"{side}_{end}_wheel_joint",
        "continuous",
        f"{side}_base",
        f"{side}_{end}_wheel",
        (0.0, forward, -0.085),
        (0.0, ABOUT_RIGHT_ANGLE, 0.0),
        (0.0, 0.0, 1.0),
        {"effort": 100.0, "velocity": 100.0},
    )


def _leg_joints(side: str) -> tuple[Joint, ...]:
    outward = 0.22 if side == "right" else -0.22
    return (
        Joint(f"base_to_{side}_leg", "fixed", "base_link", f"{side}_leg", (outward, 0.0, 0.25)),
        Joint(f"{side}_base_joint", "fixed", f"{side}_leg", f"{side}_base", (0.0, 0.0, -0.6)),
        _wheel_joint(side, "front"),
        _wheel_joint(side, "back"),
    )


def _finger_joints(side: str) -> tuple[Joint, Joint]:
    sign = 1.0 if side == "left" else -1.0
    limit = {"lower": 0.0, "upper": 0.548, "effort": 1000.0, "velocity": 0.5}
    place = (0.2, sign * 0.02, 0.0)
    return (
        Joint(
            f"{side}_gripper_joint",
            "revolute",
            "gripper_pole",
            f"{side}_gripper",
            place,
            axis=(0.0, 0.0, sign),
            limit=limit,
        ),
        Joint(f"{side}_tip_joint", "fixed", f"{side}_gripper", f"{side}_tip"),
    )


def r2d2() -> Robot:
    """The whole robot; it faces along y."""
    reach = {"lower": -0.38, "upper": 0.0, "effort": 1000.0, "velocity": 0.5}
    pole_joint = Joint(
        "gripper_extension",
        "prismatic",
        "base_link",
        "gripper_pole",
        (0.0, 0.19, 0.2),
        (0.0, 0.0, ABOUT_RIGHT_ANGLE),
        (1.0, 0.0, 0.0),
        reach,
    )
    swivel = Joint(
        "head_swivel", "continuous", "base_link", "head", (0.0, 0.0, 0.3), axis=(0.0, 0.0, 1.0), limit=reach
    )
    legs = [(*_leg(side), _wheel(side, "front"), _wheel(side, "back")) for side in ("right", "left")]
    links = (_body(), *legs[0], *legs[1], _pole(), *_finger("left"), *_finger("right"), *_head())
    joints = (
        *_leg_joints("right"),
        *_leg_joints("left"),
        pole_joint,
        *_finger_joints("left"),
        *_finger_joints("right"),
        swivel,
        Joint("tobox", "fixed", "head", "box", (0.0, 0.1214, 0.1214)),
    )
    return Robot(
        "physics", "R2D2: two legs on wheels, a turning head and a gripper on a pole.", links, joints
    )
