"""The Franka Emika Panda arm with its hand.

Frames follow the maker's modified Denavit-Hartenberg table. Bounds are those PyBullet reports for the
links of its own file; our shapes span the same, so that the default inertias agree.
"""

from __future__ import annotations

from tools.assets.envelope import Envelope
from tools.assets.obj_mesh import ObjMesh
from tools.assets.parts import (
    HALF_TURN,
    QUARTER_TURN,
    ZERO,
    Box,
    Inertial,
    Joint,
    Link,
    Mesh,
    Paint,
    Robot,
    Shape,
    Vector3,
    diagonal,
)
from tools.assets.simple_meshes import blocks

WHITE = Paint("panda_white", (1.0, 1.0, 1.0, 1.0), (0.4, 0.4, 0.4))
DARK = Paint("panda_dark", (0.5, 0.5, 0.54, 1.0), (0.3, 0.3, 0.3))
METAL = Paint("panda_metal", (0.98, 0.98, 0.98, 1.0), (0.6, 0.6, 0.6))
FINGER_CONTACT = {
    "friction_anchor": None,
    "stiffness": 30000.0,
    "damping": 1000.0,
    "spinning_friction": 0.1,
    "lateral_friction": 1.0,
}

BOUNDS = {
    "link0": Envelope(
        (-0.1580790020404, -0.09861370056429, -0.004032494264987),
        (0.07556700204039, 0.09867040056429, 0.144002994265),
    ),
    "link1": Envelope(
        (-0.0589869994513, -0.1333729991296, -0.1960039972804),
        (0.0591611994513, 0.05919229912963, 0.05897309728043),
    ),
    "link2": Envelope(
        (-0.05915340040314, -0.1980100124235, -0.05909660240834),
        (0.05898490040314, 0.05921999242352, 0.1334890024083),
    ),
    "link3": Envelope(
        (-0.0586458062667, -0.05891720067463, -0.1250179892558),
        (0.1415609862667, 0.1152030006746, 0.05915640925582),
    ),
    "link4": Envelope(
        (-0.1416069869827, -0.05914973938371, -0.05920659980457),
        (0.05913950698269, 0.1280089593837, 0.1150519998046),
    ),
    "link5": Envelope(
        (-0.05901650025694, -0.05912790102251, -0.2685539762265),
        (0.05908340025694, 0.1339040010225, 0.05616831622653),
    ),
    "link6": Envelope(
        (-0.05192200247669, -0.05520895929631, -0.04824199921596),
        (0.1363090024767, 0.08564803929631, 0.06039599921596),
    ),
    "link7": Envelope(
        (-0.04803460007477, -0.04802960065117, 0.04799049230503),
        (0.08530610007477, 0.08518730065117, 0.110836987695),
    ),
    "hand": Envelope(
        (-0.03563590012615, -0.1079900034018, -0.02992480140542),
        (0.03561580012615, 0.1044260034018, 0.06996220140542),
    ),
}


FINGER_BLOCKS = (
    ((-0.0104795, 0.0025, 0.000131696), (0.0104948, 0.0264034, 0.0185)),
    ((-0.0088, -0.000132643, 0.036), (0.0088, 0.0143, 0.053849)),
)
"""Opposite corners of the finger's root and of its pad, whose face all but lies in the plane y = 0."""


def finger_hull() -> ObjMesh:
    """What a finger touches with: the convex hull of its root and pad."""
    return blocks(FINGER_BLOCKS, decimals=9)


