"""Native calls of algorithms: the numbers, errors and changes of the body are those of the checked way."""

from __future__ import annotations

import threading
from array import array
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from tests.algorithms.record_pinocchio import CASES

from carom import Body, World, algorithms
from carom.native.host import host

GRAVITY = (0.4, -0.2, -9.81)
Call = Callable[..., Any]


def robot(name: str, world: World | None = None) -> Body:
    path, is_fixed, _ = CASES[name]
    world = world or World()
    world.gravity = GRAVITY
    # Other files than URDF say themselves whether a base is fixed.
    chosen = is_fixed and path.suffix == ".urdf"
    return world.load(path, (1.0, 2.0, 3.0), fixed_base=chosen).bodies[0]


def calls(body: Body, kind: Callable[[np.ndarray], Any]) -> dict[str, Call]:
    """Functions of the package, for numbers as a kind of sequence."""
    rng = np.random.default_rng(4)
    joints = rng.uniform(-0.5, 0.5, sum(body.position_count))
    dofs = sum(body.velocity_count) + (0 if body.fixed_base else 6)
    base = [] if body.fixed_base else [0.1, 0.2, 0.3, 0.5, 0.5, -0.5, 0.5]
    own, placed = kind(joints), kind(np.array([*base, *joints]))
    v, a, tau = (kind(rng.normal(size=dofs)) for _ in range(3))
    point, last = kind(np.array([0.1, 0.2, 0.3])), body.joint_count - 1
    return {
        "mass_matrix": lambda: algorithms.mass_matrix(body, own),
        "jacobian": lambda: algorithms.jacobian(body, last, point, own),
        "jacobian of the base": lambda: algorithms.jacobian(body, -1, point, own),
        "forward_kinematics": lambda: body.forward_kinematics(own),
        "inverse_dynamics": lambda: algorithms.inverse_dynamics(body, placed, v, a),
        "forward_dynamics": lambda: algorithms.forward_dynamics(body, placed, v, tau),
        "inverse derivatives": lambda: algorithms.inverse_dynamics_derivatives(body, placed, v, a),
        "forward derivatives": lambda: algorithms.forward_dynamics_derivatives(body, placed, v, tau),
        "coriolis": lambda: algorithms.compute_coriolis_matrix(body, placed, v),
        "gravity": lambda: algorithms.gravity_forces(body, placed),
        "bias": lambda: algorithms.bias_forces(body, placed, v),
        "center_of_mass": lambda: algorithms.center_of_mass(body, placed),
        "its jacobian": lambda: algorithms.jacobian_center_of_mass(body, placed),
        "momentum": lambda: algorithms.centroidal_momentum(body, placed, v),
        "its map": lambda: algorithms.compute_centroidal_map(body, placed),
        "centroidal_dynamics": lambda: algorithms.centroidal_dynamics(body, placed, v, a),
        "kinetic_energy": lambda: algorithms.kinetic_energy(body, placed, v),
        "potential_energy": lambda: algorithms.potential_energy(body, placed),
        "regressor": lambda: algorithms.joint_torque_regressor(body, placed, v, a),
        "link_motions": lambda: algorithms.link_motions(body, placed, v, a),
        "link_motion_derivatives": lambda: algorithms.link_motion_derivatives(body, last, placed, v, a),
    }


def numbers(answer: Any) -> list[np.ndarray]:
    return [np.array(part) for part in answer] if isinstance(answer, tuple) else [np.array(answer)]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("kind", [list, tuple, np.array])
def test_plain_numbers_have_the_answers_of_those_that_python_checks(name: str, kind: Any) -> None:
    body = robot(name)
    # Native code leaves this type to Python.
    checked = calls(body, lambda values: array("d", values.tolist()))
    for what, call in calls(body, kind).items():
        for found, expected in zip(numbers(call()), numbers(checked[what]()), strict=True):
            assert found.shape == expected.shape, what
            assert (found == expected).all(), what


@pytest.mark.parametrize("name", CASES)
def test_parts_of_centroidal_dynamics_are_its_very_numbers(name: str) -> None:
    found = {what: call() for what, call in calls(robot(name), np.array).items()}
    whole = found["centroidal_dynamics"]
    assert (found["center_of_mass"] == whole.center_of_mass).all()
    assert (found["its jacobian"] == whole.jacobian_center_of_mass).all()
    assert (found["momentum"] == whole.momentum).all()
    assert (found["its map"] == whole.dh_dv).all()
    assert found["kinetic_energy"] == whole.kinetic_energy
    assert found["potential_energy"] == whole.potential_energy
    assert type(found["kinetic_energy"]) is type(found["potential_energy"]) is float


