"""Boxes that meet one after the other: the order in which contacts are relaxed depends on when bounds met.

Boxes slide, since bodies at rest are solved more precisely here than in PyBullet.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

from ..scenario import scenario, simulate, under

HALF = 0.1
_BALLS = 0.6
_CHANGED, _LIFTED = 5, 40


def _boxes(p: Any, heights: Sequence[float]) -> list[int]:
    """Boxes above each other that slide on an infinite plane, in the order of their heights."""
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF, HALF, HALF])
    bodies = [p.createMultiBody(1, shape, basePosition=[0.01 * z, 0.02 * z, z]) for z in heights]
    for body in bodies:
        p.resetBaseVelocity(body, [1.0, 0.5, 0.0])
    return bodies


def _places(p: Any, bodies: Sequence[int]) -> dict[str, Any]:
    return {f"place of {i}": p.getBasePositionAndOrientation(body)[0] for i, body in enumerate(bodies)}


@scenario()
def stack_with_gaps_slides(p: Any) -> dict[str, Any]:
    """Three boxes with gaps of 5 mm between them fall on each other while they slide on a plane."""
    bodies = _boxes(p, [HALF + 0.005 + 0.205 * i for i in range(3)])
    return simulate(p, 0.25, lambda: _places(p, bodies))


@scenario()
def boxes_of_a_stack_in_another_order_slide(p: Any) -> dict[str, Any]:
    """Six boxes with gaps of 5 mm, created in another order than they stand."""
    bodies = _boxes(p, [HALF + 0.005 + 0.205 * i for i in (2, 0, 4, 5, 1, 3)])
    return simulate(p, 0.25, lambda: _places(p, bodies))


@scenario(tolerance=1e-9)
def boxes_of_a_stack_in_order_of_bodies_slide(p: Any) -> dict[str, Any]:
    """The same six boxes with `deterministicOverlappingPairs`; they agree to rounding."""
    p.setPhysicsEngineParameter(deterministicOverlappingPairs=1)
    bodies = _boxes(p, [HALF + 0.005 + 0.205 * i for i in (2, 0, 4, 5, 1, 3)])
    return simulate(p, 0.25, lambda: _places(p, bodies))


def _cubes(p: Any, floor: int, places: Sequence[tuple[float, ...]]) -> list[int]:
    """Cubes above an infinite plane or on top of a large box."""
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    if floor == p.GEOM_PLANE:
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    else:
        ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 0.5])
        p.createMultiBody(0, ground, basePosition=[0, 0, -0.5])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF, HALF, HALF])
    return [p.createMultiBody(1, shape, basePosition=place) for place in places]


@scenario(tolerance=1e-9)
def cubes_that_touch_slide(p: Any) -> dict[str, Any]:
    """Rows and columns of three cubes that touch each other exactly slide on a box and on a plane.

    Several faces are equally deep, so rounding decides which one touches; they agree to rounding.
    """
    results: dict[str, Any] = {}
    for name, floor in {"box": p.GEOM_BOX, "plane": p.GEOM_PLANE}.items():
        for layout, step in {"row": (2 * HALF, 0.0), "column": (0.0, 2 * HALF)}.items():
            bodies = _cubes(p, floor, [(i * step[0], 0.0, HALF + i * step[1]) for i in range(3)])
            for body in bodies:
                p.resetBaseVelocity(body, [1, 0, 0])
            observed = simulate(p, 0.3, lambda b=bodies: _places(p, b), stride=12)
            results |= under(f"{layout} on a {name}", observed)
    return results


def _reset_in_order(p: Any, floor: int, order: Sequence[int], start: tuple[float, ...] | None) -> list[int]:
    """27 cubes with gaps of 5 mm above a plane or a box, which all get a velocity in some order.

    With `start` they are created elsewhere, and put in their places in this order.
    """
    places = [
        (0.205 * i + 0.01 * k, 0.205 * j + 0.02 * k, HALF + 0.005 + 0.205 * k)
        for i in range(3)
        for j in range(3)
        for k in range(3)
    ]
    elsewhere = None if start is None else [(start[0] + 2.0 * i, *start[1:]) for i in range(27)]
    bodies = _cubes(p, floor, elsewhere or places)
    for i in order:
        if elsewhere is not None:
            p.resetBasePositionAndOrientation(bodies[i], places[i], [0, 0, 0, 1])
        p.resetBaseVelocity(bodies[i], [1.0, 0.5, 0.0])
    return bodies


@scenario(tolerance=1e-9)
def cubes_are_reset_before_the_first_step(p: Any) -> dict[str, Any]:
    """Cubes get velocities, and places, in another order than they were created, before pairs are known.

    They agree to rounding.
    """
    shuffled = [7 * i % 27 for i in range(27)]
    results: dict[str, Any] = {}
    for name, floor in {"box": p.GEOM_BOX, "plane": p.GEOM_PLANE}.items():
        for case, start in {"velocities": None, "places": (5.0, 5.0, 1.0)}.items():
            bodies = _reset_in_order(p, floor, shuffled, start)
            observed = simulate(p, 0.2, lambda b=bodies: _places(p, b), stride=12)
            results |= under(f"{case} on a {name}", observed)
    return results


@scenario(tolerance=1e-9)
def rolling_friction_without_a_cone(p: Any) -> dict[str, Any]:
    """Two balls on a hinge roll on a box and against a wall, and the solver stops after some sweeps.

    Without a cone the rolling friction of each contact is relaxed right before its lateral friction.
    """
    results: dict[str, Any] = {}
    for cone in (0, 1):
        p.resetSimulation()
        p.setGravity(0.5, 0.2, -9.81)
        p.setPhysicsEngineParameter(enableConeFriction=cone, numSolverIterations=7, solverResidualThreshold=0)
        ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5])
        for place in ([0, 0, -0.5], [5.35, 0, 2]):
            p.createMultiBody(0, ground, basePosition=place)
        ball = p.createCollisionShape(p.GEOM_SPHERE, radius=HALF)
        pair = p.createMultiBody(
            1, ball, basePosition=[0, 0, HALF + 0.005],
            linkMasses=[0.5], linkCollisionShapeIndices=[ball], linkVisualShapeIndices=[-1],
            linkPositions=[[0.24, 0.03, 0.01]], linkOrientations=[[0, 0, 0, 1]],
            linkInertialFramePositions=[[0, 0, 0]], linkInertialFrameOrientations=[[0, 0, 0, 1]],
            linkParentIndices=[0], linkJointTypes=[p.JOINT_REVOLUTE], linkJointAxis=[[0.6, 0.8, 0]],
        )  # fmt: skip
        for link in (-1, 0):
            p.changeDynamics(pair, link, rollingFriction=0.05, spinningFriction=0.02)
        p.resetBaseVelocity(pair, [0.4, 0.2, 0], [1, 2, 3])
        results |= under(f"cone {cone}", simulate(p, 0.25, lambda b=pair: _places(p, [b]), stride=6))
    return results


def _parts(p: Any, seed: int, count: int) -> int:
    """A link with balls and boxes in random places, all of which touch the ground."""
    random = Random(seed)
    spots = random.sample([(0.3 * x, 0.3 * y) for x in range(4) for y in range(3)], count)
    radii = [random.uniform(0.06, 0.12) for _ in spots]
    turned = p.getQuaternionFromEuler([0, 0, 0.7])
    places = [
        [x + random.uniform(-0.01, 0.01), y + random.uniform(-0.01, 0.01), radius]
        for (x, y), radius in zip(spots, radii, strict=True)
    ]
    kinds = [p.GEOM_SPHERE if random.random() < _BALLS else p.GEOM_BOX for _ in spots]
    shape = p.createCollisionShapeArray(
        shapeTypes=kinds,
        radii=radii,
        halfExtents=[[radius, 0.5 * radius, radius] for radius in radii],
        collisionFramePositions=places,
        collisionFrameOrientations=[turned] * count,
    )
    middle = [0.4, 0.3, 0.1]
    return p.createMultiBody(1, shape, baseInertialFramePosition=middle, basePosition=[0, 0, -1e-4])


def _ground(p: Any, kind: str) -> None:
    """A plane, a box, or a link of six boxes beside each other, up to a height of 0."""
    if kind == "plane":
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    elif kind == "box":
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[3, 3, 0.5])
        p.createMultiBody(0, box, basePosition=[0, 0, -0.5])
    else:
        spots = [[0.6 * x, 0.5 * y, -0.5] for x, y in ((1, 0), (0, 1), (2, 0), (0, 0), (2, 1), (1, 1))]
        boxes = p.createCollisionShapeArray(
            shapeTypes=[p.GEOM_BOX] * len(spots),
            halfExtents=[[0.3, 0.25, 0.5]] * len(spots),
            collisionFramePositions=spots,
        )
        p.createMultiBody(0, boxes)


@scenario(tolerance=1e-9)
def parts_of_a_link_touch(p: Any) -> dict[str, Any]:
    """Links of two to seven balls and boxes slide, and the solver stops after five sweeps.

    Their contacts come in the order of a tree of their bounds. They agree to rounding.
    """
    results: dict[str, Any] = {}
    for kind in ("plane", "box", "boxes"):
        for count in (2, 3, 4, 7):
            p.resetSimulation()
            p.setGravity(0, 0, -9.81)
            p.setPhysicsEngineParameter(numSolverIterations=5, solverResidualThreshold=0)
            _ground(p, kind)
            body = _parts(p, count, count)
            p.resetBaseVelocity(body, [0.7, 0.4, 0], [0, 0, 1])
            observed = simulate(p, 0.05, lambda b=body: _places(p, [b]))
            results |= under(f"{count} parts on {kind}", observed)
            results[f"{count} parts on {kind}: order"] = [point[5] for point in p.getContactPoints()]
    return results


@scenario(tolerance=1e-9)
def thresholds_of_pairs_that_have_met(p: Any) -> dict[str, Any]:
    """Balls fall, and `contactProcessingThreshold` changes: it counts for pairs whose bounds meet later.

    One ball is near the ground when it changes, one is not, one is put up and falls again, and one is
    allowed to push again. They agree to rounding.
    """
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=HALF)
    heights = (0.01, 0.2, 0.01, 0.01)
    balls = [p.createMultiBody(1, ball, basePosition=[i, 0, HALF + h]) for i, h in enumerate(heights)]
    p.changeDynamics(balls[3], -1, contactProcessingThreshold=0)
    places: list[list[float]] = []
    for step in range(96):
        if step == _CHANGED:
            for body in balls:
                threshold = 1.0 if body == balls[3] else 0.0
                p.changeDynamics(body, -1, contactProcessingThreshold=threshold)
        if step == _LIFTED:
            p.resetBasePositionAndOrientation(balls[2], [2, 0, 0.5], [0, 0, 0, 1])
            p.stepSimulation()
            p.resetBasePositionAndOrientation(balls[2], [2, 0, HALF + 0.01], [0, 0, 0, 1])
            p.resetBaseVelocity(balls[2], [0, 0, 0], [0, 0, 0])
        p.stepSimulation()
        places.append([p.getBasePositionAndOrientation(body)[0][2] for body in balls])
    return {"heights": places}