def _touching() -> dict[str, tuple[Shape, ...]]:
    """Collision shapes: capsules along tubes and housings, boxes for foot, flange and hand.

    The fingers are hulls, the only shapes whose faces lie where the original's do: they decide how it grasps.
    """
    foot, one, two, three, four = (BOUNDS[f"link{number}"] for number in range(5))
    five, six, seven = (BOUNDS[f"link{number}"] for number in range(5, 8))
    finger = Mesh("meshes/finger.obj")
    tube = one.width("x") / 2.0
    bar = two.width("x") / 2.0
    forearm = five.width("x") / 2.0
    return {
        "link0": (
            foot.box(z=(None, 0.06)),
            foot.box(x=(-0.07, 0.07), y=(-0.07, 0.07), z=(0.06, None)),
        ),
        "link1": (
            one.capsule("z", tube, x="low", y="high"),
            one.capsule("y", tube, x="low", z="high"),
        ),
        "link2": (
            two.capsule("y", bar, x="low", z="low"),
            two.capsule("z", bar, x="low", y="high"),
        ),
        "link3": (
            three.capsule("z", 0.058, x="low", y="low", stop=0.05),
            three.capsule("y", 0.058, x="high", z="high"),
        ),
        "link4": (
            four.capsule("y", 0.058, x="low", z="low"),
            four.capsule("z", 0.058, x="high", y="low"),
        ),
        "link5": (
            five.capsule("z", forearm, x="low", y="low", stop=-0.06),
            five.capsule("z", 0.04, x=0.0, y="high", start=-0.2),
        ),
        "link6": (
            six.capsule("z", 0.05, x="low", y=0.0),
            six.capsule("y", 0.046, x="high", z=0.006),
        ),
        "link7": (
            seven.box(x=(None, 0.045), y=(None, 0.045)),
            seven.box(x=(0.0, None), y=(0.0, None), z=(0.06, 0.1)),
        ),
        "hand": (BOUNDS["hand"].box(),),
        "leftfinger": (Shape(finger),),
        "rightfinger": (Shape(finger, rpy=(0.0, 0.0, HALF_TURN)),),
    }


def _housing(name: str, paint: Paint = WHITE) -> Shape:
    return Shape(Mesh(f"meshes/{name}.obj"), paint=paint)


def _seen() -> dict[str, tuple[Shape, ...]]:
    """What the links look like: light housings with dark caps."""
    return {
        **{name: (_housing(name),) for name in ("link0", "link1", "link2")},
        "link3": (_housing("link3"), _housing("link3_dark", DARK)),
        "link4": (_housing("link4"), _housing("link4_dark", DARK)),
        "link5": (_housing("link5"), _housing("link5_dark", DARK)),
        "link6": (_housing("link6"), _housing("link6_dark", DARK)),
        "link7": (Shape(Mesh("meshes/link7.obj"), rpy=(0.0, 0.0, QUARTER_TURN / 2.0), paint=WHITE),),
        "hand": (
            _housing("hand"),
            Shape(Box((0.04, 0.14, 0.012)), (0.0, 0.0, 0.021), paint=DARK),
            Shape(Box((0.013, 0.045, 0.01)), (0.0, -0.065, -0.019), paint=DARK),
        ),
        "leftfinger": _finger(1.0),
        "rightfinger": _finger(-1.0),
    }


def _finger(side: float) -> tuple[Shape, ...]:
    """A finger whose pad faces the plane y = 0; `side` is where it stands."""
    return (
        Shape(Box((0.0194, 0.0228, 0.004)), (0.0, side * 0.0146, 0.0028), paint=METAL),
        Shape(Box((0.0194, 0.0145, 0.0146)), (0.0, side * 0.0186, 0.0121), paint=METAL),
        Shape(Box((0.0186, 0.0076, 0.0212)), (0.0, side * 0.0162, 0.0283), (side * 0.45, 0.0, 0.0), METAL),
        Shape(Box((0.0174, 0.0085, 0.0168)), (0.0, side * 0.0045, 0.0451), paint=DARK),
        Shape(Box((0.0172, 0.0061, 0.0166)), (0.0, side * 0.0118, 0.0451), paint=METAL),
    )