@pytest.mark.skipif(host is None, reason="this Python has no builtins of the library")
@pytest.mark.parametrize("name", CASES)
def test_plain_numbers_are_answered_natively(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    body = robot(name)
    asked = calls(body, np.array)
    for call in asked.values():
        call()

    def refuse(*_: Any, **__: Any) -> None:
        raise AssertionError("Python has checked plain numbers")

    for module in ("forward_kinematics", "inverse_dynamics", "jacobian", "mass_matrix"):
        monkeypatch.setattr(import_module(f"carom.algorithms.{module}"), "_checked", refuse)
    monkeypatch.setattr("carom.algorithms.sweeps.Sweeps.ask", refuse)
    for call in asked.values():
        call()


def test_results_are_new_arrays() -> None:
    body = robot("panda")
    for what, call in calls(body, np.array).items():
        first = numbers(call())
        kept = [part.copy() for part in first]
        answer = call()
        for part in answer if isinstance(answer, tuple) else [answer]:
            if isinstance(part, np.ndarray):
                part.fill(7.0)
        again = numbers(call())
        assert all((a == b).all() for a, b in zip(again, kept, strict=True)), what


def test_changes_of_the_body_and_of_its_world_count() -> None:
    world = World()
    other = world.load(CASES["panda"][0], fixed_base=True).bodies[0]
    body = robot("panda", world)
    q = np.full(sum(body.position_count), 0.1)
    before = algorithms.gravity_forces(body, q), body.forward_kinematics(q), algorithms.mass_matrix(body, q)
    world.gravity = (0.0, 0.0, 2.0 * GRAVITY[2])
    doubled = algorithms.gravity_forces(body, q)
    world.gravity = (0.0, 0.0, GRAVITY[2])
    assert np.allclose(doubled, 2.0 * algorithms.gravity_forces(body, q))
    # The rows of the body move to others.
    world.remove(other)
    assert (algorithms.mass_matrix(body, q) == before[2]).all()
    assert (body.forward_kinematics(q) == before[1]).all()
    body.set_pose(((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
    assert np.allclose(body.forward_kinematics(q)[:, :3] + (1.0, 2.0, 3.0), before[1][:, :3])
    for link in range(-1, body.joint_count):
        body.change_dynamics(link, mass=2.0 * body.dynamics(link).mass)
    assert (np.diag(algorithms.mass_matrix(body, q)) > np.diag(before[2])).all()


def test_mistakes_are_told() -> None:
    body = robot("panda")
    q = np.zeros(sum(body.position_count))
    for _ in range(2):
        with pytest.raises(ValueError, match=r"positions must have shape \(9,\), not \(8,\)"):
            algorithms.gravity_forces(body, q[1:])
        with pytest.raises(ValueError, match="positions must be finite"):
            algorithms.center_of_mass(body, np.full(9, np.nan))
        with pytest.raises(ValueError, match="positions must be finite"):
            algorithms.forward_kinematics(body, np.full(9, np.inf))
        with pytest.raises(ValueError, match=r"8 joint positions; .* has 9"):
            algorithms.forward_kinematics(body, q[1:])
        with pytest.raises(ValueError, match="takes 9 positions, not 8"):
            algorithms.mass_matrix(body, q[1:])
        with pytest.raises(ValueError, match="takes 9 positions and 9 velocities"):
            algorithms.inverse_dynamics(body, q, q, q[1:])
    free = robot("floating tree")
    placed = np.array([*np.zeros(7), *np.zeros(sum(free.position_count))])
    with pytest.raises(ValueError, match="the quaternion of the base is 0"):
        algorithms.center_of_mass(free, placed)


def test_a_call_waits_for_another_thread_that_has_the_world() -> None:
    body = robot("panda")
    q = np.zeros(9)
    expected = algorithms.mass_matrix(body, q)
    found: list[np.ndarray] = []
    with body.world.lock:
        thread = threading.Thread(target=lambda: found.append(algorithms.mass_matrix(body, q)))
        thread.start()
        thread.join(0.2)
        assert thread.is_alive()
    thread.join(10.0)
    assert (found[0] == expected).all()
