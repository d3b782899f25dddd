"""Dynamics and kinematics that are asked for, and not simulated."""

from __future__ import annotations

from tools.differ.assets import PLANAR, SPHERICAL
from tools.differ.maker import Body, Maker

_COORDINATES = {SPHERICAL: 4, PLANAR: 3}


def algorithm(maker: Maker) -> None:
    """Ask for forces, a mass matrix, a Jacobian or an answer of inverse kinematics."""
    body = _one_that_moves(maker)
    if not body.moving:
        return
    if body.of_type(SPHERICAL):
        maker.one((lambda: maker.call("computeDofCount", body.reference), lambda: kinematics(maker)))()
        return
    count = sum(_COORDINATES.get(body.joints[joint].type, 1) for joint in body.moving)

    def many(size: float) -> list[float]:
        return [maker.number(-size, size) for _ in range(count)]

    kind = maker.random.randrange(5)
    if kind == 0:
        floating = maker.chance(0.2)
        positions, rest = [0.0] * 7 * floating, [0.0] * 6 * floating
        values = many(1) + positions, many(2) + rest, many(2) + rest
        maker.call("calculateInverseDynamics", body.reference, *values)
    elif kind == 1:
        maker.call("calculateMassMatrix", body.reference, many(1))
    elif kind < 4:
        link, point = maker.link(body, base=False), maker.vector(0.3)
        maker.call("calculateJacobian", body.reference, link, point, many(1), many(1), many(1))
    else:
        kinematics(maker)


def kinematics(maker: Maker) -> None:
    """Ask for an answer of inverse kinematics, and see how far it reaches."""
    body = _one_that_moves(maker)
    if not body.moving:
        return
    count, uniform = body.velocities, maker.random.uniform
    turn = maker.turn()
    keywords = maker.some(
        targetOrientation=turn,
        jointDamping=[maker.one((0.1, 0.01))] * count,
        maxNumIterations=maker.one((1, 20, 100, 200)),
        residualThreshold=maker.one((1e-4, 1e-5, 0.1)),
    )
    if maker.chance(0.2):
        keywords["currentPositions"] = [maker.number(-1, 1) for _ in range(count)]
    if maker.chance(0.2):
        keywords["solver"] = 0
    if maker.chance(0.8):
        links = [maker.one(range(len(body.joints)))]
        if maker.chance(0.25):
            rest = [maker.number(-1, 1) for _ in range(count)]
            limits = {"lowerLimits": [-2.5] * count, "upperLimits": [2.5] * count}
            keywords |= {**limits, "jointRanges": [5] * count, "restPoses": rest}
        near = [coordinate + uniform(-0.4, 0.4) for coordinate in body.place]
        targets = [maker.place() if maker.chance(0.3) else near]
        answer = maker.call("calculateInverseKinematics", body.reference, links[0], targets[0], **keywords)
    else:
        links = maker.random.sample(range(len(body.joints)), min(2, len(body.joints)))
        keywords.pop("targetOrientation", None)
        targets = [[coordinate + uniform(-0.3, 0.3) for coordinate in body.place] for _ in links]
        answer = maker.call("calculateInverseKinematics2", body.reference, links, targets, **keywords)
    if not body.of_type(SPHERICAL, PLANAR):
        turn = keywords.get("targetOrientation")
        maker.call("@reach", body.reference, links, {"whole": answer["$"]}, targets, turn)


def _one_that_moves(maker: Maker) -> Body:
    return maker.one([body for body in maker.bodies if body.moving] or maker.bodies)
