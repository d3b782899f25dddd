"""What the links of the xArm look like: housings of drums, rods and balls, in their link frames [m]."""

from __future__ import annotations

from collections.abc import Mapping

from tools.assets.fields import Field, ball, blend, block, drum, rod, within
from tools.assets.parts import Box, Cylinder, Mesh, Paint, Shape, Vector3

Body = tuple[Field, Vector3, Vector3]

BLUE, RED = (0.28, 0.52, 0.92), (0.85, 0.19, 0.21)
YELLOW, GREEN = (0.95, 0.76, 0.05), (0.23, 0.72, 0.32)
SILVER = (0.753, 0.753, 0.753)
COLOURS = {
    "link_base": BLUE,
    "link1": RED,
    "link2": YELLOW,
    "link3": BLUE,
    "link4": GREEN,
    "link5": RED,
    "link6": SILVER,
}
"""Of the arm without a gripper; with one, and in its white edition, all but the last link are white."""

EDGE = 0.002
"""How round edges are."""
SEAM = 0.006
"""How far parts blend into each other."""


def fields() -> dict[str, Body]:
    """The housing of each link, and corners of a box around it."""
    return {
        "link_base": (_base(), (-0.06, -0.06, -0.01), (0.06, 0.06, 0.165)),
        "link1": (_link1(), (-0.06, -0.065, -0.12), (0.06, 0.085, 0.06)),
        "link2": (_link2(), (-0.06, -0.34, -0.08), (0.105, 0.06, 0.13)),
        "link3": (_link3(), (-0.05, -0.05, -0.05), (0.13, 0.18, 0.115)),
        "link4": (_link4(), (-0.05, -0.05, -0.18), (0.05, 0.095, 0.045)),
        "link5": (_link5(), (-0.045, -0.045, -0.045), (0.12, 0.08, 0.065)),
        "link6": (_link6(), (-0.045, -0.06, -0.035), (0.045, 0.045, 0.01)),
    }


def _joined(*parts: Field) -> Field:
    return blend(*parts, width=SEAM)


def _base() -> Field:
    """A column."""
    return drum((0.0, 0.0, 0.0), (0.0, 0.0, 0.155), 0.0475, EDGE)


def _link1() -> Field:
    """From an upright drum to one that lies along y."""
    return _joined(
        drum((0.0, 0.0, -0.112), (0.0, 0.0, -0.085), 0.047, EDGE),
        rod((0.0, -0.006, -0.085), (0.0, -0.01, 0.0), 0.043),
        ball((0.0, -0.008, 0.0), 0.048),
        drum((0.0, -0.02, 0.0), (0.0, 0.075, 0.0), 0.0475, EDGE),
    )


def _link2() -> Field:
    """A plate beside the shoulder, which bends to a beam with a drum across its end."""
    plate = within(
        rod((0.0, 0.0, 0.095), (0.0, -0.11, 0.095), 0.047),
        block((0.0, -0.05, 0.095), (0.1, 0.3, 0.047), EDGE),
    )
    end = (0.0535, -0.2845)
    return _joined(
        plate,
        rod((0.0, -0.108, 0.07), (0.0, -0.108, 0.0), 0.0475),
        rod((0.0, -0.108, 0.0), (0.0, -0.22, -0.004), 0.042),
        rod((0.0, -0.22, -0.006), (*end, -0.01), 0.04),
        drum((*end, -0.067), (*end, 0.067), 0.042, EDGE),
    )


def _link3() -> Field:
    """A plate that slants away from the elbow to a drum along y."""
    corner = (0.0775, 0.0825)
    plate = within(
        rod((0.0, 0.0, 0.087), (*corner, 0.087), 0.042), block((0.04, 0.04, 0.087), (0.3, 0.3, 0.04), EDGE)
    )
    return _joined(
        plate,
        drum((*corner, 0.0), (*corner, 0.105), 0.0415, EDGE),
        ball((*corner, 0.0), 0.0415),
        drum((*corner, 0.0), (corner[0], 0.169, 0.0), 0.0415, EDGE),
    )


def _link4() -> Field:
    """An upright drum, from which a thin neck leads to a drum along y."""
    neck = [
        part
        for x in (-0.02, 0.0, 0.02)
        for part in (
            rod((x, 0.012, -0.135), (x, 0.062, -0.088), 0.019),
            rod((x, 0.062, -0.09), (x, 0.071, 0.0), 0.0145),
        )
    ]
    return _joined(
        drum((0.0, 0.0, -0.173), (0.0, 0.0, -0.132), 0.0415, EDGE),
        drum((0.0, 0.004, 0.0), (0.0, 0.086, 0.0), 0.037, EDGE),
        *neck,
    )


def _link5() -> Field:
    """From an upright drum to one that lies along y."""
    return _joined(
        ball((0.0, 0.0, 0.02), 0.037),
        drum((0.0, 0.0, -0.002), (0.0, 0.0, 0.02), 0.037, EDGE),
        rod((0.0, 0.0, 0.02), (0.0755, 0.0, 0.0), 0.036),
        ball((0.0755, 0.0, 0.0), 0.0375),
        drum((0.0755, 0.0, 0.0), (0.0755, 0.069, 0.0), 0.0375, EDGE),
    )


def _link6() -> Field:
    """A flange with a stud."""
    return _joined(
        drum((0.0, 0.0, -0.028), (0.0, 0.0, 0.0), 0.037, EDGE),
        rod((0.0, -0.035, -0.014), (0.0, -0.045, -0.014), 0.0065),
    )


def seen(*, coloured: bool) -> Mapping[str, tuple[Shape, ...]]:
    """Looks of all links, by name."""
    paints = {
        name: Paint(name, (*(rgb if coloured or name == "link6" else (1.0, 1.0, 1.0)), 1.0))
        for name, rgb in COLOURS.items()
    }
    looks: dict[str, tuple[Shape, ...]] = {
        name: (Shape(Mesh(f"meshes/{name}.obj"), paint=paint),) for name, paint in paints.items()
    }
    foot, socket = Cylinder(0.062, 0.01), Box((0.046, 0.026, 0.018))
    looks["link_base"] += (
        Shape(foot, (0.0, 0.0, 0.005), paint=paints["link_base"]),
        Shape(socket, (-0.069, 0.013, 0.025), paint=paints["link_base"]),
    )
    return looks
