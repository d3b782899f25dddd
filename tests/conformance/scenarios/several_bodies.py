"""Several robots in one world, and changes in the middle of a motion."""

from __future__ import annotations

from typing import Any

from ..scenario import (
    base_motion,
    joint_motion,
    load,
    load_asset,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)


def _three(p: Any) -> dict[str, int]:
    p.setGravity(0, 0, -9.81)
    bodies = {
        "arm": load(p, "arm_on_world.urdf", basePosition=[-3, 0, 0]),
        "seven": load(p, "seven_dof.urdf", basePosition=[0, 0, 0], useFixedBase=True),
        "limits": load(p, "limits_arm.urdf", basePosition=[3, 0, 5], useFixedBase=True),
    }
    for body in bodies.values():
        for joint in movable_joints(p, body):
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.2, force=6)
    return bodies


def _observe(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    observed: dict[str, Any] = {}
    for name, body in bodies.items():
        observed |= under(name, joint_motion(p, body, movable_joints(p, body)))
    return observed


@scenario()
def three_robots(p: Any) -> dict[str, Any]:
    """Three robots with saturated motors and limits share one solver."""
    bodies = _three(p)
    return simulate(p, 2.0, lambda: _observe(p, bodies), stride=16)


@scenario()
def robot_removed_midway(p: Any) -> dict[str, Any]:
    """The middle robot is removed while the others move; a fourth then takes its id."""
    bodies = _three(p)
    before = simulate(p, 1.0, lambda: _observe(p, bodies), stride=16)
    p.removeBody(bodies.pop("seven"))
    without = simulate(p, 1.0, lambda: _observe(p, bodies), stride=16)
    newcomer = load(p, "slider.urdf", basePosition=[0, 0, 8], useFixedBase=True)
    p.setJointMotorControl2(newcomer, 0, p.POSITION_CONTROL, targetPosition=0.5, force=20)
    bodies["newcomer"] = newcomer
    after = simulate(p, 1.0, lambda: _observe(p, bodies), stride=16)
    return (
        under("before", before)
        | under("without", without)
        | under("after", after)
        | {"ids": [newcomer, p.getNumBodies(), *(p.getBodyUniqueId(i) for i in range(p.getNumBodies()))]}
    )


@scenario()
def order_of_loading(p: Any) -> dict[str, Any]:
    """Two saturated robots, loaded in either order: the solver's row order follows."""
    results: dict[str, Any] = {}
    files = [("limits_arm.urdf", [0, 0, 5]), ("seven_dof.urdf", [4, 0, 0])]
    for name, order in (("as listed", files), ("reversed", files[::-1])):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        bodies = {file: load(p, file, basePosition=place, useFixedBase=True) for file, place in order}
        for body in bodies.values():
            for joint in movable_joints(p, body):
                p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, targetPosition=0.5, force=4)
        results |= under(name, simulate(p, 2.0, lambda b=bodies: _observe(p, b), stride=16))
    return results


