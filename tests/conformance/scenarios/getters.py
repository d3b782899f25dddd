"""Everything the information and state getters say about a robot."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

from ..scenario import Kind, base_motion, load, load_asset, movable_joints, scenario, under

# PyBullet computes the link frame (fields 4 and 5 of a link state) in single precision.
SINGLE_PRECISION = ("frame_position", "frame_orientation")


def body_info(p: Any, body: int) -> dict[str, Any]:
    """Names and counts of a body."""
    base_name, body_name = p.getBodyInfo(body)
    return {
        "body_names": [base_name.decode(), body_name.decode()],
        "counts": [p.getNumJoints(body), p.computeDofCount(body)],
    }


def joint_info(p: Any, body: int) -> dict[str, Any]:
    """All fields of getJointInfo, one row per joint."""
    infos = [p.getJointInfo(body, joint) for joint in range(p.getNumJoints(body))]
    return {
        "joint_numbers": [(*info[0:1], *info[2:6], info[16]) for info in infos],
        "joint_names": [(info[1].decode(), info[12].decode()) for info in infos],
        "joint_damping": [info[6] for info in infos],
        "joint_friction": [info[7] for info in infos],
        "joint_lower": [info[8] for info in infos],
        "joint_upper": [info[9] for info in infos],
        "joint_force": [info[10] for info in infos],
        "joint_speed": [info[11] for info in infos],
        "joint_axis": [info[13] for info in infos],
        "joint_parent_position": [info[14] for info in infos],
        "joint_parent_orientation": [info[15] for info in infos],
    }


def dynamics_info(p: Any, body: int) -> dict[str, Any]:
    """All fields of getDynamicsInfo, one row per link, the base first."""
    infos = [p.getDynamicsInfo(body, link) for link in range(-1, p.getNumJoints(body))]
    return {
        "mass": [info[0] for info in infos],
        "lateral_friction": [info[1] for info in infos],
        "inertia": [info[2] for info in infos],
        "inertial_position": [info[3] for info in infos],
        "inertial_orientation": [info[4] for info in infos],
        "restitution": [info[5] for info in infos],
        "rolling_friction": [info[6] for info in infos],
        "spinning_friction": [info[7] for info in infos],
        "contact_damping": [info[8] for info in infos],
        "contact_stiffness": [info[9] for info in infos],
        "body_type": [info[10] for info in infos],
        "collision_margin": [info[11] for info in infos],
    }


def link_states(p: Any, body: int) -> dict[str, Any]:
    """All fields of getLinkStates with velocities, and that getLinkState says the same."""
    links = list(range(p.getNumJoints(body)))
    states = p.getLinkStates(body, links, computeLinkVelocity=1, computeForwardKinematics=1)
    single = [p.getLinkState(body, link, computeLinkVelocity=1, computeForwardKinematics=1) for link in links]
    return {
        "com_position": [state[0] for state in states],
        "com_orientation": [state[1] for state in states],
        "local_inertial_position": [state[2] for state in states],
        "local_inertial_orientation": [state[3] for state in states],
        "frame_position": [state[4] for state in states],
        "frame_orientation": [state[5] for state in states],
        "com_velocity": [state[6] for state in states],
        "com_spin": [state[7] for state in states],
        "one_by_one_is_equal": [int(tuple(states) == tuple(single))],
        "fields": [len(state) for state in states] + [len(p.getLinkState(body, 0))],
    }


def joint_states(p: Any, body: int) -> dict[str, Any]:
    """getJointState(s) and their multi-dof forms."""
    joints = list(range(p.getNumJoints(body)))
    states = p.getJointStates(body, joints)
    multi = p.getJointStatesMultiDof(body, joints)
    return {
        "position": [state[0] for state in states],
        "velocity": [state[1] for state in states],
        "reaction": [state[2] for state in states],
        "motor_torque": [state[3] for state in states],
        "multi_sizes": [[len(part) for part in state] for state in multi],
        "multi_position": [number for state in multi for number in state[0]],
        "multi_velocity": [number for state in multi for number in state[1]],
        "multi_torque": [number for state in multi for number in state[3]],
        "one_by_one_is_equal": [
            int(list(states) == [p.getJointState(body, joint) for joint in joints]),
            int(list(multi) == [p.getJointStateMultiDof(body, joint) for joint in joints]),
        ],
    }


def randomise(p: Any, body: int, seed: int) -> None:
    """Put base and joints into a reproducible random state, within the joints' limits."""
    generator = random.Random(seed)

    def numbers(count: int, size: float) -> list[float]:
        return [generator.uniform(-size, size) for _ in range(count)]

    p.resetBasePositionAndOrientation(body, numbers(3, 3.0), p.getQuaternionFromEuler(numbers(3, 1.4)))
    p.resetBaseVelocity(body, numbers(3, 2.0), numbers(3, 2.0))
    for joint in movable_joints(p, body):
        info = p.getJointInfo(body, joint)
        if info[2] == p.JOINT_SPHERICAL:
            orientation = p.getQuaternionFromEuler(numbers(3, 1.2))
            p.resetJointStateMultiDof(body, joint, orientation, numbers(3, 2.0))
        elif info[2] in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC):
            lower, upper = (info[8], info[9]) if info[8] <= info[9] else (-3.0, 3.0)
            position = lower + (upper - lower) * generator.random()
            p.resetJointState(body, joint, position, generator.uniform(-2.0, 2.0))


