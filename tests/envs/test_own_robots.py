"""Scripts make environments of their own from the bases of PyBullet's."""

from __future__ import annotations

import os
from typing import Any, ClassVar

import numpy as np
import pytest

import pybullet
import pybullet_data
from pybullet_envs.env_bases import MJCFBaseBulletEnv
from pybullet_envs.gym_locomotion_envs import AntBulletEnv, WalkerBaseBulletEnv
from pybullet_envs.robot_bases import BodyPart, Joint, MJCFBasedRobot, URDFBasedRobot
from pybullet_envs.robot_locomotors import WalkerBase
from pybullet_envs.scene_abstract import SingleRobotEmptyScene


class OwnAnt(WalkerBase):
    foot_list: ClassVar[list[str]] = [
        "front_left_foot",
        "front_right_foot",
        "left_back_foot",
        "right_back_foot",
    ]

    def __init__(self) -> None:
        file = os.path.join(pybullet_data.getDataPath(), "mjcf", "ant.xml")
        WalkerBase.__init__(self, file, "torso", action_dim=8, obs_dim=28, power=2.5)

    def alive_bonus(self, z: float, pitch: float) -> float:
        return +1 if z > 0.26 else -1


class OwnAntEnv(WalkerBaseBulletEnv):
    def __init__(self, render: bool = False) -> None:
        self.robot = OwnAnt()
        WalkerBaseBulletEnv.__init__(self, self.robot, render)


class Cart(URDFBasedRobot):
    def __init__(self) -> None:
        URDFBasedRobot.__init__(self, "cartpole.urdf", "cart", action_dim=1, obs_dim=2, fixed_base=True)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        self.jdict["slider_to_cart"].reset_current_position(0.5, 0)

    def apply_action(self, a: np.ndarray) -> None:
        self.jdict["slider_to_cart"].set_motor_torque(10.0 * float(a[0]))

    def calc_state(self) -> np.ndarray:
        return np.array(self.jdict["slider_to_cart"].get_state())

    def calc_potential(self) -> float:
        return -abs(self.jdict["slider_to_cart"].get_position())


class CartEnv(MJCFBaseBulletEnv):
    def __init__(self, render: bool = False) -> None:
        self.robot = Cart()
        MJCFBaseBulletEnv.__init__(self, self.robot, render)

    def create_single_player_scene(self, bullet_client: Any) -> SingleRobotEmptyScene:
        return SingleRobotEmptyScene(bullet_client, gravity=9.8, timestep=0.0165, frame_skip=1)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        self.robot.apply_action(action)
        self.scene.global_step()
        state = self.robot.calc_state()
        before, self.potential = self.potential, self.robot.calc_potential()
        self.rewards = [self.potential - before]
        return state, sum(self.rewards), False, False, {}


def test_an_ant_of_ones_own_runs_as_the_ant_does() -> None:
    own, ant = OwnAntEnv(), AntBulletEnv()
    assert np.array_equal(own.reset(seed=5)[0], ant.reset(seed=5)[0])
    for step in range(20):
        action = np.sin(0.3 * step + np.arange(8))
        first, second = own.step(action), ant.step(action)
        assert np.array_equal(first[0], second[0])
        assert first[1] == second[1]
    own.close()
    ant.close()


