"""Floors, and single shapes above one, of MJCF files."""

from __future__ import annotations

from typing import Literal

from tools.assets.gym_runners import FLOOR, GREEN, MODEST, RED
from tools.assets.mjcf_text import Body, Geom, Model
from tools.assets.parts import Vector3


def ground_plane() -> Model:
    floor = Geom("plane", (1000.0, 1000.0, 0.125), "floor", rgba=FLOOR)
    return Model("ground_plane", "A floor.", (floor,), MODEST)


def ground() -> Model:
    """A floor with the name of the humanoid's world."""
    floor = Geom("plane", (20.0, 20.0, 0.125), "floor", rgba=FLOOR)
    return Model("humanoid", "A floor.", (floor,), (1.0, 0.1, 0.1))


def _above_ground(shape: Geom) -> Model:
    """One shape that can fall on a floor from 1 m, in a world without a name."""
    floor = Geom("plane", (1.0, 1.0, 0.1), rgba=RED)
    body = Body("", (0.0, 0.0, 1.0), geoms=(shape,), free="")
    return Model("", "A shape above a floor.", (floor, body), (0.5, 0.005, 0.0001), GREEN)


def long_shape(kind: Literal["capsule", "cylinder"], axis: Vector3 | None) -> Model:
    """A capsule or a cylinder, 20 cm long between the middles of its ends, along an axis or as it is."""
    name = "aux_1_geom"
    if axis is None:
        return _above_ground(Geom(kind, (0.05, 0.1), name))
    x, y, z = (0.1 * part for part in axis)
    return _above_ground(Geom(kind, (0.05,), name, ends=((-x, -y, -z), (x, y, z))))


def hello() -> Model:
    """A box."""
    return _above_ground(Geom("box", (0.1, 0.2, 0.3)))