def _arm_joint(
    number: int,
    xyz: Vector3,
    roll: float,
    limits: tuple[float, float],
    soft: tuple[float, float],
    drive: tuple[float, float],
) -> Joint:
    return Joint(
        f"panda_joint{number}",
        "revolute",
        f"panda_link{number - 1}",
        f"panda_link{number}",
        xyz,
        (roll, 0.0, 0.0),
        (0.0, 0.0, 1.0),
        {"lower": limits[0], "upper": limits[1], "effort": drive[0], "velocity": drive[1]},
        soft_limits=(soft[0], soft[1], 100.0, 40.0),
    )


def _finger_joint(number: int, link: str, side: float, mimic: str | None) -> Joint:
    limit = {"lower": 0.0, "upper": 0.04, "effort": 20.0, "velocity": 0.2}
    return Joint(
        f"panda_finger_joint{number}",
        "prismatic",
        "panda_hand",
        link,
        (0.0, 0.0, 0.0584),
        axis=(0.0, side, 0.0),
        limit=limit,
        mimic=mimic,
    )


def panda() -> Robot:
    """Seven turning joints, a flange, and a hand with two sliding fingers."""
    masses: dict[str, tuple[float, Vector3]] = {
        "link0": (2.9, (0.0, 0.0, 0.05)),
        "link1": (2.7, (0.0, -0.04, -0.05)),
        "link2": (2.73, (0.0, -0.04, 0.06)),
        "link3": (2.04, (0.01, 0.01, -0.05)),
        "link4": (2.08, (-0.03, 0.03, 0.02)),
        "link5": (3.0, (0.0, 0.04, -0.12)),
        "link6": (1.3, (0.04, 0.0, 0.0)),
        "link7": (0.2, (0.0, 0.0, 0.08)),
        "link8": (0.0, ZERO),
        "hand": (0.81, (0.0, 0.0, 0.04)),
        "leftfinger": (0.1, (0.0, 0.01, 0.02)),
        "rightfinger": (0.1, (0.0, -0.01, 0.02)),
        "grasptarget": (0.0, ZERO),
    }
    seen, touching = _seen(), _touching()
    links = tuple(
        Link(
            f"panda_{name}",
            Inertial(mass, centre, tensor=diagonal(0.1, 0.1, 0.1)),
            seen.get(name, ()),
            touching.get(name, ()),
            FINGER_CONTACT if "finger" in name else {},
        )
        for name, (mass, centre) in masses.items()
    )
    wide, strong, quick = (-2.9671, 2.9671), (87.0, 2.175), (12.0, 2.61)
    soft = (-2.8973, 2.8973)
    joints = (
        _arm_joint(1, (0.0, 0.0, 0.333), 0.0, wide, soft, strong),
        _arm_joint(2, ZERO, -QUARTER_TURN, (-1.8326, 1.8326), (-1.7628, 1.7628), strong),
        _arm_joint(3, (0.0, -0.316, 0.0), QUARTER_TURN, wide, soft, strong),
        _arm_joint(4, (0.0825, 0.0, 0.0), QUARTER_TURN, (-3.1416, 0.0), (-3.0718, -0.0698), strong),
        _arm_joint(5, (-0.0825, 0.384, 0.0), -QUARTER_TURN, wide, soft, quick),
        _arm_joint(6, ZERO, QUARTER_TURN, (-0.0873, 3.8223), (-0.0175, 3.7525), quick),
        _arm_joint(7, (0.088, 0.0, 0.0), QUARTER_TURN, wide, soft, quick),
        Joint("panda_joint8", "fixed", "panda_link7", "panda_link8", (0.0, 0.0, 0.107), axis=ZERO),
        Joint("panda_hand_joint", "fixed", "panda_link8", "panda_hand", rpy=(0.0, 0.0, -0.785398163397)),
        _finger_joint(1, "panda_leftfinger", 1.0, None),
        _finger_joint(2, "panda_rightfinger", -1.0, "panda_finger_joint1"),
        Joint("panda_grasptarget_hand", "fixed", "panda_hand", "panda_grasptarget", (0.0, 0.0, 0.105)),
    )
    about = "Franka Emika Panda with hand: seven turning joints and two sliding fingers."
    return Robot("panda", about, links, joints)