def test_what_scripts_read_of_a_robot() -> None:
    env: Any = AntBulletEnv()
    env.reset(seed=1)
    robot = env.unwrapped.robot
    assert list(robot.jdict) == [f"{part}_{n}" for n in range(1, 5) for part in ("hip", "ankle")]
    assert [joint.joint_name for joint in robot.ordered_joints] == list(robot.jdict)
    assert {joint.power_coef for joint in robot.ordered_joints} == {100.0}
    assert pybullet.isConnected(env.physicsClientId)
    assert not env.isRender
    assert robot.parts["torso"] is robot.robot_body
    assert robot.robot_body.pose().xyz() == pytest.approx(robot.body_real_xyz)
    assert robot.robot_body.pose().rpy() == pytest.approx(robot.body_rpy)
    assert robot.robot_body.initialPosition == pytest.approx((0.0, 0.0, 0.75))
    assert set(robot.foot_list) <= set(robot.parts)
    assert "floor" in env.parts
    robot.reset_pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    assert robot.robot_body.get_position() == pytest.approx((1.0, 2.0, 3.0))
    robot.robot_body.reset_velocity(linearVelocity=[0.5, 0.0, 0.0])
    assert robot.robot_body.speed() == pytest.approx((0.5, 0.0, 0.0))
    env.close()
    assert env.physicsClientId == -1


def test_actions_of_the_wrong_length_are_refused() -> None:
    env = AntBulletEnv()
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"the action has shape \(1,\), not \(8,\)"):
        env.step(np.ones(1))
    env.close()


def test_joints_of_several_bodies_are_told_apart() -> None:
    env = CartEnv()
    env.reset(seed=1)
    robot = env.robot
    second = env._p.loadURDF(
        os.path.join(pybullet_data.getDataPath(), "cartpole.urdf"), [0, 2, 0], useFixedBase=True
    )
    joint = Joint(env._p, "other", [second], 0, 0)
    joint.reset_position(-1.0, 0.0)
    robot.ordered_joints.append(joint)
    relative = robot.relative_joint_states()
    expected = [each.current_relative_position() for each in robot.ordered_joints]
    assert relative == pytest.approx(np.array(expected))
    robot.set_motor_torques(robot.ordered_joints, np.array([0.0, 0.0, 20.0]))
    env.scene.global_step()
    assert joint.get_velocity() > 0.0
    env.close()


def test_a_cart_of_a_urdf_file_in_a_scene_of_its_own() -> None:
    env = CartEnv()
    state, _ = env.reset(seed=1)
    assert state == pytest.approx((0.5, 0.0))
    rewards = [float(env.step(np.array([-1.0]))[1]) for _ in range(10)]
    assert sum(rewards) > 0.0
    env.close()
    assert env.reset(seed=1)[0] == pytest.approx((0.5, 0.0))
    env.close()


def test_joints_are_driven_by_position_and_velocity() -> None:
    env = CartEnv()
    env.reset(seed=1)
    slider = env.robot.jdict["slider_to_cart"]
    slider.set_velocity(0.25)
    env.scene.global_step()
    assert slider.get_velocity() == pytest.approx(0.25, abs=0.02)
    slider.set_position(0.0)
    for _ in range(200):
        env.scene.global_step()
    assert slider.get_position() == pytest.approx(0.0, abs=0.05)
    env.close()


def test_what_a_robot_lacks_is_named() -> None:
    class Bare(MJCFBasedRobot):
        def __init__(self) -> None:
            MJCFBasedRobot.__init__(self, "ant.xml", "torso", 1, 1)

    env = MJCFBaseBulletEnv(Bare())
    with pytest.raises(NotImplementedError, match="MJCFBaseBulletEnv has no create_single_player_scene"):
        env.reset()
    with pytest.raises(NotImplementedError, match="Bare has no robot_specific_reset"):
        env.robot.robot_specific_reset(None)


def test_things_that_scripts_add_are_parts_too() -> None:
    env: Any = AntBulletEnv()
    env.reset(seed=1)
    cube = env._p.loadURDF(os.path.join(pybullet_data.getDataPath(), "cube_small.urdf"), [3, 0, 0.1])
    part = BodyPart(env._p, "cube", [cube], 0, -1)
    part.reset_position([4.0, 0.0, 0.1])
    assert part.current_position() == pytest.approx((4.0, 0.0, 0.1))
    part.reset_orientation([0.0, 0.0, 1.0, 0.0])
    assert part.current_orientation() == pytest.approx((0.0, 0.0, 1.0, 0.0))
    assert not part.contact_list()
    env.close()
