"""The KUKA LBR iiwa arm, and the variants of it that scripts load.

Bounds are those PyBullet reports for the links of its own file; our shapes span the same, so that the
default inertias agree.
"""

from __future__ import annotations

from dataclasses import replace

from tools.assets.envelope import Envelope
from tools.assets.parts import (
    HALF_TURN,
    QUARTER_TURN,
    ZERO,
    Box,
    Cylinder,
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

ORANGE = Paint("Orange", (1.0, 0.423529411765, 0.0392156862745, 1.0), (0.4, 0.4, 0.4))
GREY = Paint("Grey", (0.2, 0.2, 0.2, 1.0), (0.2, 0.2, 0.2))
BLUE = Paint("Blue", (0.5, 0.7, 1.0, 1.0), (0.4, 0.4, 0.4))
PAINTS = (GREY, BLUE, BLUE, ORANGE, BLUE, BLUE, ORANGE, GREY)
"""Colours of the links."""

BOUNDS = (
    Envelope(
        (-0.1390045091172, -0.1243678386512, -0.003003383214779),
        (0.1242489291172, 0.1243888186512, 0.1605007432148),
    ),
    Envelope(
        (-0.08850494214082, -0.1185745339065, -0.013000096695),
        (0.08855944214082, 0.08849741390652, 0.290945416695),
    ),
    Envelope(
        (-0.0881484409854, -0.08865719291942, -0.07119815367643),
        (0.0886155209854, 0.2075023529194, 0.1351223136764),
    ),
    Envelope(
        (-0.07101824127509, -0.07100864370474, -0.01300012587449),
        (0.07102248127509, 0.1176394637047, 0.2863206258745),
    ),
    Envelope(
        (-0.07107593529752, -0.07089787600513, -0.07107132131945),
        (0.07105437529752, 0.1875019560051, 0.1174976013194),
    ),
    Envelope(
        (-0.07098761887285, -0.07101831209374, -0.0130002011139),
        (0.07122867887285, 0.1019332920937, 0.2700352811139),
    ),
    Envelope(
        (-0.06906574397256, -0.08947184196361, -0.07370003125933),
        (0.06925520397256, 0.08390118196361, 0.06998397125933),
    ),
    Envelope(
        (-0.05506049080507, -0.05466416738323, -0.01290008422874),
        (0.05500065080507, 0.05496908738323, 0.04801604422874),
    ),
)

MASSES: tuple[tuple[float, Vector3, Vector3], ...] = (
    (0.0, (-0.1, 0.0, 0.07), (0.05, 0.06, 0.03)),
    (4.0, (0.0, -0.03, 0.12), (0.1, 0.09, 0.02)),
    (4.0, (0.0003, 0.059, 0.042), (0.05, 0.018, 0.044)),
    (3.0, (0.0, 0.03, 0.13), (0.08, 0.075, 0.01)),
    (2.7, (0.0, 0.067, 0.034), (0.03, 0.01, 0.029)),
    (1.7, (0.0001, 0.021, 0.076), (0.02, 0.018, 0.005)),
    (1.8, (0.0, 0.0006, 0.0004), (0.005, 0.0036, 0.0047)),
    (0.3, (0.0, 0.0, 0.02), (0.001, 0.001, 0.001)),
)
"""Mass, centre of mass and principal inertias of each link."""

WIDE = (-2.96705972839, 2.96705972839)
NARROW = (-2.09439510239, 2.09439510239)
LIMITS: dict[int, tuple[float, float]] = {
    1: WIDE,
    2: NARROW,
    3: WIDE,
    4: NARROW,
    5: WIDE,
    6: NARROW,
    7: (-3.05432619099, 3.05432619099),
}
VR_LIMITS = LIMITS | {1: (-0.96705972839, 0.96705972839), 4: (0.19439510239, 2.29439510239)}

JOINT_FRAMES: tuple[tuple[Vector3, Vector3], ...] = (
    ((0.0, 0.0, 0.1575), ZERO),
    ((0.0, 0.0, 0.2025), (QUARTER_TURN, 0.0, HALF_TURN)),
    ((0.0, 0.2045, 0.0), (QUARTER_TURN, 0.0, HALF_TURN)),
    ((0.0, 0.0, 0.2155), (QUARTER_TURN, 0.0, 0.0)),
    ((0.0, 0.1845, 0.0), (-QUARTER_TURN, HALF_TURN, 0.0)),
    ((0.0, 0.0, 0.2155), (QUARTER_TURN, 0.0, 0.0)),
    ((0.0, 0.081, 0.0), (-QUARTER_TURN, HALF_TURN, 0.0)),
)


def _touching() -> tuple[tuple[Shape, ...], ...]:
    """Collision shapes: capsules along the tubes and housings, boxes for foot and flange."""
    foot, one, two, three, four, five, six, flange = BOUNDS
    r1, r2, r3, r4, r5 = (link.width("x") / 2.0 for link in (one, two, three, four, five))
    turned = Shape(
        Box((0.075, 0.075, flange.width("z"))), (0.0, 0.0, 0.01755798), (0.0, 0.0, QUARTER_TURN / 2.0)
    )
    return (
        (
            foot.box(z=(None, 0.08)),
            foot.box(x=(-0.09, 0.09), y=(-0.09, 0.09), z=(0.08, None)),
        ),
        (one.capsule("z", r1, x="low", y="high"), one.capsule("y", r1, x="low", z="high")),
        (two.capsule("z", r2, x="low", y="low"), two.capsule("y", 0.07, x=0.0, z="low")),
        (three.capsule("z", r3, x="low", y="low"), three.capsule("y", 0.068, x=0.0, z="high")),
        (four.capsule("z", r4, x="low", y="low"), four.capsule("y", 0.069, x=0.0, z="low")),
        (
            five.capsule("z", r5, x="low", y="low", stop=0.16),
            five.capsule("z", 0.045, x=0.0, y="high", start=0.08),
        ),
        (six.capsule("y", six.width("x") / 2.0, x="low", z="high"), six.capsule("z", 0.06, x=0.0, y=0.0)),
        (
            flange.box(y=(-0.0225, 0.0225)),
            flange.box(x=(-0.0225, 0.0225)),
            turned,
        ),
    )


def _seen() -> tuple[tuple[Shape, ...], ...]:
    """What the links look like: housings, some with a stub towards the link before, in one colour each."""

    def housing(number: int) -> Shape:
        return Shape(Mesh(f"meshes/link_{number}.obj"))

    stub = Shape(Cylinder(0.0255, 0.0095), (0.0, 0.0, -0.00375))
    links = (
        (housing(0),),
        (housing(1), stub),
        (housing(2),),
        (housing(3), stub),
        (housing(4),),
        (housing(5), stub),
        (housing(6),),
        (housing(7),),
    )
    return tuple(
        tuple(replace(shape, paint=paint) for shape in shapes)
        for shapes, paint in zip(links, PAINTS, strict=True)
    )


def _arm(limits: dict[int, tuple[float, float]], base_mass: float, about: str) -> Robot:
    links = tuple(
        Link(
            f"lbr_iiwa_link_{number}",
            Inertial(mass if number else base_mass, centre, tensor=diagonal(*moments)),
            seen,
            touching,
        )
        for number, ((mass, centre, moments), seen, touching) in enumerate(
            zip(MASSES, _seen(), _touching(), strict=True)
        )
    )
    joints = tuple(
        Joint(
            f"lbr_iiwa_joint_{number}",
            "revolute",
            f"lbr_iiwa_link_{number - 1}",
            f"lbr_iiwa_link_{number}",
            xyz,
            rpy,
            (0.0, 0.0, 1.0),
            {"lower": limits[number][0], "upper": limits[number][1], "effort": 300.0, "velocity": 10.0},
            damping=0.5,
        )
        for number, (xyz, rpy) in enumerate(JOINT_FRAMES, start=1)
    )
    return Robot("lbr_iiwa", about, links, joints)


def model() -> Robot:
    """The arm, its foot bolted to the world by having no mass."""
    return _arm(LIMITS, 0.0, "KUKA LBR iiwa: seven turning joints; the foot has no mass and stays put.")


def model_vr_limits() -> Robot:
    """The arm with the narrower limits of the virtual-reality examples."""
    return _arm(VR_LIMITS, 0.0, "KUKA LBR iiwa with narrower limits at joints 1 and 4.")


def model_free_base() -> Robot:
    """The arm with a light foot that may move."""
    return _arm(LIMITS, 0.1, "KUKA LBR iiwa with a foot that is free to move.")
