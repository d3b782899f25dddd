"""Arms and grippers besides the Panda and the KUKA."""

from __future__ import annotations

from collections.abc import Mapping

from tools.assets.envelope import Envelope
from tools.assets.measured import Dress, Filler, dressed
from tools.assets.parts import Paint, Robot, Shape

WHITE = Paint("white", (0.92, 0.93, 0.94, 1.0), (0.4, 0.4, 0.4))
GREY = Paint("grey", (0.5, 0.52, 0.55, 1.0), (0.4, 0.4, 0.4))
DARK = Paint("dark", (0.16, 0.17, 0.19, 1.0), (0.3, 0.3, 0.3))


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


def _knuckle(room: Envelope) -> tuple[Shape, ...]:
    """A bar from one corner of the bounds to the other, with what it takes to reach them."""
    (low_y, high_y), (low_z, high_z) = room.inner("y"), room.inner("z")
    middle_y, middle_z = (low_y + high_y) / 2.0, (low_z + high_z) / 2.0
    if abs(low_y) > high_y:
        return room.box(y=(None, middle_y), z=(middle_z, None)), room.box(y=(middle_y, None))
    return room.box(y=(middle_y, None), z=(middle_z, None)), room.box(y=(None, middle_y))


XARM: Mapping[str, Filler] = {
    "link_base": _base,
    "link1": _shoulder,
    "link2": _upper_arm,
    "link3": _forearm,
    "link4": _sleeve,
    "link5": _wrist,
    "*_outer_knuckle": _knuckle,
}


def xarm6(file: str) -> Robot:
    """An arm with six joints, with or without its gripper."""
    paint = {"link_base": GREY, "link6": GREY, "link*": WHITE, "*": DARK}
    return dressed(file, "An arm with six joints.", Dress(paint, XARM))


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


def pr2_gripper() -> Robot:
    """Two fingers with rubber tips on a pole."""
    return dressed(
        "pr2_gripper.urdf",
        "A gripper with two fingers, each with a tip.",
        Dress(paint={"*_tip": DARK, "*_gripper": GREY, "*": WHITE}, fill={"*_gripper": _finger_of_pr2}),
    )
