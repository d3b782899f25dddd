"""Chains and trees in free motion, with and without a fixed base."""

from __future__ import annotations

from typing import Any

from ..scenario import (
    base_motion,
    joint_motion,
    load,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)


@scenario()
def double_pendulum_swings(p: Any) -> dict[str, Any]:
    """A double pendulum about two skew axes, with inertia from shapes and from the file."""
    results: dict[str, Any] = {}
    for name, flags in (("shapes", 0), ("file", p.URDF_USE_INERTIA_FROM_FILE)):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        body = load(p, "double_pendulum.urdf", basePosition=[0, 0, 2], useFixedBase=True, flags=flags)
        release_motors(p, body)
        p.resetJointState(body, 0, 1.1, 0.3)
        p.resetJointState(body, 1, -0.6, 0.5)

        def observe(body: int = body) -> dict[str, Any]:
            tip = p.getLinkState(body, 1, computeLinkVelocity=1)
            return joint_motion(p, body, [0, 1]) | {"tip": tip[0], "tip_spin": tip[7]}

        results |= under(name, simulate(p, 2.0, observe))
    return results


def spherical_motion(p: Any, body: int, joints: list[int]) -> dict[str, Any]:
    """Quaternions and angular velocities of spherical joints."""
    states = p.getJointStatesMultiDof(body, joints)
    return {
        "orientation": [state[0] for state in states],
        "spin": [state[1] for state in states],
    }


@scenario()
def spherical_chain_swings(p: Any) -> dict[str, Any]:
    """Three balls and sockets in free motion from a bent, spinning start."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "spherical_chain.urdf", useFixedBase=True)
    release_motors(p, body)
    start = [[0.3, 0.2, 0.1], [-0.2, 0.4, 0.0], [0.1, 0.1, -0.3]]
    for joint, euler in enumerate(start):
        p.resetJointStateMultiDof(body, joint, p.getQuaternionFromEuler(euler), [0.4, -0.5 * joint, 0.3])
    return simulate(p, 2.0, lambda: spherical_motion(p, body, [0, 1, 2]))


@scenario()
def spherical_default_motor(p: Any) -> dict[str, Any]:
    """Balls and sockets braked by the motor they have by default."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "spherical_chain.urdf", useFixedBase=True)
    for joint in range(3):
        p.resetJointStateMultiDof(body, joint, p.getQuaternionFromEuler([0.2, 0.3, joint]), [2.0, 1.0, -1.0])
    return simulate(p, 2.0, lambda: spherical_motion(p, body, [0, 1, 2]))


