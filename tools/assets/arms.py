"""Small machines for first experiments: pendulums, a cart with a pole, arms with one and two joints."""

from __future__ import annotations

from tools.assets.parts import (
    ALONG_Y,
    Box,
    Capsule,
    Cylinder,
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

BLUE = Paint("blue", (0.13, 0.3, 0.75, 1.0), (0.3, 0.3, 0.3))
WHITE = Paint("white", (0.95, 0.95, 0.95, 1.0), (0.3, 0.3, 0.3))
ORANGE = Paint("orange", (0.95, 0.5, 0.12, 1.0), (0.3, 0.3, 0.3))
TEAL = Paint("green", (0.0, 0.8, 0.8, 1.0))
GREY = Paint("grey", (0.3, 0.32, 0.35, 1.0), (0.4, 0.4, 0.4))
RED = Paint("red", (0.85, 0.15, 0.1, 1.0), (0.3, 0.3, 0.3))
UP, FORWARD, SIDEWAYS = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def cartpole() -> Robot:
    """A cart on a rail with an unbalanced pole; the rail stays put because it has no mass."""
    rail = Link("slideBar", Inertial(0.0), (Shape(Box((30.0, 0.05, 0.05)), paint=TEAL),))
    hub = Shape(Cylinder(0.06, 0.52), rpy=ALONG_Y, paint=GREY)
    cart_box = Box((0.5, 0.5, 0.2))
    cart = Link("cart", Inertial(1.0), (Shape(cart_box, paint=BLUE), hub), (Shape(cart_box),))
    middle = (0.0, 0.0, 0.5)
    pole_box = Box((0.05, 0.05, 1.0))
    knob = Shape(Sphere(0.035), (0.0, 0.0, 1.0), paint=RED)
    pole = Link(
        "pole",
        Inertial(0.1, middle),
        (Shape(pole_box, middle, paint=WHITE), knob),
        (Shape(pole_box, middle),),
    )
    travel = {"lower": -15.0, "upper": 15.0, "effort": 1000.0, "velocity": 5.0}
    joints = (
        Joint("slider_to_cart", "prismatic", "slideBar", "cart", axis=FORWARD, limit=travel),
        Joint("cart_to_pole", "continuous", "cart", "pole", axis=SIDEWAYS),
    )
    return Robot("physics", "A cart on a rail, with a pole hinged to it.", (rail, cart, pole), joints)


def pendulum5() -> Robot:
    """Five balls, each half a metre from the last."""
    place = (0.0, 0.5, 0.0)
    first, later = diagonal(0.00494875, 0.00494174, 0.002219), diagonal(0.00539427, 0.0048979, 0.00311573)
    rod = Shape(Cylinder(0.012, 0.5), (0.0, 0.25, 0.0), ALONG_Y, GREY)
    links: list[Link] = [Link("world")]
    joints: list[Joint] = []
    for i in range(5):
        ball = Shape(Sphere(0.05), place, paint=BLUE if i == 0 else ORANGE)
        inertial = Inertial(2.16 if i else 1.0, place, tensor=later if i else first)
        links.append(Link(f"link{i}", inertial, (ball, rod), (Shape(Sphere(0.05), place),)))
        parent = f"link{i - 1}" if i else "world"
        start = place if i else (0.0, 0.0, 0.0)
        joints.append(
            Joint(
                f"joint{i}", "continuous", parent, f"link{i}", start, axis=FORWARD, damping=1.0, friction=1.0
            )
        )
    return Robot("pendulum", "Five balls on rods, hinged one below the other.", tuple(links), tuple(joints))


def rrbot() -> Robot:
    """The two-joint arm of the Gazebo tutorials, with its camera and laser mounts."""
    links = (
        Link("world"),
        _rrbot_beam("link1", 2.0, 1.0, (0.334167, 0.00166667), ORANGE, 0.0),
        _rrbot_beam("link2", 1.0, 0.45, (0.0841667, 0.00166667), GREY, 0.0),
        _rrbot_beam("link3", 1.0, 0.45, (0.0841667, 0.00166667), ORANGE, 0.0),
        _rrbot_mount("hokuyo_link", Box((0.1, 0.1, 0.1)), GREY),
        _rrbot_mount("camera_link", Box((0.05, 0.05, 0.05)), RED),
    )
    swing = {"axis": SIDEWAYS, "damping": 0.7}
    joints = (
        Joint("fixed", "fixed", "world", "link1"),
        Joint("joint1", "continuous", "link1", "link2", (0.0, 0.1, 1.95), **swing),
        Joint("joint2", "continuous", "link2", "link3", (0.0, 0.1, 0.9), **swing),
        Joint("hokuyo_joint", "fixed", "link3", "hokuyo_link", (0.0, 0.0, 0.975), axis=SIDEWAYS),
        Joint("camera_joint", "fixed", "link3", "camera_link", (0.05, 0.0, 0.9), axis=SIDEWAYS),
    )
    return Robot("rrbot", "RRBot: two swinging beams on a post.", links, joints)


def _rrbot_beam(
    name: str, length: float, middle: float, moments: tuple[float, float], paint: Paint, pivot: float
) -> Link:
    place = (0.0, 0.0, middle)
    beam = Box((0.1, 0.1, length))
    hinge = Shape(Cylinder(0.045, 0.11), (0.0, 0.0, pivot), ALONG_Y, GREY)
    inertial = Inertial(1.0, place, tensor=diagonal(moments[0], moments[0], moments[1]))
    return Link(name, inertial, (Shape(beam, place, paint=paint), hinge), (Shape(beam, place),))


def _rrbot_mount(name: str, box: Box, paint: Paint) -> Link:
    inertial = Inertial(1e-5, tensor=diagonal(1e-6, 1e-6, 1e-6))
    return Link(name, inertial, (Shape(box, paint=paint),), (Shape(box),))


def simple_arm() -> Robot:
    """One hinge, one lever: mass 1 kg at 0.5 m, hanging straight down at angle 0."""
    middle = (0.0, 0.0, -0.5)
    lever = Capsule(0.03, 0.94)
    base = Link(
        "base",
        Inertial(1.0, tensor=diagonal(0.00666667, 0.00666667, 0.00666667)),
        (Shape(Box((0.2, 0.1, 0.2)), (0.0, -0.1, 0.0), paint=GREY),),
        (Shape(Box((0.2, 0.1, 0.2)), (0.0, -0.1, 0.0)),),
    )
    arm = Link(
        "arm",
        Inertial(1.0, middle, tensor=diagonal(0.0836333, 0.0836333, 0.0006)),
        (
            Shape(lever, middle, paint=ORANGE),
            Shape(Cylinder(0.045, 0.1), rpy=ALONG_Y, paint=GREY),
            Shape(Sphere(0.045), (0.0, 0.0, -1.0), paint=RED),
        ),
        (Shape(lever, middle),),
    )
    swing = {"lower": -3.14159265359, "upper": 3.14159265359, "effort": 100.0, "velocity": 20.0}
    hinge = Joint("hinge", "revolute", "base", "arm", axis=SIDEWAYS, limit=swing, damping=0.0)
    return Robot("simple_arm", "One lever on one hinge.", (base, arm), (hinge,))


DRUM = Cylinder(0.075, 0.05)
DRUM_INERTIA = Inertial(0.2, tensor=diagonal(0.000322916666667, 0.000322916666667, 0.0005625))
BEAM = Box((1.0, 0.1, 0.05))
BEAM_PLACE: Vector3 = (0.5, 0.0, 0.0)
BEAM_TENSOR = (0.00208333333333, 0.0125, 0.00625, 0.167083333333, 0.000625, 0.168333333333)


def _drum(name: str, paint: Paint, xyz: Vector3 = (0.0, 0.0, 0.0)) -> Link:
    return Link(name, DRUM_INERTIA, (Shape(DRUM, xyz, paint=paint),), (Shape(DRUM, xyz),))


def _beam(name: str, paint: Paint) -> Link:
    """The stated tensor is not that of a body: PyBullet makes it zero when it reads inertia from the file."""
    inertial = Inertial(0.5, tensor=BEAM_TENSOR)
    return Link(name, inertial, (Shape(BEAM, BEAM_PLACE, paint=paint),), (Shape(BEAM, BEAM_PLACE),))


def _scara_joint(number: int, parent: str, child: str, xyz: Vector3, reach: float) -> Joint:
    limit = {"lower": -reach, "upper": reach, "effort": 10000.0, "velocity": 5.0}
    return Joint(
        f"joint_{number}", "revolute", parent, child, xyz, axis=UP, limit=limit, damping=0.0, friction=0.0
    )


def two_joint_robot_with_fixed_joints() -> Robot:
    links = (
        _drum("base_link", GREY, (0.0, 0.0, 0.025)),
        _drum("link_01_cyl", BLUE),
        _drum("link_12_cyl", BLUE),
        _drum("link_21_cyl", WHITE),
        _drum("link_23_cyl", WHITE),
        _beam("link_1", BLUE),
        _beam("link_2", WHITE),
    )
    joints = (
        Joint("link_01", "fixed", "link_01_cyl", "link_1"),
        Joint("link_12", "fixed", "link_1", "link_12_cyl", (1.0, 0.0, 0.0)),
        Joint("link_21", "fixed", "link_21_cyl", "link_2"),
        Joint("link_23", "fixed", "link_2", "link_23_cyl", (1.0, 0.0, 0.0)),
        _scara_joint(1, "base_link", "link_01_cyl", (0.0, 0.0, 0.075), 3.0),
        _scara_joint(2, "link_12_cyl", "link_21_cyl", (0.0, 0.0, 0.05), 3.0),
    )
    about = "Two beams that turn in a plane, their drums being links of their own."
    return Robot("TwoJointRobot", about, links, joints)


def two_joint_robot_without_fixed_joints() -> Robot:
    links = (
        _drum("base_link", GREY, (0.0, 0.0, 0.025)),
        _drum("link_23_cyl", WHITE),
        _beam("link_1", BLUE),
        _beam("link_2", WHITE),
    )
    joints = (
        _scara_joint(1, "base_link", "link_1", (0.0, 0.0, 0.075), 3.14),
        _scara_joint(2, "link_1", "link_2", (1.0, 0.0, 0.05), 3.14),
        Joint("link_23", "fixed", "link_2", "link_23_cyl", (1.0, 0.0, 0.0)),
    )
    return Robot("TwoJointRobot", "Two beams that turn in a plane.", links, joints)


def spherical_joint_limit() -> Robot:
    """A neck on a ball joint with swing and twist limits."""
    neck_place = (0.0, 0.0, 0.3)
    chest = Link(
        "chest",
        Inertial(4.0, tensor=diagonal(0.1, 0.1, 0.1)),
        (Shape(Box((0.6, 0.6, 0.6)), paint=BLUE),),
        (Shape(Box((0.6, 0.6, 0.6))),),
    )
    neck = Link(
        "neck",
        Inertial(1.0, neck_place, tensor=diagonal(0.01, 0.001, 0.001)),
        (Shape(Box((0.1, 0.2, 0.6)), neck_place, paint=ORANGE),),
        (Shape(Box((0.1, 0.2, 0.6)), neck_place),),
    )
    limit = {"lower": 0.2, "upper": 0.8, "effort": 1000.0, "twist": 0.3}
    joint = Joint("neck", "spherical", "chest", "neck", UP, axis=UP, limit=limit)
    return Robot("dumpUrdf", "A neck on a ball joint with limits.", (chest, neck), (joint,))
