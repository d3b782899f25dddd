"""Bodies that touch a level floor, or are just about to: contacts that are not deep."""

from __future__ import annotations

from typing import Any

from tools.differ.kinds.shapes import BOX, CAPSULE, HEIGHTS, PLANE, SPHERE
from tools.differ.maker import Body, Maker, Reference

_APART = 0.9
_GAP = (-2e-3, 1e-3)


def ground(maker: Maker) -> None:
    """A floor whose surface is level, at 0; it stays as it is."""
    kind = maker.one(("box", "plane", "plane.urdf", "heights"))
    if kind == "plane.urdf":
        maker.call("loadURDF", kind)
        return
    height = 0.0
    if kind == "heights":
        made = _level(maker)
    elif kind == "plane":
        made = maker.call("createCollisionShape", PLANE)
    else:
        made, height = maker.call("createCollisionShape", BOX, halfExtents=[9, 9, 0.5]), -0.5
    maker.call("createMultiBody", 0, made, -1, [0, 0, height])


def _level(maker: Maker) -> Reference:
    """A field of heights that are all the same."""
    count = maker.one((9, 17))
    return maker.call(
        "createCollisionShape",
        HEIGHTS,
        meshScale=[1, 1, 1],
        heightfieldData=[0.25] * count**2,
        numHeightfieldRows=count,
        numHeightfieldColumns=count,
    )


def resting(maker: Maker) -> None:
    """A body beside the others that touches the floor at one place, or is a little above it.

    What stands on several places at once is left to rounding: the solver ends before forces do not change.
    """
    uniform = maker.random.uniform
    kind, radius, turn = maker.one((SPHERE, BOX, BOX, CAPSULE)), uniform(0.05, 0.3), maker.any_turn()
    x, y, z, w = turn
    up = (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    half = radius
    keywords: dict[str, Any] = {"radius": radius}
    if kind == BOX:
        sizes = [uniform(0.05, 0.3) for _ in range(3)]
        half = sum(size * abs(part) for size, part in zip(sizes, up, strict=True))
        keywords = {"halfExtents": sizes}
    elif kind == CAPSULE:
        keywords["height"] = uniform(0.1, 0.4)
        half += 0.5 * keywords["height"] * abs(up[2])
    made = maker.call("createCollisionShape", kind, **keywords)
    place = [_APART * (len(maker.bodies) - 1), uniform(-1, 1), half + uniform(*_GAP)]
    body = maker.call("createMultiBody", uniform(0.2, 3), made, -1, place, turn)
    maker.bodies.append(Body(body, (), place))
    if maker.chance(0.6):
        velocity = [uniform(-1, 1), uniform(-1, 1), uniform(-0.3, 0)]
        maker.call("resetBaseVelocity", body, velocity, maker.vector(1))


def first_steps(maker: Maker) -> None:
    """Two steps, and the contacts of all bodies after each."""
    for _ in range(2):
        maker.call("stepSimulation")
        maker.call("@probe")
        maker.call("getContactPoints")
