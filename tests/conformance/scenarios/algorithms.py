"""Inverse dynamics, Jacobians and mass matrices on fixed and floating bases at random states."""

from __future__ import annotations

import random
from typing import Any

from ..scenario import Kind, load, load_asset, movable_joints, scenario, under
from .getters import randomise

STATES = 3


def _arm(p: Any, fixed: bool) -> tuple[int, list[int]]:
    p.resetSimulation()
    p.setGravity(1.0, -2.0, -9.81)
    body = load(
        p,
        "seven_dof.urdf",
        basePosition=[0.3, -0.2, 1.0],
        baseOrientation=p.getQuaternionFromEuler([0.2, 0.5, -0.4]),
        useFixedBase=fixed,
        flags=p.URDF_USE_INERTIA_FROM_FILE,
    )
    return body, movable_joints(p, body)


def _tree(p: Any, fixed: bool) -> tuple[int, list[int]]:
    p.resetSimulation()
    p.setGravity(0.5, 0.0, -9.81)
    body = load(p, "tree.urdf", basePosition=[0.1, 0.2, 0.3], useFixedBase=fixed)
    return body, movable_joints(p, body)


def _numbers(generator: random.Random, count: int, size: float) -> list[float]:
    return [generator.uniform(-size, size) for _ in range(count)]


def _both_robots(p: Any) -> Any:
    for name, make in (("arm", _arm), ("tree", _tree)):
        for base, fixed in (("fixed", True), ("floating", False)):
            body, joints = make(p, fixed)
            yield f"{name}, {base}", body, joints, fixed


@scenario()
def inverse_dynamics(p: Any) -> dict[str, Any]:
    """calculateInverseDynamics at random positions, velocities and accelerations."""
    results: dict[str, Any] = {}
    generator = random.Random(31)
    for name, body, joints, fixed in _both_robots(p):
        if not fixed:
            continue
        count = len(joints)
        for state in range(STATES):
            results[f"{name}/{state}"] = p.calculateInverseDynamics(
                body,
                _numbers(generator, count, 1.0),
                _numbers(generator, count, 2.0),
                _numbers(generator, count, 5.0),
            )
    return results


@scenario()
def inverse_dynamics_floating(p: Any) -> dict[str, Any]:
    """calculateInverseDynamics with a floating base: six base coordinates before the joints."""
    results: dict[str, Any] = {}
    generator = random.Random(32)
    for name, body, joints, fixed in _both_robots(p):
        if fixed:
            continue
        for state in range(STATES):
            randomise(p, body, 40 + state)
            base_position, base_orientation = p.getBasePositionAndOrientation(body)
            positions = [*base_position, *base_orientation, *_numbers(generator, len(joints), 1.0)]
            results[f"{name}/{state}"] = p.calculateInverseDynamics(
                body,
                positions,
                _numbers(generator, 6 + len(joints), 1.0),
                _numbers(generator, 6 + len(joints), 3.0),
            )
    return results


@scenario()
def jacobians(p: Any) -> dict[str, Any]:
    """calculateJacobian of inner and outer links at random points and states."""
    results: dict[str, Any] = {}
    generator = random.Random(33)
    for name, body, joints, _fixed in _both_robots(p):
        count = len(joints)
        for state in range(STATES):
            randomise(p, body, 50 + state)
            positions = _numbers(generator, count, 1.0)
            for link in (0, joints[-2], p.getNumJoints(body) - 1):
                linear, angular = p.calculateJacobian(
                    body, link, _numbers(generator, 3, 0.2), positions, [0.0] * count, [0.0] * count
                )
                results |= under(f"{name}/{state}/link {link}", {"linear": linear, "angular": angular})
    return results


@scenario()
def mass_matrices(p: Any) -> dict[str, Any]:
    """calculateMassMatrix at random positions."""
    results: dict[str, Any] = {}
    generator = random.Random(34)
    for name, body, joints, _fixed in _both_robots(p):
        for state in range(STATES):
            randomise(p, body, 60 + state)
            results[f"{name}/{state}"] = p.calculateMassMatrix(body, _numbers(generator, len(joints), 1.0))
    return results


@scenario()
def extended_coordinates(p: Any) -> dict[str, Any]:
    """Mass matrix and inverse dynamics in the coordinates of flag 1: base and quaternions included."""
    results: dict[str, Any] = {}
    generator = random.Random(36)
    for robot in ("limits_arm.urdf", "tree.urdf", "random_tree.urdf"):
        for base, fixed in (("fixed", True), ("floating", False)):
            p.resetSimulation()
            p.setGravity(0.5, -1.0, -9.81)
            body = load(p, robot, useFixedBase=fixed)
            randomise(p, body, 80)
            states = p.getJointStatesMultiDof(body, movable_joints(p, body))
            positions = [number for state in states for number in state[0]]
            if not fixed:
                place, turn = p.getBasePositionAndOrientation(body)
                positions = [*place, *turn, *positions]
            count = len(positions)
            results |= under(
                f"{robot}/{base}",
                {
                    "mass_matrix": p.calculateMassMatrix(body, positions, flags=1),
                    "forces": p.calculateInverseDynamics(
                        body,
                        positions,
                        _numbers(generator, count, 1.0),
                        _numbers(generator, count, 2.0),
                        flags=1,
                    ),
                },
            )
    return results


@scenario()
def algorithms_on_panda(p: Any) -> dict[str, Any]:
    """Inverse dynamics, Jacobian and mass matrix of the shipped Panda."""
    p.setGravity(0, 0, -9.81)
    panda = load_asset(p, "franka_panda/panda.urdf", useFixedBase=True)
    generator = random.Random(35)
    results: dict[str, Any] = {}
    for state in range(STATES):
        positions = _numbers(generator, 9, 1.2)
        velocities = _numbers(generator, 9, 1.0)
        linear, angular = p.calculateJacobian(panda, 11, [0.0, 0.0, 0.1], positions, velocities, [0.0] * 9)
        results |= under(
            f"{state}",
            {
                "torques": p.calculateInverseDynamics(
                    panda, positions, velocities, _numbers(generator, 9, 4.0)
                ),
                "linear": linear,
                "angular": angular,
                "mass_matrix": p.calculateMassMatrix(panda, positions),
            },
        )
    return results


@scenario(Kind.INFO)
def algorithms_leave_state_alone(p: Any) -> dict[str, Any]:
    """Asking for dynamics at other positions does not move the body."""
    body, joints = _arm(p, True)
    randomise(p, body, 70)
    before = [state[:2] for state in p.getJointStates(body, joints)]
    count = len(joints)
    p.calculateInverseDynamics(body, [0.1] * count, [0.2] * count, [0.3] * count)
    p.calculateJacobian(body, 3, [0.0, 0.0, 0.0], [0.1] * count, [0.0] * count, [0.0] * count)
    p.calculateMassMatrix(body, [0.4] * count)
    after = [state[:2] for state in p.getJointStates(body, joints)]
    return {"before": before, "after": after, "equal": [int(before == after)]}
