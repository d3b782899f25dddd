"""Identification by torques: a simulated Panda, within the bounds that are stated."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.identification.robots import (
    ARM,
    JOINTS,
    disturb,
    errors,
    excited_panda,
    panda,
    panda_parameters,
    truth,
)

from carom import identify
from carom.algorithms import inverse_dynamics

_POSITION_NOISE, _TORQUE_NOISE = 1e-5, 0.1


def _noisy_log(seed, duration=10.0):
    rng = np.random.default_rng(seed)
    world, robot = panda()
    disturb(robot, rng)
    log = excited_panda(world, robot, rng, duration)
    del log["velocities"]
    log["positions"] += rng.normal(0.0, _POSITION_NOISE, log["positions"].shape)
    log["torques"] += rng.normal(0.0, _TORQUE_NOISE, log["torques"].shape)
    return log, robot


@cache
def _log_of_two_seconds():
    return _noisy_log(4, 2.0)[0]


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 1018])
def test_a_panda_is_recovered_within_its_bounds(seed):
    log, true_robot = _noisy_log(seed)
    world, robot = panda()
    result = identify(log, world, panda_parameters(robot))
    # 43 sums of inertial parameters with armature, and others: what torques of this arm determine.
    assert len(result.combinations) == 62
    off = errors(result, truth(true_robot))
    assert np.abs(off).max() < 1.0
    # Bounds are not just wide: errors are a fair share of them.
    assert np.sqrt((off**2).mean()) > 0.1
    for joint in JOINTS:
        assert result.bounds[f"{robot.name}.{joint}.damping"] < 0.25
        assert result.bounds[f"{robot.name}.{joint}.joint_friction"] < 0.2
        assert 0.08 < result.noise[joint] < 0.3


@pytest.mark.long
def test_torques_of_the_world_are_those_measured_after_the_values_are_applied():
    log, true_robot = _noisy_log(3)
    world, robot = panda()
    result = identify(log, world, panda_parameters(robot))
    still = np.zeros(ARM + 2)
    pose = log["positions"][100]
    wanted = inverse_dynamics(true_robot, pose, still, still)[:ARM]
    before = inverse_dynamics(robot, pose, still, still)[:ARM]
    result.apply(world)
    after = inverse_dynamics(robot, pose, still, still)[:ARM]
    assert np.abs(before - wanted).max() > 1.0
    assert np.abs(after - wanted).max() < 0.1
    joint, true_joint = robot.joints[JOINTS[2]], true_robot.joints[JOINTS[2]]
    assert joint.damping == pytest.approx(true_joint.damping, abs=0.1)
    assert joint.friction_loss == pytest.approx(true_joint.friction_loss, abs=0.1)


def test_without_noise_the_motion_is_explained_completely():
    rng = np.random.default_rng(5)
    world, robot = panda()
    disturb(robot, rng)
    true = truth(robot)
    log = excited_panda(world, robot, rng, 2.0)
    log["accelerations"] = np.diff(log["velocities"], axis=0, append=np.nan) / world.parameters.time_step
    other, model = panda()
    result = identify({name: value[:-1] for name, value in log.items()}, other, panda_parameters(model))
    assert len(result.combinations) == 62
    for it in result.combinations:
        assert it.value == pytest.approx(sum(f * true[name] for name, f in it.factors.items()), abs=1e-8)


def test_what_cannot_be_told_apart_is_named():
    log = _log_of_two_seconds()
    world, robot = panda()
    result = identify(log, world, panda_parameters(robot))
    # The first joint is vertical: it feels the moments about its axis only.
    assert f"{robot.name}.panda_link1.inertial.mass" in result.ineffective
    first = f"{robot.name}.panda_joint1.armature"
    (together,) = [it for it in result.combinations if first in it.factors]
    assert together.factors[f"{robot.name}.panda_link1.inertial.inertia.zz"] == pytest.approx(1.0)
    assert not np.isfinite(result.bounds[first])
    assert first in result.report()


def test_a_prior_determines_the_rest():
    log = _log_of_two_seconds()
    world, robot = panda()
    names = [f"{robot.name}.panda_joint1.{end}" for end in ("armature", "damping")]
    names.append(f"{robot.name}.panda_link1.inertial")
    loose = identify(log, world, names)
    tight = identify(log, world, names, prior=0.1)
    mass = f"{robot.name}.panda_link1.inertial.mass"
    assert mass in loose.ineffective
    assert not tight.ineffective
    # Not exactly that of the file: the moment about the axis is as great as the others allow.
    assert abs(tight.values[mass] - 2.7) < 0.01 * tight.deviations[mass]
    assert tight.deviations[mass] == pytest.approx(0.27, rel=1e-3)


def test_what_torques_do_not_depend_on_is_refused():
    log, _ = _noisy_log(4, 0.5)
    world, robot = panda()
    with pytest.raises(ValueError, match="prediction"):
        identify(log, world, ["motor_position_gains"])
    with pytest.raises(ValueError, match="no parameter"):
        identify(log, world, ["dampness"])
    robot.change_dynamics(-1, linear_damping=0.04)
    with pytest.raises(ValueError, match="air damps"):
        identify(log, world, ["damping"])


def test_a_plot_shows_joints_and_parameters(tmp_path):
    pytest.importorskip("matplotlib", reason="draws the plot")
    log, _ = _noisy_log(4, 0.5)
    world, robot = panda()
    result = identify(log, world, [f"{robot.name}.{joint}.damping" for joint in JOINTS])
    result.plot(tmp_path / "plot.svg")
    text = (tmp_path / "plot.svg").read_text(encoding="utf-8")
    assert text.count('<g id="axes_') >= 2 * ARM + 1