def everything(p: Any, load_robot: Callable[..., int], seed: int) -> dict[str, Any]:
    """All getters for a robot at zero and at a random state, loaded in the ways scripts load it."""
    results: dict[str, Any] = {}
    loadings = {
        "default": {},
        "fixed": {"useFixedBase": True, "basePosition": [1, 2, 3], "baseOrientation": [0.1, 0.2, 0.3, 0.9]},
        "inertia from file": {"flags": p.URDF_USE_INERTIA_FROM_FILE, "basePosition": [-1, 0.5, 2]},
        "scaled": {"globalScaling": 1.7},
    }
    for name, options in loadings.items():
        p.resetSimulation()
        body = load_robot(**options)
        facts = body_info(p, body) | joint_info(p, body) | dynamics_info(p, body)
        results |= under(name, facts)
        for state in ("zero", "random"):
            if state == "random":
                randomise(p, body, seed)
            seen = base_motion(p, body) | link_states(p, body) | joint_states(p, body)
            results |= under(f"{name}/{state}", seen)
    return results


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_seven_dof(p: Any) -> dict[str, Any]:
    """All getters on the arm with rotated frames."""
    return everything(p, lambda **options: load(p, "seven_dof.urdf", **options), 1)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_tree(p: Any) -> dict[str, Any]:
    """All getters on the floating tree."""
    return everything(p, lambda **options: load(p, "tree.urdf", **options), 2)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_random_tree(p: Any) -> dict[str, Any]:
    """All getters on twenty links with joints of every kind."""
    return everything(p, lambda **options: load(p, "random_tree.urdf", **options), 3)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_hand(p: Any) -> dict[str, Any]:
    """All getters on a branching hand with capsules and tiny masses."""
    return everything(p, lambda **options: load(p, "hand.urdf", **options), 4)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_spherical_chain(p: Any) -> dict[str, Any]:
    """All getters on balls and sockets."""
    return everything(p, lambda **options: load(p, "spherical_chain.urdf", **options), 5)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_planar_body(p: Any) -> dict[str, Any]:
    """All getters on a planar joint."""
    return everything(p, lambda **options: load(p, "planar_body.urdf", **options), 6)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_shapes(p: Any) -> dict[str, Any]:
    """All getters on links of every shape: primitives, compounds, meshes, and none."""
    return everything(p, lambda **options: load(p, "shapes.urdf", **options), 12)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_panda(p: Any) -> dict[str, Any]:
    """All getters on the shipped Panda."""
    return everything(p, lambda **options: load_asset(p, "franka_panda/panda.urdf", **options), 7)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_kuka(p: Any) -> dict[str, Any]:
    """All getters on the shipped KUKA."""
    return everything(p, lambda **options: load_asset(p, "kuka_iiwa/model.urdf", **options), 8)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_r2d2(p: Any) -> dict[str, Any]:
    """All getters on the shipped R2D2."""
    return everything(p, lambda **options: load_asset(p, "r2d2.urdf", **options), 9)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_of_cartpole(p: Any) -> dict[str, Any]:
    """All getters on the shipped cart and pole."""
    return everything(p, lambda **options: load_asset(p, "cartpole.urdf", **options), 10)


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_after_change_dynamics(p: Any) -> dict[str, Any]:
    """What getDynamicsInfo and getJointInfo say after every kind of change."""
    body = load(p, "tree.urdf")
    changes: dict[str, tuple[int, dict[str, Any]]] = {
        "mass of base": (-1, {"mass": 9.0}),
        "mass of link": (3, {"mass": 2.0}),
        "inertia": (0, {"localInertiaDiagonal": [0.1, 0.2, 0.25]}),
        "frictions": (
            1,
            {"lateralFriction": 0.9, "spinningFriction": 0.02, "rollingFriction": 0.03, "restitution": 0.4},
        ),
        "contact spring": (2, {"contactStiffness": 1e4, "contactDamping": 50.0}),
        "margin": (4, {"collisionMargin": 0.01}),
        "limits": (0, {"jointLowerLimit": -0.5, "jointUpperLimit": 0.75}),
        "joint damping": (1, {"jointDamping": 0.33}),
        "massless": (5, {"mass": 0.0}),
    }
    results: dict[str, Any] = {}
    for name, (link, values) in changes.items():
        p.changeDynamics(body, link, **values)
        results |= under(name, dynamics_info(p, body) | joint_info(p, body))
    return results


