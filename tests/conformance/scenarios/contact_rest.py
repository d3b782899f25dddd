"""Bodies that come to rest, roll on and stand: what a user sees of contact in the long run.

Rocking and tumbling amplify rounding until nothing of the way agrees; where bodies end, and when, does.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

from ..scenario import load_asset, scenario, simulate

STILL = 0.01
"""A body whose speeds are below this is at rest [m/s and rad/s]."""


def _floor(p: Any, **surface: float) -> int:
    floor = load_asset(p, "plane.urdf")
    if surface:
        p.changeDynamics(floor, -1, **surface)
    return floor


def _speed(p: Any, body: int) -> float:
    linear, angular = p.getBaseVelocity(body)
    return max(abs(x) for x in (*linear, *angular))


def _time_of_rest(p: Any, body: int, seconds: float) -> float:
    """Step for a time; the last moment at which the base moved."""
    last = 0
    for step in range(round(seconds * 240)):
        p.stepSimulation()
        if _speed(p, body) > STILL:
            last = step
    return (last + 1) / 240.0


@scenario(tolerance={"rest": 2.1e-3, "orientation": 4.3e-3, "time": 5e-2})
def r2d2_dropped(p: Any) -> dict[str, Any]:
    """R2D2 falls from 2 m on its wheels and comes to rest: within 1 mm and half a degree, at the same time.

    Measured 0.9 mm along the wheels' way, 10 µm in height, 0.01 degrees, and the same step.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p)
    body = load_asset(p, "r2d2.urdf", basePosition=[0, 0, 2.0])
    time = _time_of_rest(p, body, 6.0)
    position, orientation = p.getBasePositionAndOrientation(body)
    return {"rest": position, "orientation": orientation, "time": [time]}


TILT = 1e-3
"""By which one end of what lies is lower [rad]; otherwise rounding decides which touches first."""


def _roller(p: Any, shape: int, y: float, radius: float, spins: bool, rolling: float) -> int:
    turn = p.getQuaternionFromEuler([pi / 2.0 + TILT, 0, 0])
    body = p.createMultiBody(1.0, shape, basePosition=[0, y, radius], baseOrientation=turn)
    p.changeDynamics(body, -1, lateralFriction=1.0, rollingFriction=rolling)
    p.resetBaseVelocity(body, [1, 0, 0], [0, 1.0 / radius if spins else 0.0, 0])
    return body


def _way(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    return {name: p.getBasePositionAndOrientation(body)[0][0] for name, body in bodies.items()}


@scenario(tolerance={"ball": 1e-6, "cylinder": 1e-3, "capsule": 1e-6})
def round_things_roll(p: Any) -> dict[str, Any]:
    """A ball, a cylinder and a capsule roll on, with and without rolling friction.

    One end of a lying cylinder is found at a time, so that it rocks from end to end and rolls 1 mm deep.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p, lateralFriction=1.0)
    shapes = {
        "ball": p.createCollisionShape(p.GEOM_SPHERE, radius=0.1),
        "cylinder": p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.3),
        "capsule": p.createCollisionShape(p.GEOM_CAPSULE, radius=0.1, height=0.3),
    }
    bodies = {
        f"rolling friction {rolling}/{name}": _roller(p, shape, 2.0 * i + 1.0 * j, 0.1, True, rolling)
        for i, (name, shape) in enumerate(shapes.items())
        for j, rolling in enumerate((0.0, 0.01))
    }
    return simulate(p, 2.0, lambda: _way(p, bodies))


@scenario(tolerance={"cylinder": 2e-3, "slender": 3e-3, "flat": 2e-2})
def cylinders_slide_and_roll(p: Any) -> dict[str, Any]:
    """Lying cylinders, slender and flat, slide until they roll, with and without rolling friction.

    Measured 1e-4 and 5e-4; 1 % for the flat one as it comes to rest.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p, lateralFriction=1.0)
    sizes = {"cylinder": (0.1, 0.3), "flat": (0.2, 0.1), "slender": (0.05, 0.6)}
    bodies: dict[str, int] = {}
    for name, (radius, height) in sizes.items():
        shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=radius, height=height)
        for rolling in (0.0, 0.01):
            bodies[f"rolling friction {rolling}/{name}"] = _roller(
                p, shape, 1.5 * len(bodies), radius, False, rolling
            )
    return simulate(p, 2.0, lambda: _way(p, bodies))


