"""Arms and grippers besides the Panda and the KUKA."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tools.assets import xarm_looks
from tools.assets.envelope import Envelope, rod
from tools.assets.measured import Dress, Filler, dressed
from tools.assets.obj_mesh import ObjMesh
from tools.assets.parts import Paint, Robot, Shape, Vector3
from tools.assets.simple_meshes import blocks, stretched

WHITE = Paint("white", (0.92, 0.93, 0.94, 1.0), (0.4, 0.4, 0.4))
PLAIN = Paint("plain", (1.0, 1.0, 1.0, 1.0))
SILVER = Paint("silver", (*xarm_looks.SILVER, 1.0))
GREY = Paint("grey", (0.5, 0.52, 0.55, 1.0), (0.4, 0.4, 0.4))
DARK = Paint("dark", (0.16, 0.17, 0.19, 1.0), (0.3, 0.3, 0.3))


Block = tuple[Vector3, Vector3]


def _base(room: Envelope) -> tuple[Shape, ...]:
    """A foot and a column."""
    return (
        room.capsule("z", room.width("y") / 2.0, x="high", y=0.0),
        room.box(x=(None, 0.0), y=(-0.05, 0.05), z=(None, -0.03)),
    )


def _shoulder(room: Envelope) -> tuple[Shape, ...]:
    radius = room.width("x") / 2.0
    return room.capsule("z", radius, x="low", y="high"), room.capsule("y", 0.045, x=0.002, z="high")


def _upper_arm(room: Envelope) -> tuple[Shape, ...]:
    """A beam between two joints that lie across it."""
    return (
        room.capsule("z", 0.052, x="low", y="high"),
        room.capsule("z", 0.05, x="high", y="low"),
        room.capsule("y", 0.045, x=-0.01, z=0.02),
    )


def _forearm(room: Envelope) -> tuple[Shape, ...]:
    return (
        room.capsule("z", 0.045, x="low", y=-0.1),
        room.capsule("x", 0.045, y=-0.09, z=0.04),
        room.capsule("y", 0.045, x="high", z=0.015),
    )


def _sleeve(room: Envelope) -> tuple[Shape, ...]:
    return room.capsule("z", room.width("x") / 2.0, x="low", y=0.0), room.capsule("y", 0.042, x=0.0, z="high")


def _wrist(room: Envelope) -> tuple[Shape, ...]:
    return room.capsule("x", room.width("z") / 2.0, y=0.0, z="low"), room.capsule(
        "y", 0.04, x="high", z=0.003
    )


def _palm(room: Envelope) -> tuple[Shape, ...]:
    """A flange, the body of the gripper on it, and a pin."""
    return (
        room.box(x=(-0.024, 0.02), z=(-0.048, None)),
        room.box(y=(-0.015, 0.021), z=(-0.048, -0.043)),
        room.box(x=(-0.001, 0.003), y=(0.0, 0.004), z=(None, 0.0)),
    )


def _outer_knuckle(room: Envelope) -> tuple[Shape, ...]:
    """A bar that slants across the bounds."""
    return (
        room.box(x=(-0.004, 0.004), y=(None, -0.017), z=(None, -0.0165)),
        room.box(y=(-0.02, 0.0), z=(-0.012, 0.008)),
        room.box(x=(-0.004, 0.004), y=(0.01, 0.019), z=(0.0, None)),
        room.box(y=(0.012, None), z=(0.003, 0.01)),
    )


def _inner_knuckle(room: Envelope) -> tuple[Shape, ...]:
    """A bar that slants across the bounds, with an axle through it."""
    return (
        room.box(x=(-0.013, 0.013), y=(None, -0.017), z=(None, -0.022)),
        room.box(y=(-0.004, 0.004), z=(-0.004, 0.004)),
        room.box(x=(-0.013, 0.013), y=(0.009, None), z=(0.012, None)),
        rod((0.0, -0.0225, -0.027), (0.0, 0.014, 0.017), 0.004),
    )


def _finger(room: Envelope) -> tuple[Shape, ...]:
    """A pad, and an arm that slants back to the joint."""
    return (
        room.box(y=(None, -0.003), z=(-0.008, None)),
        room.box(x=(-0.008, 0.008), y=(0.0, 0.015), z=(-0.026, -0.012)),
        room.box(x=(-0.01, 0.01), y=(0.012, None), z=(None, -0.029)),
    )


def _mirrored(fill: Filler) -> Filler:
    """The same on the other side of the plane y = 0."""

    def fill_other_side(room: Envelope) -> tuple[Shape, ...]:
        (x0, y0, z0), (x1, y1, z1) = room.low, room.high
        shapes = fill(Envelope((x0, -y1, z0), (x1, -y0, z1)))
        return tuple(
            replace(
                shape,
                xyz=(shape.xyz[0], -shape.xyz[1], shape.xyz[2]),
                rpy=(-shape.rpy[0], shape.rpy[1], -shape.rpy[2]),
            )
            for shape in shapes
        )

    return fill_other_side


XARM: Mapping[str, Filler] = {
    "link_base": _base,
    "link1": _shoulder,
    "link2": _upper_arm,
    "link3": _forearm,
    "link4": _sleeve,
    "link5": _wrist,
    "xarm_gripper_base_link": _palm,
    "left_outer_knuckle": _outer_knuckle,
    "right_outer_knuckle": _mirrored(_outer_knuckle),
    "left_inner_knuckle": _inner_knuckle,
    "right_inner_knuckle": _mirrored(_inner_knuckle),
    "left_finger": _finger,
    "right_finger": _mirrored(_finger),
}


def xarm6(file: str) -> Robot:
    """An arm with six joints, with or without its gripper."""
    paint = {"link*": WHITE, "xarm_gripper_base_link": PLAIN, "*": SILVER}
    looks = xarm_looks.seen(coloured=file == "xarm/xarm6_robot.urdf")
    return dressed(file, "An arm with six joints.", Dress(paint, XARM, seen=looks))


def xarm6_link(file: str) -> Robot:
    """One link of the arm, held by the world."""
    dress = Dress({"*": WHITE}, {**XARM, "base": _base})
    return dressed(file, "A link of an arm with six joints.", dress)


def _finger_of_pr2(room: Envelope) -> tuple[Shape, ...]:
    """A root at the joint and a finger that bends away from the middle."""
    low, high = room.inner("y")
    if abs(low) < high:
        return room.box(x=(None, 0.04), y=(None, 0.025)), room.box(
            x=(0.015, None), y=(0.02, None), z=(-0.012, 0.012)
        )
    return room.box(x=(None, 0.04), y=(-0.025, None)), room.box(
        x=(0.015, None), y=(None, -0.02), z=(-0.012, 0.012)
    )


def finger_mesh(low: Vector3, high: Vector3) -> ObjMesh:
    """A root at the joint and a finger that bends away, as a mesh that spans given bounds."""
    root: Block = ((0.0, 0.0, 0.0), (0.45, 0.6, 1.0))
    finger: Block = ((0.2, 0.5, 0.25), (1.0, 1.0, 0.75))
    return stretched(blocks([root, finger]), low, high)


def pr2_gripper() -> Robot:
    """Two fingers with rubber tips on a pole."""
    return dressed(
        "pr2_gripper.urdf",
        "A gripper with two fingers, each with a tip.",
        Dress(paint={"*_tip": DARK, "*_gripper": GREY, "*": WHITE}, fill={"*_gripper": _finger_of_pr2}),
    )