@scenario(Kind.INFO, SINGLE_PRECISION)
def getters_with_loading_flags(p: Any) -> dict[str, Any]:
    """Link order, merged links and ignored shapes as the loading flags ask for them."""
    results: dict[str, Any] = {}
    flags = {
        "link order kept": p.URDF_MAINTAIN_LINK_ORDER,
        "fixed links merged": p.URDF_MERGE_FIXED_LINKS,
        "no collision shapes": p.URDF_IGNORE_COLLISION_SHAPES,
        "implicit cylinder": p.URDF_USE_IMPLICIT_CYLINDER,
        "merged, inertia from file": p.URDF_MERGE_FIXED_LINKS | p.URDF_USE_INERTIA_FROM_FILE,
    }
    for file in ("seven_dof.urdf", "tree.urdf", "hand.urdf", "random_tree.urdf"):
        for name, value in flags.items():
            p.resetSimulation()
            body = load(p, file, flags=value)
            randomise(p, body, 11)
            seen = body_info(p, body) | joint_info(p, body) | dynamics_info(p, body)
            results |= under(f"{file}/{name}", seen | link_states(p, body) | base_motion(p, body))
    return results


@scenario(Kind.INFO)
def engine_parameters(p: Any) -> dict[str, Any]:
    """What getPhysicsEngineParameters says at first and after changes."""

    def numbers() -> list[float]:
        parameters = p.getPhysicsEngineParameters()
        return [float(parameters[key]) for key in sorted(parameters)]

    results: dict[str, Any] = {"names": sorted(p.getPhysicsEngineParameters()), "first": numbers()}
    p.setGravity(1, -2, 3.5)
    p.setPhysicsEngineParameter(
        fixedTimeStep=0.01, numSolverIterations=77, numSubSteps=3, numNonContactInnerIterations=2
    )
    results["changed"] = numbers()
    p.setPhysicsEngineParameter(fixedTimeStep=-1, numSolverIterations=-5)
    results["negative values change nothing"] = numbers()
    p.resetSimulation()
    results["after reset"] = numbers()
    return results
