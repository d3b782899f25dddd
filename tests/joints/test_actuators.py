"""Actuators of joints: forces by law and within bounds, states, and many worlds."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.joints.test_joint_terms import INERTIA, H, rod, three_in_motion

from carom import (
    Body,
    Cylinder,
    Damper,
    GeneralActuator,
    IntegratedVelocityActuator,
    Motor,
    PositionActuator,
    VelocityActuator,
    World,
    Worlds,
)
from carom.errors import DescriptionError, StateError


def driven_rod(actuator: Any, control: float = 0.0, rate: float = 0.0) -> Body:
    body = rod()
    body.add_actuator("drive", actuator)
    body.actuators["drive"].control = control
    body.joints[0].reset(0.1, rate)
    return body


def all_kinds() -> Body:
    """The body of `three_joints` with actuators of all kinds."""
    body = three_in_motion()
    for name, actuator in {
        "m": Motor("one", gear=3.0, control_range=(-2.0, 2.0)),
        "p": PositionActuator("two", kp=300.0, kv=20.0, gear=2.0, force_range=(-40.0, 40.0)),
        "v": VelocityActuator("one", kv=4.0),
        "i": IntegratedVelocityActuator("two", kp=50.0, activation_range=(-0.4, 0.4)),
        "d": Damper("one", kv=2.0, control_range=(0.0, 5.0)),
        "c": Cylinder("one", time_constant=0.05, area=2.0, bias=(0.1, -3.0, -0.5)),
        "f": PositionActuator("two", kp=100.0, time_constant=0.03),
    }.items():
        body.add_actuator(name, actuator)
    body.actuators.controls = [5.0, -1.0, 0.3, 1.5, 1.0, 3.0, 0.4]
    return body


# MuJoCo 4.0.0 with `integrator="discrete"`: velocities, activations and forces, after 1 and 60 steps.
VELOCITIES = (
    (0.9944069994610448, -6.024168838781452, 4.466054330843522, -3.7307256996410723, -0.21845716183989927),
    (-0.0016136591506260897, 0.005687173024219619, 0.9046071271160555, -0.11744614580263708, 0.3979306095485),
)
ACTIVATIONS = ((0.00625, 0.25, 0.05187010966664381), (0.375, 2.983789082284995, 0.3999038522094322))
POSITIONS = (0.61405613, -0.19909717)


def test_same_as_mujoco() -> None:
    body = all_kinds()
    body.world.parameters.solver_residual_threshold = 0.0
    body.world.parameters.solver_iterations = 500
    body.world.apply_parameters()
    for steps, velocities, activations in zip((1, 59), VELOCITIES, ACTIVATIONS, strict=True):
        body.world.step(steps)
        assert_allclose(body.joints.velocities, velocities, rtol=0, atol=1e-9)
        assert_allclose(body.actuators.activations[[3, 5, 6]], activations, rtol=0, atol=1e-9)
    assert_allclose(body.joints.positions[:2], POSITIONS, rtol=0, atol=1e-8)


def test_a_motor_within_its_ranges() -> None:
    body = driven_rod(Motor("joint0", gear=3.0, control_range=(-1.0, 1.0), force_range=(-0.5, 0.8)), 10.0)
    body.world.step()
    assert body.joints[0].velocity == pytest.approx(H * 3.0 * 0.8 / INERTIA, rel=1e-12)
    assert body.actuators["drive"].force == pytest.approx(0.8, rel=1e-12)


def test_a_servo_is_implicit() -> None:
    body = driven_rod(PositionActuator("joint0", kp=100.0, kv=5.0, gear=-2.0), 0.5, rate=0.3)
    body.world.step()
    rate = (INERTIA * 0.3 - H * 2.0 * 100.0 * (0.5 + 0.2)) / (INERTIA + H * 4.0 * (5.0 + H * 100.0))
    drive = body.actuators["drive"]
    assert body.joints[0].velocity == pytest.approx(rate, rel=1e-12)
    assert drive.force == pytest.approx(100.0 * (0.5 - drive.length) - 5.0 * drive.velocity, rel=1e-9)


def test_a_stiff_servo_is_stable_and_bounded() -> None:
    body = driven_rod(PositionActuator("joint0", kp=1e7, kv=2e6, force_range=(-3.0, 3.0)), 0.5)
    body.world.step()
    assert body.joints[0].velocity == pytest.approx(H * 3.0 / INERTIA, rel=1e-9)
    body.world.step(480)
    assert body.joints[0].position == pytest.approx(0.5, abs=1e-3)
    assert abs(body.actuators["drive"].force) <= 3.0


def test_several_servos_of_one_joint_add_up() -> None:
    body = driven_rod(PositionActuator("joint0", kp=60.0, kv=1.0), 0.5)
    body.add_actuator("other", PositionActuator("joint0", kp=40.0, kv=2.0))
    body.actuators["other"].control = 0.5
    body.world.parameters.solver_residual_threshold = 0.0
    body.world.apply_parameters()
    one = driven_rod(PositionActuator("joint0", kp=100.0, kv=3.0), 0.5)
    for world in (body.world, one.world):
        world.step()
    assert body.joints[0].velocity == pytest.approx(one.joints[0].velocity, rel=1e-9)


def test_a_negative_damper_is_explicit() -> None:
    body = driven_rod(GeneralActuator("joint0", bias=(0.0, 0.0, 2.0)), rate=1.0)
    body.world.step()
    assert body.joints[0].velocity == pytest.approx(1.0 + H * 2.0 / INERTIA, rel=1e-12)


def test_substeps_advance_activations() -> None:
    body = driven_rod(IntegratedVelocityActuator("joint0", kp=0.0, activation_range=(-1.0, 0.9)), 2.0)
    body.world.parameters.substeps = 4
    body.world.apply_parameters()
    body.world.step(10)
    assert body.actuators["drive"].activation == pytest.approx(20.0 * H, rel=1e-12)
    body.world.step(200)
    assert body.actuators["drive"].activation == 0.9


@pytest.mark.parametrize(
    ("actuator", "message"),
    [
        (Motor("elbow"), "no joint 'elbow'; there are 'one', 'two', 'ball'"),
        (Motor("ball"), "spherical; actuators are built for revolute and prismatic"),
        (Motor("one", gear=0.0), "gear is 0"),
        (Motor("one", force_range=(1.0, 0.0)), "force_range 1 to 0 is empty"),
        (Motor("one", gear=math.nan), "must be finite"),
        (Cylinder("one", time_constant=0.0), "time constant"),
        (Damper("one", control_range=(-1.0, 1.0)), "must not be negative"),
    ],
)
def test_wrong_actuators_are_refused(actuator: Any, message: str) -> None:
    body = three_in_motion()
    with pytest.raises(DescriptionError, match=message):
        body.add_actuator("drive", actuator)
    assert len(body.actuators) == 0
    body.world.step()


def test_names_are_unique() -> None:
    body = all_kinds()
    with pytest.raises(DescriptionError, match="a name of its own"):
        body.add_actuator("m", Motor("one"))


def test_controls_that_are_not_finite_are_refused() -> None:
    body = all_kinds()
    with pytest.raises(ValueError, match="control"):
        body.actuators["m"].control = math.nan
    with pytest.raises(ValueError, match="controls"):
        body.actuators.controls = [1.0, 2.0]


def test_bodies_keep_their_actuators_when_others_get_some_or_go() -> None:
    world = World(H)
    spec = rod().spec
    bodies = [world.load(spec) for _ in range(3)]
    for number in (2, 0, 1, 0):
        body = bodies[number]
        body.add_actuator(f"drive{len(body.actuators)}", Motor("joint0"))
        body.actuators.controls = float(number + 1)
    world.step()
    for factor, (number, body) in zip((2, 1, 1), enumerate(bodies), strict=True):
        assert body.joints[0].velocity == pytest.approx(factor * H * (number + 1) / INERTIA, rel=1e-9)
    world.remove(bodies[0].id)
    before = bodies[2].joints[0].velocity
    world.step()
    assert bodies[2].joints[0].velocity - before == pytest.approx(H * 3.0 / INERTIA, rel=1e-9)


def test_states_and_files_keep_actuators(tmp_path: Path) -> None:
    body = all_kinds()
    body.world.step(5)
    body.world.save(tmp_path / "driven.carom")
    other = World()
    copy = other.load(tmp_path / "driven.carom").bodies[0]
    start = body.world.snapshot()
    for world in (body.world, other):
        world.step(20)
    np.testing.assert_array_equal(body.world.position, other.position)
    np.testing.assert_array_equal(body.actuators.activations, copy.actuators.activations)
    end = body.world.position.copy()
    body.world.restore(start)
    body.world.step(20)
    np.testing.assert_array_equal(body.world.position, end)
    body.add_actuator("more", Motor("one"))
    with pytest.raises(StateError, match="7 actuators"):
        body.world.restore(start)


def test_each_world_is_alone() -> None:
    scene = all_kinds()
    worlds = Worlds(scene.world, 3, threads=2)
    batch = worlds[scene]
    controls = scene.actuators.controls * np.array([[1.0], [0.5], [-1.0]])
    batch.actuators.controls = controls
    batch.actuators["p"].change(gear=[1.0, 2.0, 3.0])
    batch.actuators["v"].change(where=[1], gain=(7.0, 0.0, 0.0))
    worlds.step(20)
    assert len(set(batch.actuators.forces[:, 1])) == 3
    for number in range(3):
        alone = scene.world.copy()
        body = alone.bodies[scene.id]
        body.actuators.controls = controls[number]
        row = body.rows.first["actuator"]
        alone.arrays.model.numpy["actuator_gear"][:, row + 1] = number + 1.0
        if number == 1:
            alone.arrays.model.numpy["actuator_gain"][:, row + 2] = (7.0, 0.0, 0.0)
        alone.step(20)
        np.testing.assert_array_equal(batch.joints.positions[number], body.joints.positions)
        np.testing.assert_array_equal(batch.actuators.activations[number], body.actuators.activations)
        taken = worlds.extract(number)
        assert taken.bodies[scene.id].actuators["p"].gear == number + 1.0
        for world in (alone, taken):
            world.step(5)
        np.testing.assert_array_equal(taken.position, alone.position)
    with pytest.raises(ValueError, match="gear must not be 0"):
        batch.actuators["p"].change(gear=0.0)
    with pytest.raises(TypeError, match="no parameter 'kd'; they have kp, kv, gear, gain"):
        batch.actuators["p"].change(kd=0.0)
    with pytest.raises(ValueError, match="kp must not be negative"):
        batch.actuators["p"].kp = -1.0
    with pytest.raises(TypeError, match="kp is a part of bias"):
        batch.actuators["p"].change(kp=1.0, bias=(0.0, 0.0, 0.0))
    batch.actuators["p"].change(kp=[3.0, 4.0], kv=0.5, where=[0, 2])
    np.testing.assert_array_equal(batch.actuators["p"].kp[[0, 2]], [3.0, 4.0])
    np.testing.assert_array_equal(batch.actuators["p"].kv[[0, 2]], [0.5, 0.5])
