"""Bodies whose bases are freed or fixed after they were loaded: their islands, and whether they sleep.

PyBullet decides when it loads a body with a fixed base which of its links are still. Freeing the base changes
this for the base alone, so a constraint of another still link has no effect even then.
"""

from __future__ import annotations

from typing import Any

from ..scenario import scenario, simulate, under

SLIDE, TURN = 1, 0
FIXED = 4


def _robot(p: Any, base_mass: float, kinds: list[int]) -> int:
    """Boxes on a chain of joints of these types."""
    count = len(kinds)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.04, 0.1])
    body = p.createMultiBody(
        base_mass,
        box,
        -1,
        [0, 0, 2],
        linkMasses=[1.0] * count,
        linkCollisionShapeIndices=[box] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.3, 0, 0.1]] * count,
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0.02, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=kinds,
        linkJointAxis=[[0, 0.6, 0.8]] * count,
    )
    for joint, kind in enumerate(kinds):
        if kind != FIXED:
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.2, force=2.0)
    return body


def _motion(p: Any, body: int) -> dict[str, Any]:
    position, orientation = p.getBasePositionAndOrientation(body)
    linear, angular = p.getBaseVelocity(body)
    joints = [p.getJointState(body, joint) for joint in range(p.getNumJoints(body))]
    return {
        "positions": [*position, *(state[0] for state in joints)],
        "orientation": orientation,
        "velocities": [*linear, *angular, *(state[1] for state in joints)],
    }


@scenario(tolerance={"positions": 1e-8, "orientation": 1e-8, "velocities": 1e-6})
def constraints_of_freed_bodies(p: Any) -> dict[str, Any]:
    """Links that were still when their body was loaded stay so for constraints; no others become so."""
    results: dict[str, Any] = {}
    chains = {"fixed first": [FIXED, TURN, FIXED], "fixed last": [TURN, FIXED, FIXED]}
    for name, kinds in chains.items():
        for loaded, *changes in (
            [0.0, 1.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0, 1.0],
            [1.0, 0.0],
            [1.0, 0.0, 1.0],
        ):
            for link in (-1, 0, 1, 2):
                p.resetSimulation()
                p.setGravity(0.5, -1.0, -9.8)
                p.setPhysicsEngineParameter(reportSolverAnalytics=1)
                body = _robot(p, loaded, kinds)
                for mass in changes:
                    p.changeDynamics(body, -1, mass=mass)
                p.createConstraint(
                    body, link, -1, -1, p.JOINT_POINT2POINT, [0, 0, 1], [0, 0.1, 0], [0.2, 0.1, 1.8]
                )
                first = p.stepSimulation()
                case = {
                    "sweeps": [island["numIterationsUsed"] for island in first],
                    "bodies": [island["numBodies"] for island in first],
                } | simulate(p, 0.03, lambda body=body: _motion(p, body))
                results |= under(f"{name}, link {link}, masses {[loaded, *changes]}", case)
    return results


@scenario(tolerance={"positions": 1e-9, "orientation": 1e-9, "velocities": 1e-9})
def fixed_bases_with_a_velocity_and_sleep(p: Any) -> dict[str, Any]:
    """The velocity of a fixed base wakes the body if it is fast, and is lost in sleep if it is slow."""
    results: dict[str, Any] = {}
    for name, speed in (("slow", 0.05), ("fast", 2.0)):
        for wakes in (p.ACTIVATION_STATE_ENABLE_WAKEUP, p.ACTIVATION_STATE_DISABLE_WAKEUP):
            p.resetSimulation()
            p.setGravity(0, 0, 0)
            body = _robot(p, 0.0, [SLIDE, TURN])
            for joint in range(2):
                p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
            p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING | wakes)
            p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_SLEEP)
            p.resetBaseVelocity(body, [0, 0, speed], [0, speed, 0])
            results |= under(f"{name}, wakes {wakes}", simulate(p, 0.05, lambda body=body: _motion(p, body)))
    for mass in (1.0, 0.0):
        p.resetSimulation()
        p.setGravity(0, 0, -9.8)
        body = _robot(p, 1.0, [SLIDE])
        p.stepSimulation()
        p.changeDynamics(body, -1, mass=mass)
        p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
        p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_SLEEP)
        results |= under(f"falls, mass {mass}", simulate(p, 0.05, lambda body=body: _motion(p, body)))
    return results
