"""Boxes: free, on a spindle, on three slides, small, and without collisions."""

from __future__ import annotations

from tools.assets.parts import Box, Inertial, Joint, Link, Mesh, Paint, Robot, Shape, diagonal

WHITE = Paint("white", (1.0, 1.0, 1.0, 1.0))
GREEN = Paint("blockmat", (0.1, 0.7, 0.1, 1.0))
CUBE_CONTACT: dict[str, float | None] = {
    "lateral_friction": 1.0,
    "rolling_friction": 0.0,
    "contact_cfm": 0.0,
    "contact_erp": 1.0,
}


def _cube_link(mass: float, edge: float, contact: dict[str, float | None], inertia: float = 1.0) -> Link:
    seen = (Shape(Mesh("cube.obj", (edge, edge, edge)), paint=WHITE),)
    touching = (Shape(Box((edge, edge, edge))),)
    return Link(
        "baseLink", Inertial(mass, tensor=diagonal(inertia, inertia, inertia)), seen, touching, contact
    )


def cube() -> Robot:
    return Robot("cube", "A cube of 1 m and 1 kg.", (_cube_link(1.0, 1.0, CUBE_CONTACT),))


def cube_small() -> Robot:
    link = _cube_link(0.1, 0.05, {"lateral_friction": 1.0, "inertia_scaling": 3.0})
    return Robot("cube.urdf", "A cube of 5 cm and 100 g, harder to turn than it should be.", (link,))


def cube_collisionfilter() -> Robot:
    solid = _cube_link(1.0, 1.0, {"lateral_friction": 1.0}, inertia=100.0)
    ghost = Shape(Box((1.0, 1.0, 1.0)), group=0, mask=0)
    link = Link(solid.name, solid.inertial, solid.seen, (ghost,), solid.contact)
    return Robot("cube", "A cube of 1 m that touches nothing.", (link,))


def cube_rotate() -> Robot:
    spindle = Joint(
        "joint_baseLink_world",
        "continuous",
        "world",
        "baseLink",
        axis=(0.0, 0.0, 1.0),
        damping=1.0,
        friction=0.0001,
    )
    links = (Link("world"), _cube_link(1.0, 1.0, CUBE_CONTACT))
    return Robot("cube", "A cube of 1 m on an upright spindle.", links, (spindle,))


def cube_no_rotation() -> Robot:
    """Three sliding joints without limits, then a spindle along y."""
    free = {"lower": 1.0, "upper": -1.0, "effort": 0.0, "velocity": 1000.0}
    carriage = Inertial(0.01, tensor=(0.2125, -0.005, 0.0225, 0.205, 0.045, 0.0125))
    slides = tuple(Link(f"{axis}_prismatic", carriage) for axis in "xyz")
    chain = (
        ("x_to_world", "prismatic", "world", "x_prismatic", (1.0, 0.0, 0.0)),
        ("y_to_x", "prismatic", "x_prismatic", "y_prismatic", (0.0, 1.0, 0.0)),
        ("z_to_y", "prismatic", "y_prismatic", "z_prismatic", (0.0, 0.0, 1.0)),
        ("cube_to_z", "continuous", "z_prismatic", "baseLink", (0.0, 1.0, 0.0)),
    )
    joints = tuple(
        Joint(name, kind, parent, child, axis=axis, limit=free) for name, kind, parent, child, axis in chain
    )
    links = (Link("world"), *slides, _cube_link(0.1, 1.0, CUBE_CONTACT))
    return Robot("cube", "A cube of 1 m carried by three slides and a spindle.", links, joints)


def block() -> Robot:
    bar = Shape(Box((0.1, 0.018, 0.018)), paint=GREEN)
    contact: dict[str, float | None] = {"lateral_friction": 1.0, "spinning_friction": 0.001}
    link = Link("block_2_base_link", Inertial(0.02), (bar,), (Shape(Box((0.1, 0.018, 0.018))),), contact)
    return Robot("block_2", "A bar of 10 cm and 20 g, made to be grasped.", (link,))
