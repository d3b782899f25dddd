"""Things to put down and pick up: tables, trays, wooden and plastic blocks."""

from __future__ import annotations

from tools.assets.parts import (
    QUARTER_TURN,
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

WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0))
WOODEN = Paint("framemat0", (1.0, 1.0, 1.0, 1.0))
STEEL = Paint("tray_material", (0.38, 0.37, 0.355, 1.0), (0.5, 0.5, 0.5))
DARK_STEEL = Paint("tray_material", (0.27, 0.265, 0.253, 1.0), (0.5, 0.5, 0.5))
BLACK = Paint("black", (0.08, 0.08, 0.1, 1.0))
YELLOW = Paint("yellow", (1.0, 0.82, 0.1, 1.0), (0.4, 0.4, 0.4))
PALE_WOOD = Paint("blue", (0.87, 0.72, 0.5, 1.0))
WOOD = "table.obj"


def _legs(x: float, y: float, thickness: float, height: float) -> tuple[Shape, ...]:
    leg = Mesh(WOOD, (thickness, thickness, height))
    return tuple(
        Shape(leg, (sx * x, sy * y, height / 2.0), paint=WOODEN) for sx in (-1.0, 1.0) for sy in (-1.0, 1.0)
    )


def table() -> Robot:
    """Only the top touches; the legs are there to be seen."""
    place = (0.0, 0.0, 0.6)
    top = (1.5, 1.0, 0.05)
    seen = (Shape(Mesh(WOOD, top), place, paint=WOODEN), *_legs(0.65, 0.4, 0.1, 0.58))
    link = Link("baseLink", Inertial(0.0), seen, (Shape(Box(top), place),), {"lateral_friction": 1.0})
    return Robot("table.urdf", "A wooden table, 1.5 m by 1 m.", (link,))


def table_square() -> Robot:
    place = (0.0, 0.0, 0.6)
    top = (0.6, 0.6, 0.08)
    seen = (Shape(Mesh(WOOD, top), place, paint=WOODEN), *_legs(0.25, 0.25, 0.05, 0.56))
    inertial = Inertial(0.0, place, tensor=diagonal(0.1, 0.1, 0.1))
    links = (Link("world"), Link("baseLink", inertial, seen, (Shape(Box(top), place),)))
    return Robot(
        "urdf_table", "A square table with checkers.", links, (Joint("fixed", "fixed", "world", "baseLink"),)
    )


def traybox() -> Robot:
    """A floor and four slanting walls."""
    slant, out, height = 0.575469961, 0.25, 0.059
    lengthways, crossways = Box((0.02, 0.6, 0.15)), Box((0.6, 0.02, 0.15))
    panels: tuple[tuple[Box, Vector3, Vector3], ...] = (
        (Box((0.6, 0.6, 0.02)), (0.0, 0.0, 0.005), (0.0, 0.0, 0.0)),
        (lengthways, (out, 0.0, height), (0.0, slant, 0.0)),
        (lengthways, (-out, 0.0, height), (0.0, -slant, 0.0)),
        (crossways, (0.0, -out, height), (slant, 0.0, 0.0)),
        (crossways, (0.0, out, height), (-slant, 0.0, 0.0)),
    )
    touching = tuple(Shape(*panel) for panel in panels)
    seen = (Shape(Mesh("tray.obj"), paint=STEEL),)
    inertial = Inertial(0.0, tensor=diagonal(0.0, 0.0, 0.0))
    return Robot(
        "tabletop",
        "A steel tray made of a floor and four walls.",
        (Link("base_link", inertial, seen, touching),),
    )


def textured_tray() -> Robot:
    """A tray twice as large as its file says, which touches with its floor and walls."""
    shape = Mesh("tray_textured2.obj", (0.5, 0.5, 0.5))
    inertial = Inertial(0.0, tensor=diagonal(0.0, 0.0, 0.0))
    link = Link("base_link", inertial, (Shape(shape, paint=STEEL),), (Shape(shape),))
    return Robot("tabletop", "A steel tray of a floor and four slanting walls.", (link,))


def tray() -> Robot:
    """The tray as one solid: PyBullet takes the convex hull of its mesh, so things rest on its rim."""
    shape = Mesh("tray_solid.obj")
    contact: dict[str, float | None] = {
        "lateral_friction": 0.5,
        "rolling_friction": 0.0,
        "contact_cfm": 0.0,
        "contact_erp": 1.0,
    }
    inertial = Inertial(0.0, tensor=diagonal(0.0, 0.0, 0.0))
    link = Link("tray_base_link", inertial, (Shape(shape, paint=DARK_STEEL),), (Shape(shape),), contact)
    return Robot("tray", "A steel tray that touches with its convex hull.", (link,))


def jenga() -> Robot:
    brick = Box((0.15, 0.05, 0.03))
    link = Link(
        "baseLink",
        Inertial(0.05),
        (Shape(brick, paint=PALE_WOOD),),
        (Shape(brick),),
        {"lateral_friction": 0.5},
    )
    return Robot("jenga.urdf", "A wooden brick of 15 cm and 50 g.", (link,))


def domino() -> Robot:
    """A double three, the pips on both faces."""
    tile = Box((0.00635, 0.0254, 0.0508))
    pips = tuple(
        Shape(
            Cylinder(0.0021, 0.00655),
            (0.0, side * 0.0065, half * 0.0127 + side * 0.0065),
            (0.0, QUARTER_TURN, 0.0),
            BLACK,
        )
        for half in (-1.0, 1.0)
        for side in (-1.0, 0.0, 1.0)
    )
    bar = Shape(Box((0.00655, 0.02, 0.0007)), paint=BLACK)
    link = Link(
        "baseLink",
        Inertial(0.025),
        (Shape(tile, paint=WHITE), bar, *pips),
        (Shape(tile),),
        {"lateral_friction": 0.5},
    )
    return Robot("cube", "A domino that stands on its short edge.", (link,))


def lego() -> Robot:
    """A brick with two by two studs; its box lies on its side, as in PyBullet's own file."""
    contact: dict[str, float | None] = {
        "lateral_friction": 1.0,
        "rolling_friction": 0.0,
        "contact_cfm": 0.0,
        "contact_erp": 1.0,
    }
    studs = tuple(
        Shape(Cylinder(0.0048, 0.004), (x * 0.008, y * 0.008, 0.0125), paint=YELLOW)
        for x in (-1.0, 1.0)
        for y in (-1.0, 1.0)
    )
    seen = (Shape(Box((0.0318, 0.0318, 0.0225)), paint=YELLOW), *studs)
    touching = (Shape(Box((0.032, 0.023, 0.032)), rpy=(1.570796, 0.0, 0.0)),)
    return Robot(
        "cube.urdf", "A plastic brick of 32 mm.", (Link("legobrick", Inertial(0.1), seen, touching, contact),)
    )
