"""Identification of robots with a free base: by forces on links, torques and sensors of forces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.identification.flying import disturb, flight, flyer, with_noise
from tests.identification.robots import errors, truth

from carom import Gyro, identify
from carom.algorithms import inertial_parameters
from carom.identification import exciting_trajectory
from carom.identification.link_inertia import set_link_inertia
from carom.linearization.inputs import INERTIAL_NUMBERS


def _truth(robot: Any) -> dict[str, float]:
    base = inertial_parameters(robot)[0].tolist()
    return truth(robot) | {
        f"flyer.base.inertial.{name}": value for name, value in zip(INERTIAL_NUMBERS, base, strict=True)
    }


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, dict[str, Any], dict[str, float]]:
    folder = tmp_path_factory.mktemp("flyer")
    world, robot = flyer(folder, sensors=True)
    rng = np.random.default_rng(0)
    disturb(robot, rng)
    return folder, flight(world, robot, rng, 2500), _truth(robot)


def test_all_links_of_a_flying_robot_are_found_in_spite_of_noise(flown):
    folder, log, true = flown
    world, robot = flyer(folder, sensors=True)
    noisy = with_noise(log, np.random.default_rng(0), 2e-4, 0.02)
    result = identify(noisy, world, ["inertial_parameters", "damping"])
    assert np.abs(errors(result, true)).max() < 1.0
    assert result.bounds["flyer.lower.inertial.mass"] < 2e-3
    whole = {"flyer.upper.inertial.mass": 1.0, "flyer.base.inertial.mass": 1.0}
    (together,) = (it for it in result.combinations if it.factors.keys() == whole.keys())
    assert together.factors == pytest.approx(whole, abs=1e-6)
    assert together.bound < 0.01
    result.apply(world)
    for number, value in zip(INERTIAL_NUMBERS, inertial_parameters(robot)[0], strict=True):
        assert value == pytest.approx(result.values[f"flyer.base.inertial.{number}"], abs=1e-9)


def test_a_sensor_of_force_and_torque_alone_weighs_what_it_holds(flown):
    folder, log, true = flown
    world, _ = flyer(folder, sensors=True)
    noisy = with_noise(log, np.random.default_rng(5), 2e-4, 0.02)
    noisy["torques"] = noisy["forces"] = None
    result = identify(noisy, world, ["flyer.lower.inertial"], residuals="torque")
    assert np.abs(errors(result, true)).max() < 1.0
    assert max(result.bounds.values()) < 2e-3
    assert {"push.0", "twist.2"} <= set(result.noise)


def test_a_falling_robot_tells_its_masses_by_the_torques_of_its_joints(tmp_path):
    world, robot = flyer(tmp_path)
    rng = np.random.default_rng(1)
    disturb(robot, rng)
    log = flight(world, robot, rng, 1500, pushed=False)
    model, _ = flyer(tmp_path)
    result = identify(with_noise(log, rng, 5e-5, 5e-3), model, ["inertial_parameters", "damping"])
    assert np.abs(errors(result, _truth(robot))).max() < 1.0
    # Without any force there is no scale.
    log["torques"] = None
    with pytest.raises(ValueError, match=r"no forces on 'flyer', so it tells ratios .*: add torques"):
        identify(log, flyer(tmp_path)[0], ["inertial_parameters"], residuals="torque")


def test_mistakes_in_logs_of_free_bases_are_named(flown):
    folder, log, _ = flown
    names = ["inertial_parameters"]

    def wrong(match: str, model: Any = None, parameters: Any = names, **changes: Any) -> None:
        world, robot = model or flyer(folder, sensors=True)
        robot.add_sensor("turning", Gyro("wrist"))
        with pytest.raises(ValueError, match=match):
            identify({**log, **changes}, world, parameters, residuals="torque")

    bare = {"base_positions": None, "base_orientations": None, "base_velocities": None}
    wrong("'flyer' has a free base: the log needs base_positions", **bare)
    wrong("come together", base_orientations=None)
    wrong(
        r"base_positions must have shape \(N, 3\), not \(2500, 2\)",
        base_positions=log["base_positions"][:, :2],
    )
    wrong(
        "row 7 is 0, so it is no",
        base_orientations=np.where(np.arange(2500)[:, None] == 7, 0.0, 1.0) * [0, 0, 0, 1],
    )
    wrong(
        "forces act on 'wing', but 'flyer' has the links body, upper", forces={"wing": log["forces"]["body"]}
    )
    wrong(r"forces on 'body' must have shape \(2500, 6\)", forces={"body": log["forces"]["body"][:, :2]})
    wrong("no sensor 'imu'; its sensors are push, twist", sensors={"imu": np.zeros((2500, 3))})
    wrong("sensor 'push' has 3 numbers, the log 2", sensors={"push": np.zeros((2500, 2))})
    wrong("'turning' shows motion, .*prediction", sensors={"turning": np.zeros((2500, 3))})
    world, _ = flyer(folder)
    with pytest.raises(ValueError, match="free base: choose a cutoff instead of a window"):
        identify({**log, "sensors": {}}, world, names, residuals="torque", window=5)
    with pytest.raises(ValueError, match="free base: exciting motions are those of robots with a fixed one"):
        exciting_trajectory(world, names, velocity=1.0, acceleration=1.0)


def test_logs_of_free_bases_come_from_archives(flown, tmp_path):
    folder, given, _ = flown
    log: dict[str, Any] = given
    log = {name: it[:400] if isinstance(it, np.ndarray) else it for name, it in log.items()}
    log |= {group: {name: it[:400] for name, it in log[group].items()} for group in ("forces", "sensors")}
    arrays: dict[str, Any] = {name: it for name, it in log.items() if isinstance(it, np.ndarray)}
    for group in ("forces", "sensors"):
        arrays |= {f"{group}.{name}": it for name, it in log[group].items()}
    np.savez(tmp_path / "flight.npz", time=log["time"], **arrays)
    given, world = (flyer(folder, sensors=True)[0] for _ in range(2))
    found = identify(tmp_path / "flight.npz", world, ["flyer.lower.inertial"])
    assert found.values == identify(log, given, ["flyer.lower.inertial"]).values


@pytest.mark.parametrize("link", [-1, 1])
def test_a_link_that_gets_another_inertia_stays_where_it_is_and_moves_as_before(tmp_path, link):
    world, robot = flyer(tmp_path, sensors=True)
    robot.set_pose(((0.3, -0.2, 0.5), (0.2, -0.3, 0.1, 0.9)))
    robot.joints.reset([0.4, -0.7], [1.0, 2.0])
    robot.set_velocity((0.1, 0.2, 0.3), (1.0, -2.0, 0.5))
    frames = [(it.pose.position, it.pose.orientation) for it in (robot.base, *robot.links)]
    spins = [it.velocity.angular for it in (robot.base, *robot.links)]
    numbers = (0.8, (0.03, 0.02, -0.05), np.diag([0.01, 0.02, 0.015]) + 0.001)
    set_link_inertia(robot, link, *numbers)
    for it, (position, orientation), spin in zip((robot.base, *robot.links), frames, spins, strict=True):
        assert it.pose.position == pytest.approx(position, abs=1e-12)
        assert abs(it.pose.orientation @ orientation) == pytest.approx(1.0, abs=1e-12)
        assert it.velocity.angular == pytest.approx(spin, abs=1e-12)
    # The sensors show what those of a robot show that has had this inertia from the start.
    other, same = flyer(tmp_path)
    set_link_inertia(same, link, *numbers)
    same.set_pose(((0.3, -0.2, 0.5), (0.2, -0.3, 0.1, 0.9)))
    same.joints.reset([0.4, -0.7], [1.0, 2.0])
    same.set_velocity(*robot.velocity)
    for sensor in robot.sensors:
        site = robot.sites[sensor.spec.object]
        if site.name not in same.sites.names:
            same.add_site(site.name, "lower", robot.spec.sites[site.index].pose)
        same.add_sensor(sensor.name, type_of(sensor.spec)(site.name))
    for scene in (world, other):
        for _ in range(3):
            scene.step()
    for sensor, beside in zip(robot.sensors, same.sensors, strict=True):
        assert sensor.read() == pytest.approx(beside.read(), abs=1e-9)
    assert robot.pose.position == pytest.approx(same.pose.position, abs=1e-12)


def type_of(spec: Any) -> Any:
    from carom import Force, Torque

    return {"force": Force, "torque": Torque}[spec.kind.value]


def test_regressors_of_many_states_are_those_of_one(tmp_path):
    from carom.algorithms.regressor import joint_torque_regressor, joint_torque_regressors

    _, robot = flyer(tmp_path)
    rng = np.random.default_rng(0)
    turns = rng.normal(size=(3, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    positions = np.concatenate([rng.normal(size=(3, 3)), turns, rng.normal(size=(3, 2))], axis=1)
    rates, changes = rng.normal(size=(2, 3, 8))
    found = joint_torque_regressors(robot, positions, rates, changes)
    for own, given in zip(found, zip(positions, rates, changes, strict=True), strict=True):
        assert own == pytest.approx(joint_torque_regressor(robot, *given), abs=1e-12)
