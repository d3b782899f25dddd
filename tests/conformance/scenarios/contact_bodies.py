"""Bodies of one link that fall, bounce, roll, slide and stand.

Rocking and tumbling are chaotic, so bodies move in a way that does not amplify rounding, flat on a face or
round, or are followed for a short time only.
"""

from __future__ import annotations

from math import atan, cos, sin
from typing import Any

import numpy as np

from ..scenario import base_motion, scenario, simulate, under

HALF = 0.1
RESTING = HALF - 1e-5


def _floor(p: Any, **surface: float) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 1])
    floor = p.createMultiBody(0, shape, basePosition=[0, 0, -1])
    if surface:
        p.changeDynamics(floor, -1, **surface)
    return floor


def _box(p: Any, position: list[float], mass: float = 1.0, **surface: float) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF, HALF, HALF])
    body = p.createMultiBody(mass, shape, basePosition=position)
    if surface:
        p.changeDynamics(body, -1, **surface)
    return body


def _ball(p: Any, position: list[float], mass: float = 1.0, **surface: float) -> int:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=HALF)
    body = p.createMultiBody(mass, shape, basePosition=position)
    if surface:
        p.changeDynamics(body, -1, **surface)
    return body


def _push(p: Any, body: int) -> dict[str, Any]:
    """The total normal force on a body; not friction, which is but rounding on a body that stands."""
    contacts = p.getContactPoints(body)
    return {"normal_force": [sum(contact[9] * contact[7][axis] for contact in contacts) for axis in range(3)]}


