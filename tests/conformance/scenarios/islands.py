"""Bodies near each other that do not touch: Bullet sweeps over their rows together, and stops for all.

The scenarios end before bodies come to rest, since those are solved more precisely here than in PyBullet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ..scenario import load_asset, scenario, simulate, under

HALF = 0.1


def _boxes(p: Any, turn: float, places: Sequence[tuple[float, float, float]]) -> list[int]:
    """Boxes above an infinite plane, each turned by more than the one before."""
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF, HALF, HALF])
    bodies = []
    for i, place in enumerate(places):
        orientation = p.getQuaternionFromEuler([turn * 2 * (i + 1), turn * 1.3 * (i + 2), 0.0])
        bodies.append(p.createMultiBody(1, shape, basePosition=place, baseOrientation=orientation))
    return bodies


def _hinge(p: Any, shape: int) -> dict[str, Any]:
    """What `createMultiBody` takes for a link on a hinge."""
    return {
        "linkCollisionShapeIndices": [shape],
        "linkVisualShapeIndices": [-1],
        "linkPositions": [[0.1, -0.4, 0.5]],
        "linkOrientations": [[0, 0, 0, 1]],
        "linkInertialFramePositions": [[0, 0, 0]],
        "linkInertialFrameOrientations": [[0, 0, 0, 1]],
        "linkParentIndices": [0],
        "linkJointTypes": [p.JOINT_REVOLUTE],
        "linkJointAxis": [[0, 1, 0]],
    }


def _places(p: Any, bodies: Sequence[int]) -> dict[str, Any]:
    return {f"place of {i}": p.getBasePositionAndOrientation(body)[0] for i, body in enumerate(bodies)}


@scenario(tolerance=1e-9)
def boxes_side_by_side_land(p: Any) -> dict[str, Any]:
    """Four boxes land beside each other, with gaps of 2 cm: they agree to rounding."""
    bodies = _boxes(p, 0.05, [(0.0, 0.22 * i, HALF + 0.005 + 0.004 * i) for i in range(4)])
    return simulate(p, 0.2, lambda: _places(p, bodies), stride=6)


@scenario(tolerance=1e-9)
def distant_boxes_in_batches(p: Any) -> dict[str, Any]:
    """Four boxes far apart, each solved by itself, two at a time or all at once: they agree to rounding."""
    results: dict[str, Any] = {}
    for size in (0, 1, 2, 100):
        p.resetSimulation()
        p.setPhysicsEngineParameter(minimumSolverIslandSize=size)
        bodies = _boxes(p, 0.2, [(0.0, 1.0 * i, HALF + 0.005 + 0.03 * i) for i in range(4)])
        observed = simulate(p, 0.3, lambda b=bodies: _places(p, b), stride=12)
        results |= under(f"more than {size}", observed)
    return results


def _arm(p: Any, y: float) -> int:
    """An arm of four links that turn about different axes, fixed to the world."""
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.02, 0.02, 0.09])
    axes = [[1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]]
    count = len(axes)
    return p.createMultiBody(
        baseMass=0,
        basePosition=[0, y, 0],
        linkMasses=[1.0, 0.8, 0.6, 0.4],
        linkCollisionShapeIndices=[shape] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0, 0, 0.1]] + [[0, 0, 0.2]] * (count - 1),
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[p.JOINT_REVOLUTE] * count,
        linkJointAxis=axes,
    )


@scenario(tolerance=1e-9)
def arms_side_by_side_swing(p: Any) -> dict[str, Any]:
    """Three arms beside each other and one out of reach, moved by weak motors, agree to rounding."""
    p.setGravity(0, 0, -9.81)
    arms = [_arm(p, y) for y in (0.0, 5.0, 0.07, 0.14)]
    for i, arm in enumerate(arms):
        for joint in range(4):
            p.resetJointState(arm, joint, 0.02 * (joint + 1), 0.1 * (i + 1))
            p.setJointMotorControl2(
                arm, joint, p.POSITION_CONTROL, targetPosition=0.05, force=3.0 + i + joint
            )

    def observe() -> dict[str, Any]:
        return {
            f"joints of {i}": [state[0] for state in p.getJointStates(arm, range(4))]
            for i, arm in enumerate(arms)
        }

    return simulate(p, 0.25, observe, stride=4)


def _crooked_arm(p: Any, y: float) -> int:
    """An arm like `_arm`, of links with two shapes each, centres of mass beside them and inertias turned."""
    half = [[0.02, 0.03, 0.07], [0.03, 0.01, 0.02]]
    count = 4
    shapes = [
        p.createCollisionShapeArray(
            shapeTypes=[p.GEOM_BOX, p.GEOM_SPHERE],
            halfExtents=half,
            radii=[0.0, 0.015 + 0.002 * i],
            collisionFramePositions=[[0.01, 0, 0], [0.03, 0.02 * (i - 1), 0.04]],
        )
        for i in range(count)
    ]
    return p.createMultiBody(
        baseMass=0,
        basePosition=[0, y, 0],
        linkMasses=[1.0, 0.8, 0.6, 0.4],
        linkCollisionShapeIndices=shapes,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0, 0, 0.1]] + [[0, 0, 0.2]] * (count - 1),
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0.01, 0.005, 0.02]] * count,
        linkInertialFrameOrientations=[p.getQuaternionFromEuler([0.3, 0.2, 0.5])] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[p.JOINT_REVOLUTE] * count,
        linkJointAxis=[[1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]],
    )


@scenario(tolerance=1e-9)
def arms_of_compounds_side_by_side_swing(p: Any) -> dict[str, Any]:
    """Links of several shapes: the box around a link counts, at several distances. They agree to rounding."""
    results: dict[str, Any] = {}
    for gap in (0.2, 0.22, 0.24):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        arms = [_crooked_arm(p, gap * i) for i in range(3)]
        for i, arm in enumerate(arms):
            for joint in range(4):
                p.resetJointState(arm, joint, 0.02 * (joint + 1), 0.1 * (i + 1))
                p.setJointMotorControl2(
                    arm, joint, p.POSITION_CONTROL, targetPosition=0.05, force=3.0 + i + joint
                )
        observed = simulate(
            p,
            0.25,
            lambda arms=arms: {
                f"joints of {i}": [state[0] for state in p.getJointStates(arm, range(4))]
                for i, arm in enumerate(arms)
            },
            stride=4,
        )
        results |= under(f"{gap} apart", observed)
    return results


@scenario(tolerance=1e-9)
def kukas_side_by_side_reach(p: Any) -> dict[str, Any]:
    """Three arms whose bounds meet on the way, 55 cm apart, driven to each side: they agree to rounding."""
    p.setGravity(0, 0, -9.81)
    arms = [
        load_asset(p, "kuka_iiwa/model.urdf", basePosition=[0, 0.55 * i, 0], useFixedBase=True)
        for i in range(3)
    ]

    def control(step: int) -> None:
        for i, arm in enumerate(arms):
            for joint in range(7):
                reach = 0.6 * math.sin(0.01 * step * (1 + 0.1 * joint) + i + joint)
                if joint == 1:
                    reach *= 0.8 if i % 2 else -0.8
                p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, targetPosition=reach, force=60)

    def observe() -> dict[str, Any]:
        return {
            f"joints of {i}": [state[0] for state in p.getJointStates(arm, range(7))]
            for i, arm in enumerate(arms)
        }

    return simulate(p, 1.6, observe, control, stride=24)


@scenario(tolerance=1e-9)
def what_is_tied_to_a_still_link_is_an_island_of_its_own(p: Any) -> dict[str, Any]:
    """A box hangs on the base of a cart on rails, and on its cart: only the latter makes them one island."""
    series: dict[str, Any] = {}
    for name, link in (("base", -1), ("cart", 0)):
        p.resetSimulation()
        p.setGravity(1, -2, -9.8)
        rail = load_asset(p, "cartpole.urdf")
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF, HALF, HALF])
        box = p.createMultiBody(10, shape, basePosition=[2, -2, 3], linkMasses=[5], **_hinge(p, shape))
        p.createConstraint(rail, link, box, 0, p.JOINT_FIXED, [0, 0, 1], [0.4, 0.3, 0], [0.9, 0.9, 0.4])
        observed = simulate(
            p, 1 / 240, lambda rail=rail: {"joints": [state[0] for state in p.getJointStates(rail, (0, 1))]}
        )
        series |= under(name, observed)
    return series
