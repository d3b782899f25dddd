"""Things on wheels: a four-wheeled rover, a model car, a bicycle and a differential gear."""

from __future__ import annotations

from tools.assets.envelope import Envelope, rod
from tools.assets.measured import Dress, dressed, fitted
from tools.assets.obj_mesh import ObjMesh
from tools.assets.parts import (
    QUARTER_TURN,
    Box,
    Capsule,
    Cylinder,
    Paint,
    Robot,
    Shape,
    Vector3,
)
from tools.assets.simple_meshes import lathe

TYRE = Paint("tyre", (0.11, 0.11, 0.12, 1.0), (0.1, 0.1, 0.1))
RIM = Paint("rim", (0.75, 0.76, 0.78, 1.0), (0.5, 0.5, 0.5))
DARK = Paint("dark", (0.2, 0.21, 0.23, 1.0))
YELLOW = Paint("yellow", (0.95, 0.7, 0.08, 1.0), (0.3, 0.3, 0.3))
BLUE = Paint("blue", (0.1, 0.25, 0.7, 1.0), (0.5, 0.5, 0.5))
GREEN = Paint("green", (0.1, 0.75, 0.3, 1.0))
RED = Paint("red", (0.75, 0.1, 0.08, 1.0), (0.4, 0.4, 0.4))
STEEL = Paint("steel", (0.62, 0.64, 0.67, 1.0), (0.6, 0.6, 0.6))

ALONG_X: Vector3 = (0.0, QUARTER_TURN, 0.0)
ALONG_Y: Vector3 = (QUARTER_TURN, 0.0, 0.0)


def _block(size: Vector3, place: Vector3, paint: Paint, rpy: Vector3 = (0.0, 0.0, 0.0)) -> Shape:
    return Shape(Box(size), place, rpy, paint)


def _bar(radius: float, length: float, place: Vector3, rpy: Vector3, paint: Paint) -> Shape:
    return Shape(Cylinder(radius, length), place, rpy, paint)


def husky() -> Robot:
    """A rover that turns by driving its sides at different speeds."""
    hull = (
        _block((0.74, 0.33, 0.16), (0.0, 0.0, 0.07), DARK),
        _block((0.96, 0.38, 0.11), (0.0, 0.0, 0.17), YELLOW),
        _block((0.06, 0.34, 0.06), (0.48, 0.0, 0.18), DARK),
        _block((0.06, 0.34, 0.06), (-0.48, 0.0, 0.18), DARK),
        _bar(0.02, 0.57, (0.256, 0.0, 0.033), ALONG_Y, STEEL),
        _bar(0.02, 0.57, (-0.256, 0.0, 0.033), ALONG_Y, STEEL),
    )
    wheel = (
        _bar(0.17775, 0.1143, (0.0, 0.0, 0.0), ALONG_Y, TYRE),
        _bar(0.095, 0.118, (0.0, 0.0, 0.0), ALONG_Y, YELLOW),
        _bar(0.035, 0.122, (0.0, 0.0, 0.0), ALONG_Y, DARK),
    )
    rail = tuple(_bar(0.012, 0.7, (-0.27, side * 0.16, 0.0), ALONG_X, DARK) for side in (-1.0, 1.0)) + tuple(
        _bar(0.012, 0.32, (x, 0.0, 0.0), ALONG_Y, DARK) for x in (0.07, -0.61)
    )
    return dressed(
        "husky/husky.urdf",
        "A rover on four wheels.",
        Dress(
            paint={"*": YELLOW},
            seen={
                "base_link": hull,
                "*_wheel_link": wheel,
                "user_rail_link": rail,
                "top_plate_link": (_block((0.55, 0.38, 0.01), (0.0, 0.0, 0.23), STEEL),),
                "*_bumper_link": (_block((0.03, 0.42, 0.05), (0.0, 0.0, 0.05), TYRE),),
            },
        ),
    )


def _car_wheel(width: float) -> tuple[Shape, ...]:
    flat: Vector3 = (0.0, 0.0, 0.0)
    return (
        _bar(0.05, width, (0.0, 0.0, 0.0), flat, TYRE),
        _bar(0.03, width + 0.004, (0.0, 0.0, 0.0), flat, RIM),
        _bar(0.011, width + 0.008, (0.0, 0.0, 0.0), flat, DARK),
    )


def _car_body() -> tuple[Shape, ...]:
    """In the frame of the rear axle, as high as it."""
    return (
        _block((0.4, 0.12, 0.03), (0.165, 0.0, 0.0), DARK),
        _block((0.4, 0.14, 0.035), (0.16, 0.0, 0.032), BLUE),
        _block((0.17, 0.12, 0.04), (0.09, 0.0, 0.068), BLUE),
        _block((0.075, 0.11, 0.035), (0.205, 0.0, 0.06), DARK, (0.0, 0.6, 0.0)),
        _block((0.045, 0.19, 0.015), (0.4, 0.0, -0.01), DARK),
        _block((0.05, 0.19, 0.008), (-0.045, 0.0, 0.085), DARK),
        _block((0.012, 0.01, 0.07), (-0.04, 0.05, 0.05), DARK),
        _block((0.012, 0.01, 0.07), (-0.04, -0.05, 0.05), DARK),
        _bar(0.008, 0.19, (0.0, 0.0, 0.0), ALONG_Y, STEEL),
        _bar(0.006, 0.19, (0.325, 0.0, 0.0), ALONG_Y, STEEL),
    )