def _observe(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    """Everything about bodies that are round."""
    observed: dict[str, Any] = {}
    for name, body in bodies.items():
        observed |= under(name, base_motion(p, body) | _push(p, body))
    return observed


def _observe_fall(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    """Bodies that do nothing but fall and rise: height, rate of rise, contacts and their force."""
    observed: dict[str, Any] = {}
    for name, body in bodies.items():
        (_, _, height), _ = p.getBasePositionAndOrientation(body)
        (_, _, rise), _ = p.getBaseVelocity(body)
        facts = {"height": height, "rise": rise, "contacts": len(p.getContactPoints(body))}
        observed |= under(name, facts | _push(p, body))
    return observed


def _observe_slide(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    """Where bodies on the slope are and how fast they slide, all in one series."""
    motions = [base_motion(p, body) for body in bodies.values()]
    return {
        "way": [motion["base_position"][0] for motion in motions],
        "speed": [motion["base_velocity"][0] for motion in motions],
    }


def _observe_stack(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    """Heights in a stack, and the force on each box."""
    observed = _observe_fall(p, bodies)
    return {name: value for name, value in observed.items() if name.endswith(("height", "normal_force"))}


@scenario(tolerance=1e-5)
def box_dropped_flat(p: Any) -> dict[str, Any]:
    """A box falls flat on the floor and stays where it is.

    The solver meets the four corners in another order than PyBullet, so that rounding and the end of the
    iterations turn the box by 1e-5 rad to another side. What does not depend on it is compared: measured
    1.2e-6 for the rate of rise, the rest below 1e-8.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p)
    body = _box(p, [0, 0, 0.4])
    return simulate(p, 2.0, lambda: _observe_fall(p, {"box": body}), stride=4)


@scenario()
def balls_that_bounce(p: Any) -> dict[str, Any]:
    """Balls of six restitutions fall side by side."""
    p.setGravity(0, 0, -9.81)
    _floor(p, restitution=0.9)
    bodies = {
        f"restitution {e}": _ball(p, [0.5 * i, 0, 1.0], restitution=e)
        for i, e in enumerate((0.0, 0.3, 0.5, 0.8, 0.9, 1.0))
    }
    return simulate(p, 2.0, lambda: _observe_fall(p, bodies), stride=4)


@scenario()
def balls_that_roll(p: Any) -> dict[str, Any]:
    """Balls thrown over the floor: sliding into rolling, with rolling and with spinning friction."""
    p.setGravity(0, 0, -9.81)
    _floor(p, lateralFriction=1.0, rollingFriction=0.5, spinningFriction=0.5)
    surfaces = {
        "slides, then rolls": {"lateralFriction": 0.2},
        "rolling friction": {"rollingFriction": 0.01},
        "spinning friction": {"spinningFriction": 0.02},
    }
    bodies = {
        name: _ball(p, [0, 1.0 * i, HALF], **surface) for i, (name, surface) in enumerate(surfaces.items())
    }
    for body in bodies.values():
        p.resetBaseVelocity(body, [2, 0, 0], [0, 3, 10])
    return simulate(p, 2.0, lambda: _observe(p, bodies))


@scenario()
def ball_rolls_down_a_slope(p: Any) -> dict[str, Any]:
    """A ball gathers speed on a slope of 0.3 rad without slipping."""
    slope = 0.3
    p.setGravity(0, 0, -9.81)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 1])
    turn = p.getQuaternionFromEuler([0, slope, 0])
    p.createMultiBody(0, shape, basePosition=[-sin(slope), 0, -cos(slope)], baseOrientation=turn)
    body = _ball(p, [HALF * sin(slope), 0, HALF * cos(slope)])
    return simulate(p, 2.0, lambda: _observe(p, {"ball": body}))


@scenario(tolerance=1e-2)
def boxes_on_a_slope(p: Any) -> dict[str, Any]:
    """Boxes on a slope whose tangent is 0.4: friction 0.6 holds one, 0.2 lets the other slide.

    The order of the four corners makes the sliding box yaw and rock by some 1e-4 rad, differently in the two
    engines: measured 1.3e-3 for the speed, 4.0e-5 for the way.
    """
    slope = atan(0.4)
    p.setGravity(9.81 * sin(slope), 0, -9.81 * cos(slope))
    _floor(p, lateralFriction=1.0)
    bodies = {
        f"friction {friction}": _box(p, [0, i, RESTING], lateralFriction=friction)
        for i, friction in enumerate((0.6, 0.2))
    }
    return simulate(p, 2.0, lambda: _observe_slide(p, bodies))


@scenario(tolerance=1e-2)
def three_boxes_stacked(p: Any) -> dict[str, Any]:
    """Three boxes of different mass stand on each other.

    While they settle, the order of the corners decides how the load is shared: measured 1.5e-3 for the
    force on the lightest box in the first step, 1.4e-5 for the heights.
    """
    p.setGravity(0, 0, -9.81)
    _floor(p)
    bodies = {
        f"box {i}": _box(p, [0, 0, RESTING * (1 + 2 * i)], mass) for i, mass in enumerate((2.0, 1.0, 0.5))
    }
    return simulate(p, 2.0, lambda: _observe_stack(p, bodies))


@scenario()
def soft_contact(p: Any) -> dict[str, Any]:
    """Boxes and a ball whose stiffness and damping, and those of the floor, are given."""
    p.setGravity(0, 0, -9.81)
    _floor(p, contactStiffness=50000.0, contactDamping=20.0)
    bodies = {
        "soft": _box(p, [0, 0, 0.2], contactStiffness=1000.0, contactDamping=10.0),
        "stiff": _box(p, [1, 0, 0.2], contactStiffness=20000.0, contactDamping=100.0),
        "ball": _ball(p, [2, 0, 0.2], contactStiffness=1000.0, contactDamping=1.0),
    }
    return simulate(p, 2.0, lambda: _observe_fall(p, bodies), stride=4)


@scenario()
def balls_in_a_row(p: Any) -> dict[str, Any]:
    """A ball runs into another in free space, straight and then off centre."""
    straight = {
        "striker": _ball(p, [-0.5, 0, 0], restitution=0.95, linearDamping=0.0),
        "target": _ball(p, [0, 0, 0], mass=2.0, restitution=0.95, linearDamping=0.0),
    }
    oblique = {
        "oblique striker": _ball(p, [-0.5, 2.05, 0], restitution=0.95, linearDamping=0.0),
        "oblique target": _ball(p, [0, 2.0, 0], restitution=0.95, linearDamping=0.0),
    }
    for bodies in (straight, oblique):
        p.resetBaseVelocity(next(iter(bodies.values())), [2, 0, 0], [0, 0, 0])
    return simulate(p, 0.5, lambda: _observe(p, straight | oblique), stride=2)


@scenario(tolerance=5e-4)
def contact_with_substeps(p: Any) -> dict[str, Any]:
    """A box and a bouncing ball fall while every step is made of four substeps.

    The order of the box's corners changes the force at its impact: measured 5.7e-5.
    """
    p.setGravity(0, 0, -9.81)
    p.setPhysicsEngineParameter(numSubSteps=4)
    _floor(p, restitution=0.9)
    bodies = {"box": _box(p, [0, 0, 0.4]), "ball": _ball(p, [1, 0, 0.7], restitution=0.7)}
    return simulate(p, 1.5, lambda: _observe_fall(p, bodies))


@scenario()
def boxes_tumble(p: Any) -> dict[str, Any]:
    """Boxes thrown on a plane and on a block, flat and tumbling, and others that fall on them turned."""
    results: dict[str, Any] = {}
    for ground in ("plane", "block"):
        for name, turn, spin in (
            ("flat", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
            ("tumbling", (0.1, 0.2, 0.3), (3.0, 2.0, 1.0)),
            ("turned", (0.02, 0.01, 0.1), (0.0, 0.0, 5.0)),
        ):
            p.resetSimulation()
            p.setGravity(0, 0, -10)
            block = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5])
            plane = p.createCollisionShape(p.GEOM_PLANE)
            if ground == "plane":
                p.createMultiBody(0, plane)
            else:
                p.createMultiBody(0, block, -1, [0, 0, -0.5])
            shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.12, 0.08])
            orientation = p.getQuaternionFromEuler(turn)
            tilted = p.getQuaternionFromEuler([0.05, -0.03, 0.4])
            lower = p.createMultiBody(1.0, shape, -1, [0.0, 0.0, 0.12], orientation)
            upper = p.createMultiBody(1.0, shape, -1, [0.03, 0.02, 0.36], tilted)
            p.resetBaseVelocity(lower, [0.5, 0.2, -0.5], spin)
            p.resetBaseVelocity(upper, [0.4, 0.2, -1.0], [0.0, 0.0, 2.0])
            motion = simulate(p, 0.2, lambda b=(lower, upper): _both(p, b), stride=1)
            results |= under(f"{ground}/{name}", motion)
    return results


def _land_on_a_table(p: Any, shape: int, height: float) -> dict[str, Any]:
    """A body of this shape lands on a table from two heights, flat and leaning, and comes to rest."""
    results: dict[str, Any] = {}
    for drop in (0.005, 0.02):
        for name, lean in (("flat", 0.0), ("leaning", 0.003)):
            table = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.1])
            tables = p.createMultiBody(0, table, -1, [0, 0, -0.1])
            orientation = p.getQuaternionFromEuler([lean, 0.6 * lean, 0.3])
            body = p.createMultiBody(0.1, shape, -1, [0.05, 0.03, height + drop], orientation)

            def landing(body: int = body) -> dict[str, Any]:
                contacts = p.getContactPoints(body)
                return {"position": p.getBasePositionAndOrientation(body)[0], "contacts": len(contacts)}

            motion = simulate(p, 0.15, landing, stride=1)
            simulate(p, 1.5, landing)
            position, orientation = p.getBasePositionAndOrientation(body)
            motion["rest"] = np.array([*position, *orientation])
            results |= under(f"{name} from {drop}", motion)
            p.removeBody(body)
            p.removeBody(tables)
    return results


@scenario(tolerance={"position": 2e-5, "rest": 2e-3})
def pucks_land_on_a_table(p: Any) -> dict[str, Any]:
    """A puck lands on a box flat and leaning, gathers its points one by one and comes to rest."""
    p.setGravity(0, 0, -9.81)
    return _land_on_a_table(p, p.createCollisionShape(p.GEOM_CYLINDER, radius=0.04, height=0.03), 0.015)


@scenario(tolerance={"rest": 2e-3})
def bricks_land_on_a_table(p: Any) -> dict[str, Any]:
    """A brick that is a hull does the same."""
    p.setGravity(0, 0, -9.81)
    corners = [(x, y, z) for x in (-0.03, 0.03) for y in (-0.04, 0.04) for z in (-0.02, 0.02)]
    return _land_on_a_table(p, p.createCollisionShape(p.GEOM_MESH, vertices=corners), 0.021)


def _both(p: Any, bodies: tuple[int, int]) -> dict[str, Any]:
    return {
        "position": [p.getBasePositionAndOrientation(body)[0] for body in bodies],
        "orientation": [p.getBasePositionAndOrientation(body)[1] for body in bodies],
        "velocity": [p.getBaseVelocity(body)[0] for body in bodies],
    }


@scenario(tolerance=1e-9)
def rolling_friction_yields_with_global_cfm(p: Any) -> dict[str, Any]:
    """A brick that leans into a plane: what yields are its rolling and spinning friction, too."""
    series: dict[str, Any] = {}
    for name, friction in (("rolling", {"rollingFriction": 0.01}), ("spinning", {"spinningFriction": 0.01})):
        p.resetSimulation()
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.05, 0.05])
        turn = p.getQuaternionFromEuler([0.6, 0.9, 0.4])
        brick = p.createMultiBody(3, shape, basePosition=[0, 0, 0.119], baseOrientation=turn)
        p.changeDynamics(brick, -1, **friction)
        p.changeDynamics(brick, -1, localInertiaDiagonal=[0.09, 0.01, 0.26])
        p.setPhysicsEngineParameter(globalCFM=0.01)
        p.resetBaseVelocity(brick, [0, 0, 0], [0.1, 0.2, 0.3])
        series |= under(name, simulate(p, 2 / 240, lambda brick=brick: base_motion(p, brick)))
    return series


@scenario()
def edge_comes_near_an_edge_of_a_mesh(p: Any) -> dict[str, Any]:
    """A hull falls with an edge down onto the ridge of a mesh, which slows it before it touches."""
    p.setGravity(0, 0, -9.81)
    ridge = [[-1, 0, 0], [1, 0, 0], *([x, y, -0.5] for y in (-0.5, 0.5) for x in (-1, 1))]
    sides = [0, 2, 1, 1, 2, 3, 0, 1, 4, 1, 5, 4]
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_MESH, vertices=ridge, indices=sides))
    wedge = [[0.1, -0.2, 0], [0.1, 0.2, 0], *([x, y, 0.3] for y in (-0.2, 0.2) for x in (-0.1, 0.3))]
    hull = p.createCollisionShape(p.GEOM_MESH, vertices=wedge)
    body = p.createMultiBody(1, hull, basePosition=[0.1, 0, 0.006], baseInertialFramePosition=[0.1, 0, 0.15])

    def observe() -> dict[str, Any]:
        points = p.getContactPoints()
        return {
            "height": p.getBasePositionAndOrientation(body)[0][2],
            "touches": min(len(points), 1),
            "distance": min((point[8] for point in points), default=0.0),
            "force": sum(point[9] for point in points),
        }

    return simulate(p, 0.08, observe, stride=1)
