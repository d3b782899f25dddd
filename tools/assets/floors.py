"""Floors: a chessboard seen, a thick slab or a half space touched."""

from __future__ import annotations

from tools.assets.parts import Box, Inertial, Link, Mesh, Paint, Plane, Robot, Shape, diagonal

WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0))
GLASSY = Paint("white", (1.0, 1.0, 1.0, 0.7))
MASSLESS = Inertial(0.0, tensor=diagonal(0.0, 0.0, 0.0))


def _slab(edge: float, thickness: float) -> Shape:
    """A slab whose upper face is at height 0."""
    return Shape(Box((edge, edge, thickness)), (0.0, 0.0, -thickness / 2.0))


def _floor(about: str, mesh: str, touching: Shape, friction: float, paint: Paint = WHITE) -> Robot:
    seen = (Shape(Mesh(mesh), paint=paint),)
    return Robot(
        "plane", about, (Link("planeLink", MASSLESS, seen, (touching,), {"lateral_friction": friction}),)
    )


def plane() -> Robot:
    return _floor("A floor of 200 m by 200 m.", "plane100.obj", _slab(200.0, 10.0), 1.0)


def plane_transparent() -> Robot:
    return _floor(
        "A floor of 30 m by 30 m one can see through.",
        "plane_transparent.obj",
        _slab(30.0, 10.0),
        1.0,
        GLASSY,
    )


def plane_implicit() -> Robot:
    return _floor("A floor without end: the half space below height 0.", "plane100.obj", Shape(Plane()), 0.9)


def plane100() -> Robot:
    """A thin floor whose middle, not its upper face, is at height 0."""
    touching = (Shape(Box((200.0, 200.0, 0.001))),)
    seen = (Shape(Mesh("plane100.obj"), paint=WHITE),)
    return Robot("floor", "A thin floor of 200 m by 200 m.", (Link("floor", MASSLESS, seen, touching),))