LASER = (
    _block((0.05, 0.05, 0.03), (0.0, 0.0, -0.025), DARK),
    Shape(Cylinder(0.022, 0.045), (0.0, 0.0, 0.01), paint=DARK),
    Shape(Cylinder(0.0225, 0.012), (0.0, 0.0, 0.015), paint=GREEN),
)
CAMERA = (
    _block((0.033, 0.175, 0.03), (0.0, 0.0, 0.0), DARK),
    *(_bar(0.008, 0.006, (0.016, side * 0.06, 0.0), ALONG_X, STEEL) for side in (-1.0, 1.0)),
)


def racecar() -> Robot:
    """A model car that steers with its front wheels."""
    return dressed(
        "racecar/racecar.urdf",
        "A model car with a laser scanner and a stereo camera.",
        Dress(
            paint={"*": TYRE},
            seen={
                "chassis": _car_body(),
                "*_wheel": _car_wheel(0.045),
                "laser": LASER,
                "zed_camera_link": CAMERA,
            },
        ),
    )


def racecar_differential() -> Robot:
    """The model car with the gears of its rear axle."""
    return dressed(
        "racecar/racecar_differential.urdf",
        "A model car with a differential gear on its rear axle.",
        Dress(
            paint={"*wheel": TYRE, "diff_*": STEEL, "*": DARK},
            seen={
                "chassis": _car_body(),
                "*_wheel": _car_wheel(0.045),
                "laser": LASER,
                "zed_camera_link": CAMERA,
            },
        ),
    )


def diff_ring() -> Robot:
    return dressed(
        "differential/diff_ring.urdf",
        "A differential gear: a ring with two spiders and two side gears.",
        Dress(paint={"diff_ring": STEEL, "diff_spider*": YELLOW, "*": BLUE}),
    )


def wheel_disc() -> ObjMesh:
    """A disc one unit wide, with corners on the axes: what touches of a bicycle's wheel is its hull."""
    return lathe([(0.0, -0.5), (0.5, -0.5), (0.5, 0.5), (0.0, 0.5)], 48)


def _spokes(room_middle: float) -> tuple[Shape, ...]:
    """Rim, tyre and spokes; the axle of a wheel points along y of its link."""
    middle = (0.0, -room_middle, 0.0)
    tyre = (_bar(0.563, 0.03, middle, ALONG_Y, TYRE), _bar(0.52, 0.034, middle, ALONG_Y, RIM))
    hub = _bar(0.04, 0.07, middle, ALONG_Y, STEEL)
    spokes = tuple(
        _block((1.02, 0.037, 0.01), middle, DARK, (0.0, QUARTER_TURN * number / 4.0, 0.0))
        for number in range(8)
    )
    return (*tyre, hub, *spokes)


def _handlebar(room: Envelope) -> tuple[Shape, ...]:
    """A fork, a stem and a bar."""
    _, top = room.inner("z")
    low, _ = room.inner("x")
    return (
        room.capsule("y", 0.02, x="high", z="high"),
        room.capsule("x", 0.02, y=0.0, z=top - 0.05, stop=0.25),
        rod((low + 0.05, 0.0, top - 0.1), (0.02, 0.0, -0.15), 0.03),
        room.capsule("z", 0.02, x=0.02, y=0.06, stop=-0.12),
        room.capsule("z", 0.02, x=0.02, y=-0.06, stop=-0.12),
    )


def bike() -> Robot:
    """The frame is a slim box with the bounds of the original."""
    frame = (
        Shape(Capsule(0.03, 0.6), (0.05, 0.0, 0.3), (0.0, QUARTER_TURN, 0.0), RED),
        Shape(Capsule(0.03, 0.75), (0.2, 0.0, -0.05), (0.0, 0.8, 0.0), RED),
        Shape(Capsule(0.03, 0.6), (-0.22, 0.0, 0.1), (0.0, -0.3, 0.0), RED),
        Shape(Capsule(0.018, 0.5), (-0.45, 0.06, -0.2), (0.0, QUARTER_TURN, 0.0), RED),
        Shape(Capsule(0.018, 0.5), (-0.45, -0.06, -0.2), (0.0, QUARTER_TURN, 0.0), RED),
        _block((0.28, 0.14, 0.05), (-0.33, 0.0, 0.5), TYRE),
        _bar(0.1, 0.02, (-0.08, 0.05, -0.25), ALONG_Y, STEEL),
    )
    return dressed(
        "bicycle/bike.urdf",
        "A bicycle: a frame, handlebars that steer, and two wheels.",
        Dress(
            paint={"*Wheel*": TYRE, "*": RED},
            fill={"*Wheel*": fitted("wheel.obj"), "handlebarLink": _handlebar},
            seen={"frameLink": frame, "*WheelLink": _spokes(0.028)},
        ),
    )
