"""Joint force-torque sensors of links that something touches or holds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..scenario import load, release_motors, scenario, simulate, under

Vector = Sequence[float]

_FRAMES = ("link frame", "world axes", "joint frame", "both")
"""What the bits of `jointFeedbackMode` mean, by their value."""


def _readings(p: Any, body: int) -> dict[str, Any]:
    states = p.getJointStatesMultiDof(body, list(range(p.getNumJoints(body))))
    return {"force": [state[2][:3] for state in states], "torque": [state[2][3:] for state in states]}


def _watch(p: Any, body: int) -> Callable[[], dict[str, Any]]:
    """Switches all sensors of a body on, and returns what reads them."""
    for joint in range(p.getNumJoints(body)):
        p.enableJointForceTorqueSensor(body, joint)
    return lambda: _readings(p, body)


def _ball(p: Any, radius: float, mass: float, position: Vector, **surface: float) -> int:
    body = p.createMultiBody(mass, p.createCollisionShape(p.GEOM_SPHERE, radius=radius), -1, position)
    p.changeDynamics(body, -1, **surface)
    return body


def _chain(
    p: Any, base: float, position: Vector, *links: tuple[int, int, Vector, Vector], flags: int = 0
) -> int:
    """A chain: of each link its joint type, collision shape, place in its parent and axis; each has 1 kg."""
    count = len(links)
    return p.createMultiBody(
        base,
        -1,
        -1,
        position,
        flags=flags,
        linkMasses=[1.0] * count,
        linkCollisionShapeIndices=[link[1] for link in links],
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[link[2] for link in links],
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0.02, 0.01, 0.0]] * count,
        linkInertialFrameOrientations=[p.getQuaternionFromEuler([0.0, 0.0, 0.3])] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[link[0] for link in links],
        linkJointAxis=[link[3] for link in links],
    )


@scenario()
def plates_carry_a_ball(p: Any) -> dict[str, Any]:
    """A plate with a ball on it, on a joint that is fixed, driven or at its limit, on a fixed base."""
    results: dict[str, Any] = {}
    for name, kind in (("fixed", p.JOINT_FIXED), ("driven", p.JOINT_PRISMATIC), ("limit", p.JOINT_PRISMATIC)):
        p.resetSimulation()
        p.setGravity(0, 0, -10)
        plate = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.3, 0.2, 0.05])
        body = _chain(p, 0, [0, 0, 0], (kind, plate, [0.1, 0, 0.5], [0, 0, 1]))
        if name == "driven":
            p.setJointMotorControl2(body, 0, p.POSITION_CONTROL, targetPosition=0.01, force=200)
        if name == "limit":
            release_motors(p, body)
            p.changeDynamics(body, 0, jointLowerLimit=0, jointUpperLimit=1)
        _ball(p, 0.1, 2.0, [0.15, 0.05, 0.66])
        results |= under(name, simulate(p, 1.0, _watch(p, body)))
    return results


@scenario(tolerance={"torque": 1e-3})
def plate_carries_a_box_that_falls_asleep(p: Any) -> dict[str, Any]:
    """A fixed plate with a box at rest on it, until the box is asleep and its weight is no longer felt.

    Its torque is known as well as the share of each corner in the weight, which PyBullet's goes on to change.
    """
    p.setGravity(0, 0, -10)
    plate = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.3, 0.2, 0.05])
    body = _chain(p, 0, [0, 0, 0], (p.JOINT_FIXED, plate, [0.1, 0, 0.5], [0, 0, 1]))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    box = p.createMultiBody(2.0, shape, -1, [0.18, 0.05, 0.65])
    p.changeDynamics(box, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
    for _ in range(360):
        p.stepSimulation()
    return simulate(p, 1.0, _watch(p, body), stride=1)


@scenario()
def fingers_of_one_hand_press(p: Any) -> dict[str, Any]:
    """Two links of one body pressed against each other, one of them slippery along an axis of its own."""
    p.setGravity(0, 0, -9.81)
    flags = p.URDF_USE_SELF_COLLISION | p.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    hand = _chain(
        p, 0, [0, 0, 1],
        (p.JOINT_PRISMATIC, ball, [0.2, 0, 0], [0, 0, 1]),
        (p.JOINT_REVOLUTE, -1, [0.3, 0, 0], [0, 1, 0]),
        (p.JOINT_PRISMATIC, ball, [-0.02, 0.05, 0], [1, 0, 0]),
        flags=flags,
    )  # fmt: skip
    p.changeDynamics(hand, 2, anisotropicFriction=[0.2, 1.0, 0.6], lateralFriction=0.8)

    def drive(step: int) -> None:
        for joint, target in ((0, 0.0), (1, 0.002 * step), (2, -0.2)):
            p.setJointMotorControl2(hand, joint, p.POSITION_CONTROL, targetPosition=target, force=40)

    return simulate(p, 0.5, _watch(p, hand), drive, stride=4)


@scenario()
def fingertip_presses_a_wall(p: Any) -> dict[str, Any]:
    """An arm whose round tip is driven against a wall, in all frames, then drawn along it."""
    results: dict[str, Any] = {}
    for mode, name in enumerate(_FRAMES):
        p.resetSimulation()
        p.setPhysicsEngineParameter(jointFeedbackMode=mode)
        p.setGravity(0, 0, -9.81)
        wall = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 2, 2])
        p.createMultiBody(0, wall, -1, [0.92, 0, 0])
        tip = p.createCollisionShape(p.GEOM_SPHERE, radius=0.05)
        arm = _chain(
            p, 0, [0, 0, 1],
            (p.JOINT_REVOLUTE, -1, [0, 0, 0], [0, 0, 1]),
            (p.JOINT_REVOLUTE, -1, [0.4, 0, 0], [0, 0, 1]),
            (p.JOINT_PRISMATIC, tip, [0.4, 0, 0], [0, 0, 1]),
        )  # fmt: skip
        p.resetJointState(arm, 0, 0.5)
        p.resetJointState(arm, 1, -0.9)

        def drive(step: int, arm: int = arm) -> None:
            for joint, target in ((0, 0.1), (1, 0.1), (2, 0.002 * step)):
                p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, targetPosition=target, force=30)

        results |= under(name, simulate(p, 1.0, _watch(p, arm), drive, stride=16))
    return results


@scenario()
def ankles_stand_and_slide(p: Any) -> dict[str, Any]:
    """A leg on a round foot that lands on a plane, under two substeps, and one that slides over it."""
    results: dict[str, Any] = {}
    for name, speed, substeps in (("stands", 0.0, 2), ("slides", 1.0, 0)):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        p.setPhysicsEngineParameter(numSubSteps=substeps)
        p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
        foot = p.createCollisionShape(p.GEOM_SPHERE, radius=0.06)
        leg = _chain(
            p, 3.0, [0, 0, 0.92],
            (p.JOINT_REVOLUTE, -1, [0, 0, -0.4], [0, 1, 0]),
            (p.JOINT_SPHERICAL, foot, [0, 0, -0.4], [1, 0, 0]),
        )  # fmt: skip
        for joint in range(2):
            p.changeDynamics(leg, joint, lateralFriction=0.4)
        p.resetBaseVelocity(leg, [speed, 0.2 * speed, 0])
        results |= under(name, simulate(p, 0.5, _watch(p, leg), stride=4))
    return results


@scenario()
def wheel_with_rolling_friction(p: Any) -> dict[str, Any]:
    """A wheel on a leg that rolling and spinning friction brake."""
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    wheel = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    cart = _chain(p, 0, [0, 0, 0.5], (p.JOINT_PRISMATIC, -1, [0, 0, 0], [0, 0, 1]),
                  (p.JOINT_SPHERICAL, wheel, [0.0, 0, -0.4], [0, 1, 0]))  # fmt: skip
    release_motors(p, cart)
    p.changeDynamics(cart, 1, rollingFriction=0.02, spinningFriction=0.05)
    p.resetJointStateMultiDof(cart, 1, [0, 0, 0, 1], [1.0, 4.0, 6.0])
    return simulate(p, 0.5, _watch(p, cart), stride=4)


@scenario()
def held_by_constraints(p: Any) -> dict[str, Any]:
    """Constraints to the world, to another body and within one, on links with sensors."""
    results: dict[str, Any] = {}
    kinds = {"point": p.JOINT_POINT2POINT, "fixed": p.JOINT_FIXED, "slide": p.JOINT_PRISMATIC}
    for name, kind in kinds.items():
        for other in ("world", "body", "parent", "child"):
            p.resetSimulation()
            p.setGravity(0, 0, -9.81)
            arm = load(p, "seven_dof.urdf", useFixedBase=True)
            release_motors(p, arm)
            axis, here, there = [0, 1, 0], [0.05, 0.02, 0.0], [0.1, 0, 0.03]
            if other == "world":
                place = p.getLinkState(arm, 5)[0]
                p.createConstraint(arm, 5, -1, -1, kind, axis, here, place)
            elif other == "parent":
                p.createConstraint(arm, 5, arm, 2, kind, axis, here, there)
            else:
                ball = _ball(p, 0.05, 0.7, p.getLinkState(arm, 5)[0])
                p.setCollisionFilterGroupMask(ball, -1, 0, 0)
                if other == "body":
                    p.createConstraint(arm, 5, ball, -1, kind, axis, here, there)
                else:
                    p.createConstraint(ball, -1, arm, 5, kind, axis, there, here)
            results |= under(f"{name}/{other}", simulate(p, 0.5, _watch(p, arm), stride=16))
    return results


@scenario()
def held_by_gears(p: Any) -> dict[str, Any]:
    """Gears between turning and between sliding joints, whose links have sensors."""
    results: dict[str, Any] = {}
    turning, sliding = p.JOINT_REVOLUTE, p.JOINT_PRISMATIC
    for name, first, second in (
        ("turning", turning, turning),
        ("sliding", sliding, sliding),
        ("rack", turning, sliding),
        ("pinion", sliding, turning),
    ):
        p.resetSimulation()
        p.setGravity(0.3, -2.0, -9.81)
        body = _chain(
            p, 0, [0, 0, 1], (first, -1, [0.2, 0, 0], [0, 1, 0]), (second, -1, [0.3, 0, 0], [0, 0, 1])
        )
        release_motors(p, body)
        gear = p.createConstraint(body, 0, body, 1, p.JOINT_GEAR, [0, 1, 0], [0, 0, 0], [0, 0, 0])
        p.changeConstraint(gear, gearRatio=-0.7, maxForce=10000)
        results |= under(name, simulate(p, 0.5, _watch(p, body), stride=16))
    return results
