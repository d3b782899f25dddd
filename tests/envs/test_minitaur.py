"""The parts of the Minitaur: motors, legs, lagging sensors, memory, and what changes it."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from math import pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pybullet as p
from pybullet_envs.bullet import MinitaurBulletDuckEnv, MinitaurBulletEnv
from pybullet_envs.bullet import minitaur as bullet_minitaur
from pybullet_envs.bullet import motor as bullet_motor
from pybullet_envs.bullet.minitaur_env_randomizer import MinitaurEnvRandomizer
from pybullet_envs.dc_motor import MOTOR_SPEED_LIMIT, MOTOR_VOLTAGE
from pybullet_envs.minitaur.envs import (
    MinitaurAlternatingLegsEnv,
    MinitaurExtendedEnv,
    MinitaurReactiveEnv,
    MinitaurStandGymEnv,
    MinitaurTrottingEnv,
    minitaur,
    motor,
)
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase
from pybullet_envs.minitaur.envs.leg_pose_env import motor_angles_of, pose_of
from pybullet_envs.minitaur.envs.minitaur_gym_env import MinitaurGymEnv
from pybullet_utils.bullet_client import BulletClient

ANGLES = st.lists(st.floats(-50.0, 50.0), min_size=8, max_size=8)
STANDING = np.full(8, pi / 2)


@pytest.fixture
def world() -> Iterator[Any]:
    with BulletClient(p.DIRECT) as client:
        client.setGravity(0, 0, -10)
        client.setTimeStep(0.002)
        yield client


def test_a_motor_that_stands_saturates() -> None:
    model = bullet_motor.MotorModel(torque_control_enabled=True)
    # At rest the current is the duty cycle's share of 16 V over 0.186 ohms.
    duty = np.array((0.0, 10.0, 25.0, -50.0)) * 0.186 / MOTOR_VOLTAGE
    acting, seen = model.convert_to_torque(duty, np.zeros(4), np.zeros(4))
    assert acting == pytest.approx((0.0, 1.0, 2.175, -3.25))
    assert seen == pytest.approx((0.0, 0.954, 2.385, -4.77))
    assert model.convert_to_torque([2.0], [0.0], [0.0]) == (pytest.approx([3.5]), pytest.approx([5.7]))


def test_a_motor_at_full_speed_has_no_torque_left() -> None:
    model = bullet_motor.MotorModel(torque_control_enabled=True)
    acting, seen = model.convert_to_torque([1.0], [0.0], [MOTOR_SPEED_LIMIT])
    assert acting == pytest.approx([0.0], abs=1e-9)
    assert seen == pytest.approx([5.7])
    model.set_viscous_damping(0.01)
    assert model.get_viscous_dampling() == 0.01
    assert model.convert_to_torque([1.0], [0.0], [MOTOR_SPEED_LIMIT])[0] < 0.0


@given(ANGLES, ANGLES, ANGLES)
def test_both_models_of_the_motors_agree_and_have_no_preferred_direction(
    commands: list[float], angles: list[float], velocities: list[float]
) -> None:
    plain, lagging = bullet_motor.MotorModel(kp=1.0, kd=0.02), motor.MotorModel(kp=1.0, kd=0.02)
    acting, seen = plain.convert_to_torque(commands, angles, velocities)
    assert (np.abs(acting) <= 3.5).all()
    assert (np.abs(seen) <= 5.7).all()
    assert np.array_equal(lagging.convert_to_torque(commands, angles, velocities, velocities)[0], acting)
    back = plain.convert_to_torque(*(np.negative(values) for values in (commands, angles, velocities)))
    assert np.array_equal(back[0], -acting)
    lagging.set_strength_ratios(np.linspace(0.0, 0.7, 8))
    weak = lagging.convert_to_torque(commands, angles, velocities, velocities, np.ones(8), np.full(8, 0.02))
    assert weak[0] == pytest.approx(np.linspace(0.0, 0.7, 8) * acting)


@given(ANGLES)
def test_poses_of_legs_and_angles_of_motors_stand_for_each_other(pose: list[float]) -> None:
    assert pose_of(motor_angles_of(pose)) == pytest.approx(pose, abs=1e-12)


@given(ANGLES)
def test_angles_are_mapped_into_one_turn(angles: list[float]) -> None:
    mapped = minitaur.MapToMinusPiToPi(angles)
    assert (mapped >= -pi - 1e-12).all()
    assert (mapped < pi + 1e-12).all()
    turns = (np.array(angles) - mapped) / (2 * pi)
    assert turns == pytest.approx(np.round(turns), abs=1e-12)


def test_swinging_and_stretching_move_the_two_motors_of_a_leg(world: Any) -> None:
    robot = bullet_minitaur.Minitaur(world)
    rest = robot.ConvertFromLegModel(np.zeros(8))
    assert rest == pytest.approx(np.full(8, pi - 1.5 * pi / 4))
    swung = robot.ConvertFromLegModel([1, 0, 0, 1, 0, 0, 0, 0]) - rest
    assert swung == pytest.approx(pi / 4 * np.array((1, -1, 0, 0, 0, 0, -1, 1)))
    stretched = robot.ConvertFromLegModel([0, 0, 0, 0, 0, 1, 0, 0]) - rest
    assert stretched == pytest.approx(-pi / 4 * np.array((0, 0, 1, 1, 0, 0, 0, 0)))


def test_the_robot_stands_with_its_legs_closed(world: Any) -> None:
    robot = bullet_minitaur.Minitaur(world, time_step=0.002, pd_control_enabled=True)
    world.loadURDF(f"{robot._urdf_root}/plane.urdf")
    for _ in range(300):
        robot.ApplyAction(STANDING)
        world.stepSimulation()
    assert robot.GetMotorAngles() == pytest.approx(STANDING, abs=0.3)
    assert 0.15 < robot.GetBasePosition()[2] < 0.25
    for left, right in ((6, 3), (12, 9), (16, 19), (22, 25)):
        feet = [world.getLinkState(robot.quadruped, link) for link in (left, right)]
        ends = [world.multiplyTransforms(foot[4], foot[5], [0, 0, 0.2], [0, 0, 0, 1])[0][2] for foot in feet]
        assert ends[0] == pytest.approx(ends[1], abs=0.02)


def test_motors_that_strain_for_a_second_are_shut_off(world: Any) -> None:
    robot = bullet_minitaur.Minitaur(
        world,
        time_step=0.5,
        accurate_motor_model_enabled=True,
        torque_control_enabled=True,
        motor_overheat_protection=True,
    )
    duty = np.array((1.0, -1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0))
    for _ in range(2):
        robot.ApplyAction(duty)
    assert robot._running.all()
    robot.ApplyAction(duty)
    assert robot._running.tolist() == [False, False, *[True] * 6]
    robot.Reset(reload_urdf=False)
    assert robot._running.all()


def test_sensors_tell_what_was(world: Any) -> None:
    robot = minitaur.Minitaur(
        world, time_step=0.002, action_repeat=5, accurate_motor_model_enabled=True, control_latency=0.007
    )
    truth = [robot.GetTrueObservation()]
    for _ in range(4):
        robot.Step(STANDING + 0.3)
        truth.append(robot.GetTrueObservation())
    assert robot.GetTimeSinceReset() == pytest.approx(0.04)
    history = list(robot._observation_history)
    told = (history[3] + history[4]) / 2
    assert np.array_equal(history[0], truth[-1])
    assert robot.GetMotorVelocities() == pytest.approx(told[8:16])
    assert robot.GetMotorAngles() == pytest.approx(told[:8])
    assert robot.GetBaseRollPitchYawRate() == pytest.approx(told[28:31])
    robot.SetControlLatency(10.0)
    assert robot.GetControlLatency() == 10.0
    assert robot.GetMotorAngles() == pytest.approx(history[-1][:8])


def test_sensors_are_noisy(world: Any) -> None:
    robot = minitaur.Minitaur(world, observation_noise_stdev=(0.1, 0.0, 0.0, 0.05, 0.0))
    robot.np_random = np.random.default_rng(1)
    samples = np.array([robot.GetMotorAngles() for _ in range(200)])
    assert samples.std() == pytest.approx(0.1, rel=0.2)
    assert np.array_equal(robot.GetMotorVelocities(), robot.GetTrueMotorVelocities())


def test_what_can_be_changed(world: Any) -> None:
    robot = minitaur.Minitaur(world, accurate_motor_model_enabled=True)
    assert robot.chassis_link_ids[0] == -1
    assert len(robot.GetLegMassesFromURDF()) == 24
    robot.SetLegMasses(np.multiply(2.0, robot.GetLegMassesFromURDF()))
    robot.SetBaseMasses(np.multiply(2.0, robot.GetBaseMassesFromURDF()))
    robot.SetBaseInertias(np.multiply(3.0, robot.GetBaseInertiasFromURDF()))
    robot.SetLegInertias(np.multiply(3.0, robot.GetLegInertiasFromURDF()))
    mass, _, inertia = world.getDynamicsInfo(robot.quadruped, -1)[:3]
    assert mass == pytest.approx(2.0 * robot.GetBaseMassesFromURDF()[0])
    assert inertia == pytest.approx(np.multiply(3.0, robot.GetBaseInertiasFromURDF()[0]))
    robot.SetFootFriction(0.9)
    robot.SetFootRestitution(0.3)
    assert world.getDynamicsInfo(robot.quadruped, robot._foot_link_ids[2])[1] == pytest.approx(0.9)
    robot.SetJointFriction([0.01] * robot.GetNumKneeJoints())
    robot.SetMotorGains(1.5, 0.1)
    assert robot.GetMotorGains() == (1.5, 0.1)
    robot.SetMotorStrengthRatio(0.5)
    with pytest.raises(ValueError, match="3 values of mass for 24 links"):
        robot.SetLegMasses([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match="should be non-negative"):
        robot.SetLegInertias(-np.array(robot.GetLegInertiasFromURDF()))


def test_robots_differ_within_bounds_and_by_their_seed() -> None:
    env = MinitaurBulletEnv()
    found = []
    for seed in (1, 2, 1):
        env.reset(seed=seed)
        robot = env.minitaur
        mass = env._p.getDynamicsInfo(robot.quadruped, -1)[0]
        assert 0.8 <= mass / robot.GetBaseMassFromURDF() <= 1.2
        assert 0.8 <= env._p.getDynamicsInfo(robot.quadruped, robot._foot_link_ids[0])[1] <= 1.5
        found.append(mass)
    assert found[0] == found[2] != found[1]
    env.set_env_randomizer(None)
    env.reset(seed=1)
    assert env._p.getDynamicsInfo(env.minitaur.quadruped, -1)[0] == env.minitaur.GetBaseMassFromURDF()
    env.close()


def test_ranges_of_the_randomizer_are_heeded() -> None:
    same = (0.0, 0.0)
    randomizer = MinitaurEnvRandomizer(same, same, battery_voltage_range=(12.0, 12.0))
    env = MinitaurBulletEnv(env_randomizer=randomizer)
    env.reset(seed=3)
    assert env.minitaur._motor_model.get_voltage() == 12.0
    assert env._p.getDynamicsInfo(env.minitaur.quadruped, -1)[0] == env.minitaur.GetBaseMassFromURDF()
    env.close()


@pytest.mark.parametrize("kind", [MinitaurBulletEnv, MinitaurReactiveEnv, MinitaurStandGymEnv])
def test_scripts_may_go_on_without_a_reset(kind: Any) -> None:
    env = kind()
    shape = env.action_space.shape
    assert env.minitaur.quadruped > 0
    env.close()
    observation = env.step(np.zeros(shape))[0]
    assert observation in env.observation_space
    env.close()


@pytest.mark.parametrize("action", [np.zeros(7), np.full(8, np.nan), np.full(8, 1.02)])
def test_wrong_actions_are_refused(action: Any) -> None:
    env = MinitaurBulletEnv()
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"shape|finite|out of bounds"):
        env.step(action)
    env.close()


@pytest.mark.parametrize("told", [False, True])
def test_the_position_is_observed_if_it_is_asked_for(told: bool) -> None:
    env = MinitaurExtendedEnv(include_base_position=told, include_leg_model=False)
    observation, _ = env.reset(seed=1)
    assert observation.shape == env.observation_space.shape
    if told:
        assert tuple(observation[-3:]) == pytest.approx(env.minitaur.GetBasePosition())
    env.close()


def test_actions_are_left_as_they_are() -> None:
    env = MinitaurExtendedEnv()
    env.reset(seed=1)
    action = np.full(8, 0.5)
    _, reward, *_, found = env.step(action)
    assert np.array_equal(action, np.full(8, 0.5))
    assert found["base_reward"] == reward == pytest.approx(env.reward())
    env.close()


def test_an_episode_ends_with_a_fall_and_without_the_duck() -> None:
    env = MinitaurBulletDuckEnv(distance_limit=5.0)
    env.reset(seed=1)
    assert not env.step(np.zeros(8))[2]
    env._p.resetBasePositionAndOrientation(env._duckId, [1, 0, 0], [0.5, 0.5, 0.5, 0.5])
    assert env.step(np.zeros(8))[2]
    env.reset(seed=1)
    assert not env._termination()
    env._p.resetBasePositionAndOrientation(env.minitaur.quadruped, [0, 0, 0.3], [1, 0, 0, 0])
    assert env.is_fallen()
    env._p.resetBasePositionAndOrientation(env.minitaur.quadruped, [6, 0, 0.2], [0, 0, 0, 1])
    assert env._termination()
    assert len(env.get_objectives()) == 0
    env.close()


def test_an_episode_that_begins_where_another_ended_begins_the_same() -> None:
    env = MinitaurTrottingEnv()
    first, _ = env.reset(seed=1)
    body = env.minitaur.quadruped
    for _ in range(20):
        env.step(np.zeros(8))
    assert np.array_equal(env.reset(seed=1)[0], first)
    assert env.minitaur.quadruped == body
    env.close()


def test_the_trot_is_observed_if_wished() -> None:
    env = MinitaurTrottingEnv(use_signal_in_observation=True)
    observation, _ = env.reset(seed=1)
    assert observation.shape == (12,)
    # The left front leg and the right hind leg are stretched when the others are bent.
    assert observation[4:] == pytest.approx(2.0 + 0.35 * np.array((1, 1, -1, -1, -1, -1, 1, 1)))
    env.close()


def test_every_leg_of_the_one_that_steps_can_be_swung() -> None:
    env = MinitaurAlternatingLegsEnv()
    env.reset(seed=1)
    rest = env._transform_action_to_motor_command(np.zeros(8))
    swung = env._transform_action_to_motor_command(np.array((0.1, 0.1, 0.1, 0.1, 0, 0, 0, 0)))
    assert swung - rest == pytest.approx(0.1 * np.array((-1, 1, -1, 1, 1, -1, 1, -1)))
    env.set_swing_offset([0.05] * 4)
    env.set_extension_offset([0.02] * 4)
    bent = env._transform_action_to_motor_command(np.zeros(8))
    assert bent - rest == pytest.approx(0.02 + 0.05 * np.array((-1, 1, -1, 1, 1, -1, 1, -1)))
    env.set_desired_pitch(0.1)
    assert env._get_observation()[1] == pytest.approx(env.minitaur.GetBaseRollPitchYaw()[1] - 0.1)
    env.close()


class Pusher(EnvRandomizerBase):
    def __init__(self) -> None:
        self.called: list[Any] = []

    def randomize_env(self, env: Any) -> None:
        self.called.append("reset")

    def randomize_step(self, env: Any) -> None:
        self.called.append("step")

    def randomize_sub_step(self, env: Any, sub_step_index: int, num_sub_steps: int) -> None:
        self.called.append((sub_step_index, num_sub_steps))
        env.pybullet_client.applyExternalForce(
            env.minitaur.quadruped, -1, [0, 0, 60], [0, 0, 0], p.LINK_FRAME
        )


def test_randomizers_push_in_each_step_of_the_simulation() -> None:
    pusher = Pusher()
    env = MinitaurReactiveEnv(env_randomizer=pusher, action_repeat=3)
    env.reset(seed=1)
    before = env.minitaur.GetBasePosition()[2]
    for _ in range(20):
        env.step(np.zeros(8))
    assert pusher.called[:5] == ["reset", "step", (0, 3), (1, 3), (2, 3)]
    assert env.minitaur.GetBasePosition()[2] > before + 0.01
    env.close()


def test_copies_are_made_as_the_original_was() -> None:
    env = MinitaurExtendedEnv(history_length=2, include_base_position=True, motor_kp=0.9)
    again = copy.deepcopy(env)
    assert again.observation_space == env.observation_space
    assert again._robot["motor_kp"] == 0.9
    again.terminate()


def test_steps_can_be_made_longer() -> None:
    env = MinitaurGymEnv(accurate_motor_model_enabled=True)
    env.reset(seed=1)
    env.set_time_step(0.02, simulation_step=0.004)
    env.step(np.zeros(8))
    assert env.minitaur.GetTimeSinceReset() == pytest.approx(0.02)
    assert env._p.getPhysicsEngineParameters()["fixedTimeStep"] == 0.004
    with pytest.raises(ValueError, match="larger than or equal to simulation step"):
        env.set_time_step(0.0001)
    env.close()


def test_there_is_no_other_robot() -> None:
    with pytest.raises(ValueError, match="applejack is not a supported urdf_version"):
        MinitaurReactiveEnv(urdf_version="applejack")
