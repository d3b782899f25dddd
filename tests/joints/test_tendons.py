"""Tendons that users add to bodies: their springs and limits, actuators of them, many worlds."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.description.actuator import GeneralActuator
from carom.description.pose import Pose
from carom.description.sensors import TendonPosition
from carom.description.tendon import WORLD, PathPart, TendonSpec
from carom.errors import DescriptionError
from carom.layouts.codes import PathKind
from carom.worlds.worlds import Worlds

SITE, PULLEY = PathKind.SITE, PathKind.PULLEY
SLIDE = """<mujoco><option timestep=".001" gravity="0 0 0"/><worldbody><body name="b"><joint name="x"
 type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/><geom size=".1" mass="2"/></body>
</worldbody></mujoco>"""


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "slide.xml").write_text(SLIDE)
    with World() as world:
        scene = world.load(tmp_path / "slide.xml")
        scene.apply_options()
        yield scene


def rope(body, name="t", **terms):
    """From the point (-1, 0, 0) of the world to the body."""
    link = body.links["b"].index
    body.add_tendon(
        TendonSpec(name, (PathPart(SITE, WORLD, Pose((-1.0, 0.0, 0.0))), PathPart(SITE, link)), **terms)
    )
    return body.tendons[name]


def test_a_spring_pulls_a_mass_back_and_forth(scene):
    body = scene["b"]
    tendon = rope(body, stiffness=50.0)
    assert tendon.spring_range == (1.0, 1.0)
    body.set_joint_state(body.joints["x"].index, [0.2], [0.0])
    period = 2 * np.pi * np.sqrt(2 / 50)
    scene.world.step(round(period / 2 * 1000))
    assert_allclose(body.joints["x"].position, -0.2, rtol=0.02)
    # The spring is relaxed halfway, so its force is that of the end of the last step.
    assert_allclose(tendon.force, -50 * (tendon.length - 1.0), rtol=0.02)
    tendon.stiffness = 0.0
    scene.world.step()
    assert tendon.force == 0.0


def test_a_spring_is_slack_within_its_range(scene):
    body = scene["b"]
    rope(body, stiffness=50.0, spring_range=(0.5, 1.5))
    body.set_joint_state(body.joints["x"].index, [0.3], [0.5])
    scene.world.step(100)
    assert_allclose(body.joints["x"].velocity, 0.5, atol=1e-12)
    scene.world.step(600)
    assert body.joints["x"].velocity < 0.4


def test_a_damper_takes_a_share_of_the_velocity_in_each_step(scene):
    body = scene["b"]
    scene.world.integrator = "discrete"
    rope(body, damping=4.0)
    body.set_joint_state(body.joints["x"].index, [0.0], [1.0])
    scene.world.step(100)
    assert_allclose(body.joints["x"].velocity, (1 + 0.001 * 4 / 2) ** -100, rtol=1e-9)


def test_an_actuator_and_a_sensor_of_a_tendon(scene):
    body = scene["b"]
    tendon = rope(body)
    body.add_actuator("m", GeneralActuator(tendon="t", gain=(3.0, 0.0, 0.0), gear=2.0))
    body.add_sensor("s", TendonPosition("t"))
    body.actuators["m"].control = -0.5
    scene.world.step(10)
    assert_allclose(body.actuators["m"].force, -1.5)
    assert_allclose(body.joints["x"].velocity, -1.5 * 2 / 2 * 0.01, rtol=1e-9)
    assert_allclose(body.actuators["m"].length, 2 * tendon.length)
    assert_allclose(body.sensors["s"].read(), [tendon.length])
    assert "tendon 't'" in repr(body.actuators["m"])


def test_worlds_differ_in_controls_and_gains(scene):
    body = scene["b"]
    rope(body)
    body.add_actuator("m", GeneralActuator(tendon="t"))
    worlds = Worlds(scene.world, 3)
    batch = worlds.bodies["b"]
    batch.actuators.controls[:] = np.array([[0.0], [1.0], [2.0]])
    batch.actuators["m"].change(gear=[1.0, 1.0, -1.0])
    worlds.step(10)
    assert_allclose(batch.actuators.forces[:, 0], [0.0, 1.0, 2.0])
    assert_allclose(batch.joints.velocities[:, 0], [0.0, 0.005, -0.01], rtol=1e-9)


def test_a_body_with_tendons_is_removed(scene):
    rope(scene["b"], stiffness=5.0)
    scene["b"].add_actuator("m", GeneralActuator(tendon="t"))
    scene.world.remove(scene["b"].id)
    scene.world.step()
    assert not scene.world.user_constraints.all


@pytest.mark.parametrize(
    ("path", "problem"),
    [
        ((), "empty"),
        ((PathPart(SITE, 1),), "two sites"),
        ((PathPart(PathKind.JOINT, -1, size=1.0),), "no revolute or prismatic"),
        ((PathPart(SITE, 9), PathPart(SITE, 1)), "no link 9"),
        ((PathPart(PULLEY, size=0.0), PathPart(SITE, 0), PathPart(SITE, 1)), "greater than 0"),
    ],
)
def test_paths_that_have_no_meaning_are_refused(scene, path, problem):
    with pytest.raises(DescriptionError, match=problem):
        scene["b"].add_tendon(TendonSpec("t", path))
    rope(scene["b"])
    with pytest.raises(DescriptionError, match="name of its own"):
        rope(scene["b"])
    with pytest.raises(DescriptionError, match="no tendon 'no'"):
        scene["b"].add_actuator("m", GeneralActuator(tendon="no"))


@pytest.mark.parametrize("start", [-4.0, 4.0])
def test_a_path_that_points_at_a_ball_but_ends_before_it_is_straight(scene, start):
    body = scene["b"]
    ball = PathPart(PathKind.SPHERE, WORLD, Pose((start / 4.0, 0.5, 0.0)), size=0.6)
    ends = [PathPart(SITE, WORLD, Pose((x, 0.0, 0.0))) for x in (start, start / 2.0)]
    path = (ends[0], ball, ends[1], PathPart(SITE, body.links["b"].index))
    body.add_tendon(TendonSpec("straight", path, stiffness=50.0, spring_range=(4.0, 4.0)))
    assert_allclose(body.tendons["straight"].length, 4.0, rtol=1e-12)
    scene.world.step(3)
    assert_allclose(body.tendons["straight"].force, 0.0, atol=1e-9)
    assert_allclose(body.joints["x"].velocity, 0.0, atol=1e-12)


def test_tendons_of_many_worlds_have_the_lengths_and_forces_of_each(scene):
    body = scene["b"]
    tendon = rope(body, stiffness=50.0, damping=2.0, range=(0.0, 1.25))
    worlds = Worlds(scene.world, 3)
    worlds[body].joints["x"].reset([0.1, -0.2, 0.251], [0.0, 0.5, 2.0])
    many = worlds[body].tendons["t"]
    many.enable(False, where=[1])
    worlds.step()
    assert_allclose(many.length, 1.0 + worlds[body].joints["x"].position, rtol=1e-12)
    assert_allclose(many.velocity, worlds[body].joints["x"].velocity, rtol=1e-12)
    assert (many.stiffness, many.range) == (tendon.stiffness, tendon.range)
    assert many.force[1] == many.limit_force[1] == many.limit_force[0] == 0.0
    assert many.limit_force[2] > 0.0
    for number in (0, 1, 2):
        lone = worlds.extract(number)["b"].tendons["t"]
        assert lone.enabled == (number != 1)
        assert (many.length[number], many.velocity[number]) == (lone.length, lone.velocity)
        assert (many.force[number], many.limit_force[number]) == (lone.force, lone.limit_force)


@pytest.mark.parametrize("side", [0.15, -0.15])
def test_the_side_of_a_wrap_is_where_the_file_says_wherever_the_mass_is(side: float) -> None:
    lengths = []
    for more in ("", '<geom type="box" size=".1 .1 .1" pos=".7 -.9 .4" mass="40"/>'):
        world = World()
        world.load(f"""<mujoco><worldbody>
            <site name="a" pos="-1 0 .02"/><site name="b" pos="1 0 .02"/>
            <body name="wheel"><joint name="j"/>{more}
              <geom name="round" type="cylinder" size=".1 .1" euler="90 0 0"/>
              <site name="side" pos="0 0 {side}"/></body></worldbody>
          <tendon><spatial name="t"><site site="a"/><geom geom="round" sidesite="side"/><site site="b"/>
          </spatial></tendon></mujoco>""")
        lengths.append(float(world["wheel"].tendons["t"].length))
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-12)
    assert lengths[0] > 2.0
