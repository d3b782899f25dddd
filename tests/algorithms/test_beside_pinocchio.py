"""Dynamics and derivatives against recorded answers of Pinocchio, to ten digits.

`record_pinocchio.py` records them. Pinocchio has the linear velocity of a free base before the angular one,
and derivatives of their components as accelerations.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.algorithms.moving_robots import Vector, is_close
from tests.algorithms.record_pinocchio import ANSWERS, CASES

from carom import Body, World, algorithms

TOLERANCE = 1e-10


@cache
def recorded() -> dict[str, Any]:
    assert ANSWERS.exists(), "run tests/algorithms/record_pinocchio.py"
    return json.loads(Path(ANSWERS).read_text(encoding="utf-8"))


class Case:
    """A robot with the coordinates of the recording.

    Attributes:
        body: The robot.
        answer: What was recorded.
        q: Positions.
        v: Velocities.
        tau: Forces.
        order: For each velocity of Pinocchio its place among those here.
        twist: Derivatives of ω x v of a free base by the velocities; these are parts of accelerations here.
    """

    def __init__(self, name: str) -> None:
        path, is_fixed, self.link = CASES[name]
        world = World()
        world.gravity = recorded()["gravity"]
        is_stated = path.suffix == ".sdf"
        scene = world.load(path) if is_stated else world.load(path, fixed_base=is_fixed)
        self.body: Body = scene.bodies[0]
        self.answer = {key: np.array(value) for key, value in recorded()[name].items() if key != "joints"}
        base = 0 if is_fixed else 6
        theirs = [name for name in recorded()[name]["joints"] if name != "root_joint"]
        ours = [link.joint_name for link, moves in self.links() if moves]
        assert sorted(theirs) == sorted(ours)
        self.order = [*([3, 4, 5, 0, 1, 2] if base else []), *(base + ours.index(name) for name in theirs)]
        q = self.answer["q"]
        self.q: Vector = np.concatenate([q[: 7 if base else 0], np.zeros(len(ours))])
        for number, own in zip(q[7 if base else 0 :], self.order[base:], strict=True):
            self.q[own + (1 if base else 0)] = number
        self.v, self.tau = self.ours(self.answer["v"]), self.ours(self.answer["tau"])
        self.twist: Vector = np.zeros((len(self.v), len(self.v)))
        if base:
            self.twist[3:6, :3], self.twist[3:6, 3:6] = -cross(self.v[3:6]), cross(self.v[:3])
        # The twist is bilinear, so its derivatives count it twice.
        self.a: Vector = self.ours(self.answer["a"]) + 0.5 * self.twist @ self.v

    def links(self) -> list[tuple[Any, int]]:
        return list(zip(self.body.spec.links, self.body.velocity_count, strict=True))

    def ours(self, theirs: Vector) -> Vector:
        result = np.zeros(len(theirs))
        result[self.order] = theirs
        return result

    def agrees(self, name: str, found: Vector, axes: str = "") -> bool:
        """Whether an array agrees with a recorded one; of `axes`, those named v are velocities or forces."""
        for axis, kind in enumerate(axes):
            if kind == "v":
                found = np.take(found, self.order, axis=axis)
        return is_close(found, self.answer[name], TOLERANCE)


def cross(v: Vector) -> Vector:
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest) -> Case:
    return Case(request.param)


def test_inverse_dynamics(case: Case):
    found = algorithms.inverse_dynamics_derivatives(case.body, case.q, case.v, case.a)
    assert case.agrees("dtau_dq", found.dtau_dq, "vv")
    assert case.agrees("dtau_dv", found.dtau_dv + found.dtau_da @ case.twist, "vv")
    assert case.agrees("mass", found.dtau_da, "vv")


def test_forward_dynamics(case: Case):
    found = algorithms.forward_dynamics_derivatives(case.body, case.q, case.v, case.tau)
    assert case.agrees("aba", found.accelerations - 0.5 * case.twist @ case.v, "v")
    assert case.agrees("da_dq", found.da_dq, "vv")
    assert case.agrees("da_dv", found.da_dv - case.twist, "vv")
    assert case.agrees("da_dtau", found.da_dtau, "vv")


def test_coriolis_matrix_and_gravity(case: Case):
    assert case.agrees("gravity", algorithms.gravity_forces(case.body, case.q), "v")
    assert case.agrees("bias", algorithms.bias_forces(case.body, case.q, case.v), "v")
    assert case.agrees("coriolis", algorithms.compute_coriolis_matrix(case.body, case.q, case.v), "vv")


def test_centroidal_dynamics(case: Case):
    found = algorithms.centroidal_dynamics(case.body, case.q, case.v, case.a)
    assert case.agrees("center_of_mass", found.center_of_mass)
    assert case.agrees("center_of_mass_jacobian", found.jacobian_center_of_mass, " v")
    assert case.agrees("momentum", found.momentum)
    assert case.agrees("momentum_rate", found.momentum_rate)
    assert case.agrees("dh_dq", found.dh_dq, " v")
    assert case.agrees("dh_dv", found.dh_dv, " v")
    assert case.agrees("drate_dq", found.drate_dq, " v")
    assert case.agrees("drate_dv", found.drate_dv + found.dh_dv @ case.twist, " v")
    assert case.agrees("kinetic_energy", found.kinetic_energy)


def test_motion_of_a_link(case: Case):
    link = case.body.links[case.link].index
    found = algorithms.link_motions(case.body, case.q, case.v, case.a, [link])
    velocity = np.concatenate([found.linear_velocities[0], found.angular_velocities[0]])
    acceleration = np.concatenate([found.linear_accelerations[0], found.angular_accelerations[0]])
    assert case.agrees("link_velocity", velocity)
    assert case.agrees("link_acceleration", acceleration)


def test_regressor(case: Case):
    """Pinocchio has ten columns for each joint, and adds links that are fixed to others to these."""
    parameters = algorithms.inertial_parameters(case.body).ravel()
    regressor = algorithms.joint_torque_regressor(case.body, case.q, case.v, case.a)
    assert case.agrees("rnea", regressor @ parameters, "v")
    base = 0 if case.body.fixed_base else 1
    joints = [10 * (1 + link) for link, (_, moves) in enumerate(case.links()) if moves]
    places = [*([0] if base else []), *(joints[own - 6 * base] for own in case.order[6 * base :])]
    columns = [place + k for place in places for k in range(10)]
    assert case.agrees("regressor", regressor[:, columns], "v ")
