"""Several logs that are fitted at once."""

from __future__ import annotations

import numpy as np
import pytest
from tests.identification.robots import STEP, disturb, excited_panda, load, panda

from carom import identify

_CONTROL = "physics.slider_to_cart.torque"


def _swing(angle: float, count: int = 50, noise: float = 0.0) -> dict:
    """A run of a cart with a pole, damped more than in its file."""
    world, robot = load("cartpole.urdf")
    robot.joints.movable[0].damping, robot.joints.movable[1].damping = 0.7, 0.2
    robot.joints.reset([0.0, angle])
    force, rows = 3.0 * np.sin(0.2 * np.arange(count) + angle), []
    for row in range(count):
        rows.append(robot.joints.positions)
        robot.joints.set_torques([force[row], 0.0])
        world.step()
    positions = np.array(rows) + np.random.default_rng(0).normal(0.0, noise, (count, 2))
    return {"time": STEP, "positions": positions, "controls": {_CONTROL: force}}


def test_predictions_of_two_logs():
    world, _ = load("cartpole.urdf")
    logs = [_swing(0.4), _swing(-0.8, 70)]
    found = identify(logs, world, ["damping"], horizon=25)
    assert list(found.values.values()) == pytest.approx([0.7, 0.2], abs=1e-5)
    assert found.measured.shape == (120, 2)
    assert found.time == pytest.approx(STEP * np.arange(120))
    assert found.measured == pytest.approx(np.concatenate([it["positions"] for it in logs]))
    assert found.fitted == pytest.approx(found.measured, abs=1e-6)
    lone = identify(logs[:1], world, ["damping"], horizon=25)
    assert lone.values == identify(logs[0], world, ["damping"], horizon=25).values


def test_a_log_with_less_noise_counts_more():
    world, _ = load("cartpole.urdf")
    logs = [_swing(0.4, 100, 1e-2), _swing(-0.8, 100, 1e-5)]
    found = identify(logs, world, ["damping"], horizon=50)
    by_noisy = identify(logs[0], world, ["damping"], horizon=50)
    by_good = identify(logs[1], world, ["damping"], horizon=50)
    for name, value in found.values.items():
        assert abs(value - by_good.values[name]) < 0.1 * abs(by_noisy.values[name] - by_good.values[name])
        assert found.bounds[name] <= 1.05 * by_good.bounds[name]


def test_torques_of_two_logs():
    random = np.random.default_rng(3)
    world, robot = panda()
    disturb(robot, random)
    logs = [excited_panda(world, robot, random, 3.0) for _ in range(2)]
    for log in logs:
        log["torques"] = log["torques"] + random.normal(0.0, 0.05, log["torques"].shape)
    parameters = ["damping", "joint_friction"]
    both = identify(logs, world, parameters)
    lone = [identify(log, world, parameters) for log in logs]
    assert both.cutoff == min(it.cutoff for it in lone if it.cutoff is not None)
    assert both.measured.shape[0] == sum(it.measured.shape[0] for it in lone)
    assert len(both.time) == len(both.measured)
    certain = [name for name, bound in both.bounds.items() if np.isfinite(bound)]
    assert len(certain) >= 7
    for name in certain:
        assert both.bounds[name] < min(it.bounds[name] for it in lone)


def test_logs_have_to_fit_each_other():
    world, _ = load("cartpole.urdf")
    log = _swing(0.4)
    with pytest.raises(ValueError, match="no log in the list"):
        identify([], world, ["damping"])
    with pytest.raises(ValueError, match="log 1 has the controls"):
        identify([log, {**log, "controls": {}}], world, ["damping"])
    with pytest.raises(ValueError, match="log 1 has other channels"):
        identify([log, {**log, "velocities": np.zeros((50, 2))}], world, ["damping"])
    with pytest.raises(ValueError, match="belong into each"):
        identify([log], world, ["damping"], controls={_CONTROL: np.zeros(50)})
