"""Environments whose actions and observations are the actuators and sensors of a robot file."""

from functools import partial
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from numpy.testing import assert_allclose

from carom import World
from carom.vector import SceneEnv, SingleEnv
from carom.world.scene import Scene

FILE = """<mujoco><worldbody>
  <body name="arm" pos="0 0 1">
    <joint name="shoulder" axis="0 1 0" range="-60 90"/><geom size=".1" pos=".2 0 0"/>
    <body name="hand" pos=".3 0 0"><joint name="wrist" axis="0 1 0"/><geom size=".05" pos=".1 0 0"/>
      <site name="tip" pos=".2 0 0"/></body>
  </body>
  <body name="box" pos="2 0 1"><freejoint/><geom size=".1"/></body>
</worldbody>
<actuator>
  <motor name="second" joint="wrist" ctrlrange="-2 3"/>
  <position name="first" joint="shoulder" kp="5" gear="2"/>
</actuator>
<sensor>
  <framepos name="place" objtype="site" objname="tip"/>
  <jointpos name="angle" joint="wrist"/>
</sensor>
<keyframe><key name="up" qpos=".5 -.2 2 0 3 1 0 0 0" ctrl="1 .4"/></keyframe></mujoco>"""


class Reach(SceneEnv):
    """The higher the tip, the better."""

    def reward(self, actions: np.ndarray) -> np.ndarray:
        return self.observe()[:, self.observed["place"]][:, 2]


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    (tmp_path / "file.xml").write_text(FILE)
    return World().load(tmp_path / "file.xml")


def test_spaces_are_those_of_the_actuators_and_sensors_of_the_file(scene: Scene):
    env = Reach(scene, 3)
    third = np.pi / 3.0
    assert isinstance(env.single_action_space, gymnasium.spaces.Box)
    assert_allclose(env.single_action_space.low, [-2.0, -2.0 * third], rtol=1e-6)
    assert_allclose(env.single_action_space.high, [3.0, 3.0 * third], rtol=1e-6)
    assert list(env.observed) == [
        "arm/position", "arm/velocity", "box/position", "box/velocity", "place", "angle"
    ]  # fmt: skip
    assert env.single_observation_space.shape == (2 + 2 + 7 + 6 + 3 + 1,)
    env.close()


def test_an_episode_begins_in_the_keyframe_and_controls_act_in_the_order_of_the_file(scene: Scene):
    env = Reach(scene, 3, keyframe="up", steps=2)
    observations, _ = env.reset(seed=1)
    assert_allclose(observations[:, env.observed["arm/position"]], [[0.5, -0.2]] * 3, rtol=1e-6)
    assert_allclose(observations[:, env.observed["box/position"]], [[2, 0, 3, 0, 0, 0, 1]] * 3)
    actions = np.array([[1.0, 0.2], [9.0, -0.3], [0.0, 0.0]])
    observations, rewards, *_ = env.step(actions)
    scene.reset("up")
    scene.actuators["second"].control, scene.actuators["first"].control = 3.0, -0.3
    scene.world.step(2)
    assert_allclose(
        observations[1, env.observed["arm/position"]], scene["arm"].joints.positions, rtol=1e-6, atol=1e-6
    )
    assert_allclose(
        observations[1, env.observed["place"]], scene.sensors["place"].read(), rtol=1e-6, atol=1e-6
    )
    assert_allclose(
        observations[1, env.observed["angle"]], scene["arm"].joints["wrist"].position, rtol=1e-6, atol=1e-6
    )
    box = [*scene["box"].links[-1].velocity.linear, *scene["box"].links[-1].velocity.angular]
    assert_allclose(observations[1, env.observed["box/velocity"]], box, rtol=1e-6, atol=1e-6)
    assert_allclose(rewards, observations[:, env.observed["place"]][:, 2])
    env.close()


def test_what_is_observed_can_be_chosen(scene: Scene):
    env = Reach(scene, 2, state=False, sensors=["place"])
    observations, _ = env.reset()
    assert observations.shape == (2, 3)
    assert_allclose(observations[0], scene.sensors["place"].read(), rtol=1e-6)
    env.close()
    with pytest.raises(ValueError, match="nothing to observe"):
        Reach(scene, state=False, sensors=[])
    with pytest.raises(KeyError, match="no sensor 'no'; it has place, angle"):
        Reach(scene, sensors=["no"])
    with pytest.raises(KeyError, match="no keyframe 'no'"):
        Reach(scene, keyframe="no")


def test_a_file_without_actuators_is_refused(tmp_path: Path):
    (tmp_path / "file.xml").write_text(
        '<mujoco><worldbody><body><geom size=".1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(ValueError, match="no actuators to act on"):
        Reach(World().load(tmp_path / "file.xml"))


@pytest.mark.filterwarnings("ignore")
def test_gymnasium_accepts_it(scene: Scene):
    check_env(SingleEnv(partial(Reach, scene, keyframe="up", max_episode_steps=20)), skip_render_check=True)