def _wheel(p: Any, radius: float, width: float, sides: int) -> int:
    """A hull of points around the y axis of the body."""
    rim = [(radius * sin(a), radius * cos(a)) for a in (0.1 + 2.0 * pi * i / sides for i in range(sides))]
    points = [[x, y, z] for x, z in rim for y in (-width / 2, width / 2)]
    return p.createCollisionShape(p.GEOM_MESH, vertices=points)


@scenario()
def wheels_of_many_sides_roll(p: Any) -> dict[str, Any]:
    """Hulls that are wheels roll from corner to corner and come to rest sooner the fewer they have."""
    p.setGravity(0, 0, -9.81)
    _floor(p)
    sizes = {"10 sides": (0.15, 0.1, 10), "16 sides": (0.1, 0.1, 16), "40 sides": (0.2, 0.08, 40)}
    bodies: dict[str, int] = {}
    for name, (radius, width, sides) in sizes.items():
        body = p.createMultiBody(
            1.0, _wheel(p, radius, width, sides), basePosition=[0, len(bodies), radius + 0.002]
        )
        p.resetBaseVelocity(body, [1, 0, 0], [0, 1.0 / radius, 0])
        bodies[name] = body
    return simulate(p, 2.0, lambda: _way(p, bodies))


@scenario(tolerance=1e-3)
def ten_boxes_stand(p: Any) -> dict[str, Any]:
    """A stack of ten cubes stands for ten seconds: measured 2e-4 for its heights.

    It creeps by some millimetres in both engines, as the order of the corners has it.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05] * 3)
    bodies = [p.createMultiBody(0.2, shape, basePosition=[0, 0, 0.05 + 0.1 * i]) for i in range(10)]

    def observe() -> dict[str, Any]:
        places = [p.getBasePositionAndOrientation(body)[0] for body in bodies]
        stands = [max(abs(x), abs(y)) < 0.01 for x, y, _ in places]
        return {"heights": [z for _, _, z in places], "stands": stands}

    return simulate(p, 10.0, observe, stride=240)


@scenario(tolerance=1e-3)
def things_rest_on_their_weight(p: Any) -> dict[str, Any]:
    """Bodies of every shape lie on the floor; the normal forces on each add up to its weight."""
    p.setGravity(0, 0, -9.81)
    floor = _floor(p)
    corners = [[x, y, z] for x in (-0.1, 0.1) for y in (-0.2, 0.2) for z in (-0.1, 0.1)]
    shapes = {
        "box": (p.GEOM_BOX, {"halfExtents": [0.2, 0.15, 0.1]}, 0.1),
        "ball": (p.GEOM_SPHERE, {"radius": 0.1}, 0.1),
        "cylinder": (p.GEOM_CYLINDER, {"radius": 0.15, "height": 0.2}, 0.1),
        "capsule": (p.GEOM_CAPSULE, {"radius": 0.1, "height": 0.3}, 0.1),
        "hull": (p.GEOM_MESH, {"vertices": corners}, 0.1),
    }
    bodies: dict[str, int] = {}
    for i, (name, (kind, size, height)) in enumerate(shapes.items()):
        turn = p.getQuaternionFromEuler([1.5707963267948966 if name == "capsule" else 0.0, 0, 0])
        shape = p.createCollisionShape(kind, **size)
        bodies[name] = p.createMultiBody(1.0 + i, shape, basePosition=[i, 0, height], baseOrientation=turn)
    for _ in range(480):
        p.stepSimulation()
    return {
        f"force on the {name}": [sum(contact[9] for contact in p.getContactPoints(body, floor))]
        for name, body in bodies.items()
    }
