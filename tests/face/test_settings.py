"""Attributes of worlds and actuators that were arguments or parameters: solver, gains, the window."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.face.scene import made

import carom
from carom import Solver, World, Worlds


def test_the_solver_is_an_argument_and_an_attribute() -> None:
    world = World(solver=Solver(iterations=80, tolerance=1e-9), contact="bullet")
    assert world.solver == Solver(80, 1e-9, "sweeps")
    assert world.parameters.solver_iterations == 80
    world.solver = 20
    assert world.solver == Solver(20, 1e-7, "sweeps")
    world.contact = "rigid"
    assert world.solver.name == "newton"
    wrong: Any = "newton"
    with pytest.raises(TypeError, match="contact='bullet', 'rigid' or 'compliant'"):
        world.solver = wrong
    with pytest.raises(ValueError, match="must be at least 0"):
        world.solver = Solver(-1)
    assert world.solver.iterations == 20


def test_gains_of_an_actuator_are_set_as_a_file_would() -> None:
    world, arm, _ = made()
    other, same, _ = made()
    bend = arm.actuators["bend"]
    bend.kp = 60.0
    bend.change(kv=5.0, force_range=(-3.0, 3.0))
    assert (bend.kp, bend.kv, bend.force_range) == (60.0, 5.0, (-3.0, 3.0))
    worlds = Worlds(other, 1)
    worlds[same].actuators["bend"].change(kp=60.0, kv=5.0, force_lower=-3.0, force_upper=3.0)
    for each in (world, worlds):
        each.controls = (0.7, 0.5)
        each.step(60)
    assert arm.joints.positions.tolist() == worlds[same].joints.positions[0].tolist()
    assert world.copy()["arm"].actuators["bend"].kp == 60.0
    for error, words, change in (
        (ValueError, "kp", {"kp": -1.0}),
        (ValueError, "kv", {"kv": math.nan}),
        (TypeError, "no parameter 'stiffness'; they have kp, kv, gear", {"stiffness": 1.0}),
        (carom.errors.DescriptionError, "gear is 0", {"gear": 0.0}),
        (carom.errors.DescriptionError, "is empty", {"control_range": (1.0, 0.0)}),
    ):
        with pytest.raises(error, match=words):
            bend.change(**change)
    assert (bend.kp, bend.gear) == (60.0, 1.0)
    bend.gear = 2.0
    bend.control_range = (-math.inf, math.inf)
    world.step()
    assert np.isfinite(arm.joints.positions).all()


def test_a_window_is_opened_by_the_world() -> None:
    world, _, _ = made()
    viewer = world.view(title="arm")
    try:
        assert viewer.is_open
        world.step(2)
    finally:
        viewer.close()
