"""Contacts with rows along which nothing can move: robots in a plane, and on rails.

PyBullet computes 0/0 for the change of such a row, and forgets what the rows before it have changed. So it
stops sweeping early where the last rows are at rest, and never where such a row is the last.
"""

from __future__ import annotations

from typing import Any

from ..scenario import scenario, simulate, under

SLIDE, TURN = 1, 0


def _arm(p: Any, joints: list[tuple[int, list[float]]], step: float) -> int:
    """Capsules that lie along x, one after the other, on joints of these types and axes, 0.05 m high."""
    count = len(joints)
    hub = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.02, 0.02, 0.02])
    capsule = p.createCollisionShape(p.GEOM_CAPSULE, radius=0.05, height=0.3)
    lying = p.getQuaternionFromEuler([0, 1.5707963267948966, 0])
    shapes = [capsule if place == count - 1 or step > 0 else -1 for place in range(count)]
    body = p.createMultiBody(
        0,
        hub,
        -1,
        [0, 0, 0.05],
        linkMasses=[1.0 if shape >= 0 else 0.1 for shape in shapes],
        linkCollisionShapeIndices=shapes,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.3, 0, 0] if place == 0 else [0, 0, step] for place in range(count)],
        linkOrientations=[lying, *[[0, 0, 0, 1]] * (count - 1)],
        linkInertialFramePositions=[[0, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[kind for kind, _ in joints],
        linkJointAxis=[axis for _, axis in joints],
    )
    for joint in range(count):
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.1, force=1.5)
    return body


@scenario(tolerance={"positions": 1e-6, "velocities": 1e-6})
def rows_along_which_nothing_can_move(p: Any) -> dict[str, Any]:
    """Capsules on sliders and hinges touch the floor; how they move, and how many sweeps that takes."""
    arms = {
        "slides over the floor": ([(SLIDE, [0, 0, 1]), (SLIDE, [0, 1, 0])], 0.0),
        "slides and turns over the floor": ([(SLIDE, [0, 0, 1]), (SLIDE, [0, 1, 0]), (TURN, [1, 0, 0])], 0.0),
        "falls in a plane": ([(SLIDE, [1, 0, 0]), (SLIDE, [0, 0, 1]), (TURN, [0, 1, 0])], 0.0),
        "turns into the floor": ([(TURN, [0, 1, 0]), (TURN, [0, 1, 0])], 0.45),
    }
    results: dict[str, Any] = {}
    for name, (joints, step) in arms.items():
        p.resetSimulation()
        p.setGravity(0.3, -2.0, -9.8)
        p.setPhysicsEngineParameter(reportSolverAnalytics=1)
        floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1])
        p.createMultiBody(0, floor, -1, [0, 0, -1])
        body = _arm(p, joints, step)

        def joints_of(body: int = body) -> dict[str, Any]:
            states = p.getJointStates(body, range(p.getNumJoints(body)))
            return {
                "positions": [state[0] for state in states],
                "velocities": [state[1] for state in states],
            }

        first = p.stepSimulation()
        results |= under(name, {"sweeps": [island["numIterationsUsed"] for island in first]})
        results |= under(name, simulate(p, 0.2, joints_of, stride=4))
    return results