@scenario()
def fixed_and_floating_together(p: Any) -> dict[str, Any]:
    """A shipped arm, a shipped cart and a floating tree in one world."""
    p.setGravity(0, 0, -9.81)
    kuka = load_asset(p, "kuka_iiwa/model.urdf", useFixedBase=True)
    cart = load_asset(p, "cartpole.urdf", basePosition=[5, 0, 0])
    tree = load(p, "tree.urdf", basePosition=[0, 10, 10])
    p.resetBaseVelocity(tree, [0, 0, 4], [1, 0.5, 0])
    for joint in range(7):
        p.setJointMotorControl2(kuka, joint, p.POSITION_CONTROL, targetPosition=0.4, force=60)
    p.setJointMotorControl2(cart, 0, p.VELOCITY_CONTROL, targetVelocity=0.5, force=15)
    p.setJointMotorControl2(cart, 1, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(cart, 1, 0.1)

    def observe() -> dict[str, Any]:
        return (
            under("kuka", joint_motion(p, kuka, list(range(7))))
            | under("cart", joint_motion(p, cart, [0, 1]))
            | under("tree", base_motion(p, tree))
        )

    return simulate(p, 2.0, observe)


@scenario()
def resets_midway(p: Any) -> dict[str, Any]:
    """Joints, base pose and base velocity are reset while the body moves."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "tree.urdf", basePosition=[0, 0, 6])
    joints = movable_joints(p, body)
    for joint in joints[:3]:
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
    p.resetBaseVelocity(body, [0.5, 0, 2], [0.4, 1.0, 0])

    def reset(step: int) -> None:
        if step == 100:
            p.resetJointState(body, joints[0], 0.7)
            p.resetJointState(body, joints[3], -0.3, 1.5)
        if step == 200:
            p.resetBasePositionAndOrientation(body, [1, 2, 7], p.getQuaternionFromEuler([0.3, 0.2, 0.1]))
        if step == 300:
            p.resetBaseVelocity(body, linearVelocity=[0, 1, 0])
        if step == 360:
            p.resetBaseVelocity(body, angularVelocity=[0, 0, 2])

    return simulate(p, 2.0, lambda: base_motion(p, body) | joint_motion(p, body, joints), reset)


@scenario()
def reset_links_are_where_they_should(p: Any) -> dict[str, Any]:
    """Link poses and velocities right after resets, before any step."""
    body = load(p, "tree.urdf")
    joints = movable_joints(p, body)
    links = list(range(p.getNumJoints(body)))
    results: dict[str, Any] = {}

    def look(name: str, forward_kinematics: int) -> None:
        states = p.getLinkStates(
            body, links, computeLinkVelocity=1, computeForwardKinematics=forward_kinematics
        )
        results.update(
            under(
                name,
                {
                    "position": [state[0] for state in states],
                    "orientation": [state[1] for state in states],
                    "velocity": [state[6] for state in states],
                    "spin": [state[7] for state in states],
                },
            )
        )

    p.resetBasePositionAndOrientation(body, [1, -2, 3], p.getQuaternionFromEuler([0.5, -0.4, 1.0]))
    look("base moved", 0)
    p.resetBaseVelocity(body, [1, 2, 3], [0.5, -0.5, 1])
    look("base thrown", 0)
    for count, joint in enumerate(joints):
        p.resetJointState(body, joint, 0.05 * count, 0.3)
    look("joints moved", 0)
    look("joints moved, kinematics asked for", 1)
    p.stepSimulation()
    look("one step on", 0)
    look("one step on, kinematics asked for", 1)
    return results


@scenario()
def dynamics_changed_midway(p: Any) -> dict[str, Any]:
    """Mass, inertia and damping of links and base change during the motion."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "tree.urdf", basePosition=[0, 0, 6])
    joints = movable_joints(p, body)
    release_motors(p, body)
    for joint in joints:
        p.changeDynamics(body, joint, jointDamping=0.1)
    p.resetBaseVelocity(body, [0.5, 0, 2], [0.4, 0.6, 0])

    def change(step: int) -> None:
        if step == 80:
            p.changeDynamics(body, 1, mass=1.5)
        if step == 160:
            p.changeDynamics(body, 3, localInertiaDiagonal=[0.01, 0.02, 0.015])
        if step == 240:
            p.changeDynamics(body, -1, mass=8.0)
        if step == 300:
            p.changeDynamics(body, -1, localInertiaDiagonal=[0.3, 0.4, 0.5])
        if step == 360:
            p.changeDynamics(body, joints[0], jointDamping=0.4)
        if step == 420:
            p.changeDynamics(body, -1, linearDamping=0.3, angularDamping=0.2)

    return simulate(p, 2.25, lambda: base_motion(p, body) | joint_motion(p, body, joints), change)


@scenario()
def two_arms_alternate_motors(p: Any) -> dict[str, Any]:
    """Motors are switched off and on again while the arms move: the rows' order is what is left."""
    p.setGravity(0, 0, -9.81)
    left = load(p, "seven_dof.urdf", basePosition=[0, 0, 0], useFixedBase=True)
    right = load(p, "seven_dof.urdf", basePosition=[3, 0, 0], useFixedBase=True)
    joints = movable_joints(p, left)

    def control(step: int) -> None:
        body = left if (step // 40) % 2 == 0 else right
        if step % 40 == 0:
            for joint in joints:
                p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
        if step % 40 == 10:
            for joint in reversed(joints):
                p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, targetPosition=0.2, force=25)

    return simulate(
        p,
        2.0,
        lambda: under("left", joint_motion(p, left, joints)) | under("right", joint_motion(p, right, joints)),
        control,
        stride=16,
    )


@scenario()
def solver_iterations(p: Any) -> dict[str, Any]:
    """Few solver iterations and other stopping thresholds leave their mark on saturated motors."""
    results: dict[str, Any] = {}
    for iterations, threshold in ((1, 1e-7), (3, 1e-7), (50, 0.0), (50, 1e-2), (400, 1e-12)):
        p.resetSimulation()
        p.setPhysicsEngineParameter(numSolverIterations=iterations, solverResidualThreshold=threshold)
        bodies = _three(p)
        results |= under(
            f"{iterations} iterations, {threshold}",
            simulate(p, 2.0, lambda b=bodies: _observe(p, b), stride=32),
        )
    return results


@scenario()
def solver_parameters(p: Any) -> dict[str, Any]:
    """Each parameter of the solver that joint motors and limits might feel, away from its default."""
    results: dict[str, Any] = {}
    variants: dict[str, dict[str, Any]] = {
        "inner iterations": {"numNonContactInnerIterations": 4, "numSolverIterations": 5},
        "islands": {"minimumSolverIslandSize": 128},
        "erp": {"erp": 0.6},
        "cfm": {"globalCFM": 0.02},
        "no split impulse": {"useSplitImpulse": 0},
        "split threshold": {"splitImpulsePenetrationThreshold": 0.3},
        "warm starting": {"warmStartingFactor": 0.8},
        "pyramid": {"enableConeFriction": 0},
    }
    for name, parameters in variants.items():
        p.resetSimulation()
        p.setPhysicsEngineParameter(**parameters)
        bodies = _three(p)
        p.resetJointState(bodies["limits"], 0, 0.7)
        p.resetJointState(bodies["limits"], 1, -0.33)
        results |= under(name, simulate(p, 2.0, lambda b=bodies: _observe(p, b), stride=32))
    return results
