"""Balls of all sizes, and a box that touches with eight balls at its corners."""

from __future__ import annotations

from tools.assets.parts import Inertial, Link, Mesh, Paint, Robot, Shape, Sphere

WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
MATT = Paint("white", (1.0, 1.0, 1.0, 1.0))
RED = Paint("red", (1.0, 0.2, 0.2, 1.0), (1.0, 1.0, 1.0))
GLASSY = Paint("red_transparent", (1.0, 0.0, 0.0, 0.5), (1.0, 1.0, 1.0))
CHEQUERED, SMOOTH, FOOTBALL = "textured_sphere_smooth.obj", "sphere_smooth.obj", "soccerball.obj"


def _rolling(friction: float) -> dict[str, float | None]:
    return {"rolling_friction": friction, "spinning_friction": friction}


def _ball(about: str, mass: float, radius: float, contact: dict[str, float | None], seen: Shape) -> Robot:
    link = Link("baseLink", Inertial(mass), (seen,), (Shape(Sphere(radius)),), contact)
    return Robot("urdf_robot", about, (link,))


def _scaled(mesh: str, scale: float, paint: Paint) -> Shape:
    return Shape(Mesh(mesh, (scale, scale, scale)), paint=paint)


def sphere2() -> Robot:
    return _ball("A ball of 1 m across and 10 kg.", 10.0, 0.5, _rolling(0.03), _scaled(CHEQUERED, 0.5, WHITE))


def sphere2red() -> Robot:
    return _ball("A red ball of 1 m across and 10 kg.", 10.0, 0.5, _rolling(0.03), _scaled(SMOOTH, 0.5, RED))


def sphere_transparent() -> Robot:
    about = "A ball of 1 m across and 10 kg one can see through."
    return _ball(about, 10.0, 0.5, _rolling(0.03), _scaled(CHEQUERED, 0.5, GLASSY))


def sphere_with_restitution() -> Robot:
    contact = {"restitution": 0.5, **_rolling(0.001)}
    return _ball("A ball that bounces.", 10.0, 0.5, contact, _scaled(CHEQUERED, 0.5, MATT))


def soccerball() -> Robot:
    return _ball(
        "A football, if a heavy one: 10 kg.", 10.0, 0.5, _rolling(0.03), _scaled(FOOTBALL, 1.0, WHITE)
    )


def sphere2red_nocol() -> Robot:
    link = Link("baseLink", Inertial(0.0), (_scaled(SMOOTH, 0.5, RED),))
    return Robot("urdf_robot", "A red ball to look at: it has no mass and touches nothing.", (link,))


def _marble(about: str, radius: float, seen: tuple[Shape, ...]) -> Robot:
    link = Link("base_link", Inertial(0.1), seen, (Shape(Sphere(radius)),), _rolling(0.001))
    return Robot("urdf_robot", about, (link,))


def sphere_small() -> Robot:
    return _marble("A ball of 6 cm across and 100 g.", 0.03, (_scaled(CHEQUERED, 0.03, MATT),))


def sphere_1cm() -> Robot:
    return _marble("A ball of 1 cm across and 100 g; it is drawn as it touches.", 0.005, ())


def sphere8cube() -> Robot:
    """The corners are listed with x changing fastest, then y, then z."""
    reach = (0.4, -0.4)
    corners = tuple(Shape(Sphere(0.1), (x, y, z)) for z in reach for y in reach for x in reach)
    link = Link("baseLink", Inertial(10.0), (_scaled("cube.obj", 1.0, WHITE),), corners)
    return Robot("urdf_robot", "A box that rests on eight balls at its corners.", (link,))
