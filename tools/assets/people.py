"""Robots on two legs."""

from __future__ import annotations

from tools.assets.measured import Dress, dressed
from tools.assets.parts import Paint, Robot, Shape, Sphere

SKIN = Paint("skin", (0.87, 0.66, 0.5, 1.0), (0.1, 0.1, 0.1))
SHIRT = Paint("shirt", (0.16, 0.36, 0.66, 1.0), (0.1, 0.1, 0.1))
TROUSERS = Paint("trousers", (0.24, 0.25, 0.32, 1.0), (0.1, 0.1, 0.1))
SHOES = Paint("shoes", (0.1, 0.1, 0.11, 1.0))
GREY = Paint("grey", (0.6, 0.62, 0.66, 1.0), (0.4, 0.4, 0.4))


def humanoid() -> Robot:
    """The figure that imitates motion capture; y is up and its size is four times a person's."""
    eyes = tuple(Shape(Sphere(0.05), (0.38, 0.25, side * 0.14), paint=SHOES) for side in (-1.0, 1.0))
    return dressed(
        "humanoid/humanoid.urdf",
        "A person with ball joints, of balls and capsules.",
        Dress(
            paint={
                "neck": SKIN,
                "chest": SHIRT,
                "*_shoulder": SHIRT,
                "*_elbow": SKIN,
                "*_wrist": SKIN,
                "*_ankle": SHOES,
                "*": TROUSERS,
            },
            more={"neck": eyes},
        ),
    )


def biped2d() -> Robot:
    return dressed(
        "biped/biped2d_pybullet.urdf",
        "A walker that stays in the plane of y and z.",
        Dress(paint={"torso": SHIRT, "*_foot": SHOES, "r_*": TROUSERS, "*": GREY}),
    )
