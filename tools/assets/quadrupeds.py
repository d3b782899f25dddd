"""Four-legged robots."""

from __future__ import annotations

from tools.assets.envelope import Envelope, rod
from tools.assets.measured import Dress, dressed
from tools.assets.parts import QUARTER_TURN, Box, Cylinder, Paint, Robot, Shape, Vector3

SHELL = Paint("shell", (0.86, 0.87, 0.88, 1.0), (0.4, 0.4, 0.4))
DARK = Paint("dark", (0.17, 0.18, 0.2, 1.0), (0.3, 0.3, 0.3))
BLACK = Paint("black", (0.07, 0.07, 0.08, 1.0))
STEEL = Paint("steel", (0.6, 0.62, 0.66, 1.0), (0.6, 0.6, 0.6))
ORANGE = Paint("orange", (0.93, 0.45, 0.08, 1.0), (0.3, 0.3, 0.3))
BLUE = Paint("blue", (0.1, 0.35, 0.75, 1.0), (0.3, 0.3, 0.3))

ALONG_X: Vector3 = (0.0, QUARTER_TURN, 0.0)


def _block(size: Vector3, place: Vector3, paint: Paint, rpy: Vector3 = (0.0, 0.0, 0.0)) -> Shape:
    return Shape(Box(size), place, rpy, paint)


UNITREE = {"trunk": DARK, "*_hip": STEEL, "*_shoulder": DARK, "*_upper": SHELL, "*_lower": DARK, "*": BLACK}


def a1() -> Robot:
    """The dog of 12 kg."""
    head = (
        _block((0.05, 0.17, 0.08), (0.155, 0.0, 0.005), SHELL),
        _block((0.01, 0.11, 0.035), (0.182, 0.0, 0.012), BLACK),
        _block((0.2, 0.1, 0.012), (0.0, 0.0, 0.06), SHELL),
    )
    return dressed("a1/a1.urdf", "A walking robot of 12 kg.", Dress(paint=UNITREE, more={"trunk": head}))


def aliengo() -> Robot:
    """The dog of 21 kg."""
    head = (
        _block((0.2, 0.1, 0.015), (0.0, 0.0, 0.06), SHELL),
        _block((0.02, 0.11, 0.05), (0.32, 0.0, 0.01), SHELL),
    )
    return dressed(
        "aliengo/aliengo.urdf", "A walking robot of 21 kg.", Dress(paint=UNITREE, more={"trunk": head})
    )


def _chassis(room: Envelope) -> tuple[Shape, ...]:
    """A trunk, a belly under it, and shoulders and hips between which the legs swing; it lies along z."""
    return (
        room.box(x=(-0.072, 0.072), y=(-0.05, 0.06)),
        room.box(x=(-0.045, 0.045), z=(-0.12, 0.1)),
        room.box(y=(-0.047, -0.02), z=(0.255, None)),
        room.box(y=(-0.047, -0.02), z=(-0.181, -0.157)),
    )


def _upright_chassis(room: Envelope) -> tuple[Shape, ...]:
    """The same body along x."""
    return (
        room.box(y=(-0.072, 0.072), z=(-0.05, 0.06)),
        room.box(y=(-0.045, 0.045), x=(-0.12, 0.1)),
        room.box(z=(-0.047, -0.02), x=(0.255, None)),
        room.box(z=(-0.047, -0.02), x=(-0.181, -0.157)),
    )


def _thigh(room: Envelope) -> tuple[Shape, ...]:
    """A motor at the hip, and a beam that slants down to the knee."""
    (_, front), (knee_y, _), (knee_z, _) = (room.inner(axis) for axis in "xyz")
    outward = 0.018 if front < 0.05 else -0.018
    return (
        room.capsule("x", 0.045, y="high", z="high"),
        room.capsule("x", 0.02, y="low", z="low", start=outward - 0.022, stop=outward + 0.022),
        rod((outward, 0.03, 0.03), (outward, knee_y + 0.04, knee_z + 0.035), 0.02),
    )


def _shank(room: Envelope) -> tuple[Shape, ...]:
    """A rod to the foot; its round end is what stands."""
    front = room.capsule("y", 0.016, x=0.0, z="low", stop=0.12)
    return (front, room.box(y=(0.1, None), z=(0.0, None)))


def laikago(file: str) -> Robot:
    """The dog of 25 kg, with or without toes; in most of its files it lies along z."""
    chassis = _upright_chassis if "zup" in file else _chassis
    dress = Dress(
        paint={"chassis": SHELL, "*_hip_motor": DARK, "*_upper_leg": SHELL, "*_lower_leg": DARK, "*": BLACK},
        fill={"chassis": chassis, "*_upper_leg": _thigh, "*_lower_leg": _shank},
    )
    return dressed(file, "A walking robot of 25 kg.", dress)


def _body_of_cheetah(room: Envelope) -> tuple[Shape, ...]:
    return (room.box(y=(-0.07, 0.07)), room.box(x=(-0.11, 0.11), z=(-0.03, 0.03)))


def _thigh_of_cheetah(room: Envelope) -> tuple[Shape, ...]:
    """A round motor with caps on both sides, and a rod down to the knee."""
    return (
        room.box(y=(-0.05, 0.018), z=(0.014, 0.026)),
        room.box(x=(-0.01, 0.01), y=(-0.05, 0.018), z=(-0.02, None)),
        room.box(x=(-0.034, 0.034), y=(-0.05, 0.018), z=(-0.014, 0.054)),
        room.box(x=(-0.012, 0.012), z=(0.008, 0.032)),
        room.capsule("z", 0.014, x=0.0, y=-0.016, stop=0.02),
    )


def mini_cheetah() -> Robot:
    """The cheetah of 9 kg."""
    return dressed(
        "mini_cheetah/mini_cheetah.urdf",
        "A walking robot of 9 kg.",
        Dress(
            paint={"body": DARK, "abduct_*": STEEL, "thigh_*": BLUE, "shank_*": DARK, "*": BLACK},
            fill={"body": _body_of_cheetah, "thigh_*": _thigh_of_cheetah},
        ),
    )


MINITAUR = Dress(
    paint={"base_*": DARK, "chassis_*": STEEL, "motor_*": BLACK, "upper_*": ORANGE, "*": STEEL},
    more={
        "base_chassis_link": (
            _block((0.2, 0.07, 0.02), (0.0, 0.0, 0.045), ORANGE),
            Shape(Cylinder(0.012, 0.02), (0.14, 0.0, 0.04), paint=BLUE),
        )
    },
)


def minitaur(file: str) -> Robot:
    """Eight motors that drive four legs of two rods each; scripts tie the ends of the rods together."""
    return dressed(file, "A robot on four five-bar legs.", MINITAUR)


def ghost(file: str) -> Robot:
    """Walking robots whose toes are balls."""
    return dressed(
        file,
        "A walking robot with balls for toes.",
        Dress(paint={"body": DARK, "hip*": STEEL, "upper*": ORANGE, "lower*": DARK, "*": BLACK}),
    )


def quadruped() -> Robot:
    """The first of the robots on four five-bar legs."""
    return dressed("quadruped/quadruped.urdf", "A robot on four five-bar legs.", MINITAUR)