@scenario()
def planar_body_glides(p: Any) -> dict[str, Any]:
    """A plate in a tilted plane with a pendulum on it: two translations, one rotation."""
    p.setGravity(0.5, 0.2, -9.81)
    body = load(p, "planar_body.urdf", useFixedBase=True)
    p.setJointMotorControl2(body, 1, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(body, 1, 0.7, -1.0)

    def observe() -> dict[str, Any]:
        plate = p.getLinkState(body, 0, computeLinkVelocity=1)
        return joint_motion(p, body, [1]) | {
            "plate": plate[0],
            "plate_orientation": plate[1],
            "plate_velocity": plate[6],
            "plate_spin": plate[7],
        }

    return simulate(p, 2.0, observe)


@scenario()
def seven_joints_fall(p: Any) -> dict[str, Any]:
    """An arm of seven joints with rotated frames collapses, its motors off."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "seven_dof.urdf", useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE)
    release_motors(p, body)
    joints = movable_joints(p, body)
    for joint in joints:
        p.resetJointState(body, joint, 0.3 - 0.1 * joint, 0.05 * joint)
    return simulate(p, 2.0, lambda: joint_motion(p, body, joints))


def _tree(p: Any, flags: int = 0) -> tuple[int, list[int]]:
    body = load(
        p,
        "tree.urdf",
        basePosition=[0.1, 0.2, 3.0],
        baseOrientation=p.getQuaternionFromEuler([0.2, -0.3, 0.5]),
        flags=flags,
    )
    release_motors(p, body)
    joints = movable_joints(p, body)
    for count, joint in enumerate(joints):
        if p.getJointInfo(body, joint)[2] == p.JOINT_REVOLUTE:
            p.resetJointState(body, joint, 0.2 - 0.1 * count, 0.3 * (-1) ** count)
    return body, joints


@scenario()
def floating_tree_tumbles(p: Any) -> dict[str, Any]:
    """A floating tree thrown with spin, under gravity and under none."""
    results: dict[str, Any] = {}
    for gravity in (0.0, -9.81):
        p.resetSimulation()
        p.setGravity(0, 0, gravity)
        body, joints = _tree(p, p.URDF_USE_INERTIA_FROM_FILE)
        p.resetBaseVelocity(body, [0.5, -0.2, 1.0], [0.8, 1.1, -0.6])

        def observe(body: int = body, joints: list[int] = joints) -> dict[str, Any]:
            return base_motion(p, body) | joint_motion(p, body, joints)

        results |= under(f"gravity {gravity}", simulate(p, 2.0, observe))
    return results


@scenario()
def floating_tree_damped(p: Any) -> dict[str, Any]:
    """The tree under strong link and joint damping."""
    p.setGravity(0, 0, -3.0)
    body, joints = _tree(p)
    p.changeDynamics(body, -1, linearDamping=0.5, angularDamping=0.8)
    for joint in joints:
        p.changeDynamics(body, joint, jointDamping=0.15)
    p.resetBaseVelocity(body, [1.0, 2.0, 0.0], [3.0, -2.0, 1.0])
    return simulate(p, 2.0, lambda: base_motion(p, body) | joint_motion(p, body, joints))


@scenario()
def floating_tree_default_motors(p: Any) -> dict[str, Any]:
    """The tree thrown with all its joints held by their default motors."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "tree.urdf", basePosition=[0, 0, 5])
    joints = movable_joints(p, body)
    p.resetBaseVelocity(body, [1.0, 0.0, 3.0], [2.0, -3.0, 1.0])
    return simulate(p, 2.0, lambda: base_motion(p, body) | joint_motion(p, body, joints))


@scenario()
def random_tree_moves(p: Any) -> dict[str, Any]:
    """Twenty links with joints of every kind, fixed and floating, damped in their joints."""
    results: dict[str, Any] = {}
    for name, fixed in (("fixed", True), ("floating", False)):
        p.resetSimulation()
        p.setGravity(0, 0, -2.0)
        body = load(p, "random_tree.urdf", useFixedBase=fixed)
        release_motors(p, body)
        links = list(range(p.getNumJoints(body)))

        def observe(body: int = body, links: list[int] = links) -> dict[str, Any]:
            states = p.getLinkStates(body, links, computeLinkVelocity=1)
            return base_motion(p, body) | {
                "com_position": [state[0] for state in states],
                "com_velocity": [state[6] for state in states],
                "com_spin": [state[7] for state in states],
            }

        results |= under(name, simulate(p, 2.0, observe, stride=32))
    return results


@scenario()
def loading_flags_move(p: Any) -> dict[str, Any]:
    """The floating tree scaled, with merged links, and in the file's link order, thrown."""
    results: dict[str, Any] = {}
    loadings = {
        "scaled": {"globalScaling": 0.6},
        "merged": {"flags": p.URDF_MERGE_FIXED_LINKS | p.URDF_USE_INERTIA_FROM_FILE},
        "file order": {"flags": p.URDF_MAINTAIN_LINK_ORDER},
    }
    for name, options in loadings.items():
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        body = load(p, "tree.urdf", basePosition=[0, 0, 4], **options)
        release_motors(p, body)
        joints = movable_joints(p, body)
        for joint in joints:
            p.changeDynamics(body, joint, jointDamping=0.05)
        p.resetBaseVelocity(body, [0.2, 0.0, 2.0], [0.5, -0.4, 0.3])

        def observe(body: int = body, joints: list[int] = joints) -> dict[str, Any]:
            return base_motion(p, body) | joint_motion(p, body, joints)

        results |= under(name, simulate(p, 2.0, observe, stride=16))
    return results


@scenario()
def odd_shapes_swing(p: Any) -> dict[str, Any]:
    """Links of every shape swing about their own axes: inertias from shapes, in motion."""
    p.setGravity(3.0, 2.0, -9.81)
    body = load(p, "shapes.urdf", useFixedBase=True)
    release_motors(p, body)
    joints = movable_joints(p, body)
    for joint in joints:
        p.resetJointState(body, joint, 0.3, 1.0)
    return simulate(p, 2.0, lambda: joint_motion(p, body, joints), stride=16)


@scenario()
def fast_spin(p: Any) -> dict[str, Any]:
    """A free body spins fast about its middle axis: gyroscopic terms and large rotations per step."""
    body = load(p, "slider.urdf", basePosition=[0, 0, 1])
    p.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0, localInertiaDiagonal=[0.1, 0.2, 0.35])
    p.changeDynamics(body, 0, localInertiaDiagonal=[0.01, 0.02, 0.03])
    p.resetBaseVelocity(body, [0.0, 0.3, 0.0], [0.1, 14.0, 0.05])
    return simulate(p, 2.0, lambda: base_motion(p, body) | joint_motion(p, body, [0]))


@scenario()
def velocity_is_bounded(p: Any) -> dict[str, Any]:
    """Speeds beyond the engine's bound on joint and base velocities are cut, also by maxJointVelocity."""
    results: dict[str, Any] = {}
    for name, bound in (("default", None), ("lowered", 8.0)):
        p.resetSimulation()
        p.setGravity(0, 0, -90.0)
        arm = load(p, "arm_on_world.urdf")
        faller = load(p, "slider.urdf", basePosition=[5, 0, 300])
        if bound is not None:
            p.changeDynamics(arm, -1, maxJointVelocity=bound)
            p.changeDynamics(faller, -1, maxJointVelocity=bound)
        p.changeDynamics(faller, -1, linearDamping=0.0)
        release_motors(p, arm)
        p.resetBaseVelocity(faller, [130.0, 0.0, 0.0], [0.0, 0.0, 2.0])

        def twist(step: int, arm: int = arm) -> None:
            if step < 240:
                p.setJointMotorControl2(arm, 1, p.TORQUE_CONTROL, force=200.0)

        def observe(arm: int = arm, faller: int = faller) -> dict[str, Any]:
            return joint_motion(p, arm, [1]) | base_motion(p, faller)

        results |= under(name, simulate(p, 2.0, observe, twist))
    return results
