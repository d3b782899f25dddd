"""World, Body, Joint and Link as new code uses them."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import carom
from carom import World
from carom.checks import not_negative
from carom.description import JointType
from carom.errors import DescriptionError

# The solver stops when no row changes its velocity by more than 3e-4 in a sweep; about this much is left.
SOLVED = 1e-3

ROBOT = """<robot name="robot">
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  {links}
  {joints}
</robot>"""
LINK = """<link name="{name}">
  <inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="{across}" ixy="0" ixz="0" iyy="{across}" iyz="0" izz="{along}"/></inertial>
  <collision><origin xyz="0 0 -0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision>
</link>"""
JOINT = """<joint name="{name}" type="{type}">
  <parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/><axis xyz="0 1 0"/>
  <limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="5"/>
</joint>"""


def robot(tmp_path: Path, *joints: dict) -> Path:
    """A chain of 1 m rods hanging down, one for each joint."""
    parents = ["base", *(joint["name"] + "_rod" for joint in joints)]
    texts = []
    for parent, joint in zip(parents, joints, strict=False):
        defaults = {"type": "revolute", "lower": -3, "upper": 3, "effort": 60, "at": "0 0 0"}
        texts.append(JOINT.format(**{"parent": parent, "child": joint["name"] + "_rod", **defaults, **joint}))
    links = "".join(
        LINK.format(name=joint["name"] + "_rod", across=2 * 1.01 / 12, along=2 * 0.02 / 12)
        for joint in joints
    )
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT.format(links=links, joints="".join(texts)))
    return path


SHOULDER = {"name": "shoulder"}
ELBOW = {"name": "elbow", "at": "0 0 -1"}
SLIDE = {"name": "slide", "type": "prismatic", "effort": 0, "at": "0 0 -1"}
WELD = {"name": "weld", "type": "fixed", "at": "0 0 -1"}
BALL = {"name": "ball", "type": "spherical", "at": "0 0 -1"}


@pytest.fixture
def world():
    with World() as world:
        world.gravity = (0.0, 0.0, -9.81)
        yield world


@pytest.fixture
def load(world, tmp_path):
    def load(*joints: dict):
        apart = (10.0 * len(world.bodies), 0.0, 0.0)
        return world.load_urdf(robot(tmp_path, *joints), apart, fixed_base=True)

    return load


def test_the_package_offers_its_names_lazily_and_no_others():
    assert {"World", "Body", "Joint", "Link", "control"} <= set(dir(carom))
    assert carom.Joint.__module__ == "carom.scene.joint"
    assert carom.control.PID
    with pytest.raises(AttributeError, match="Wrold"):
        getattr(carom, "Wrold")  # noqa: B009


def test_numbers_that_may_be_zero_are_not_negative():
    for value in (0.0, [0.0, 2.0], float("inf")):
        assert not_negative(value, "damping").tolist() == value
    for value in (-1e-300, [1.0, -1.0], float("nan")):
        with pytest.raises(ValueError, match="damping must be >= 0, not"):
            not_negative(value, "damping")


def test_joints_are_found_by_name_and_by_index(load):
    body = load(SHOULDER, WELD, ELBOW)
    joints = body.joints
    assert joints["elbow"] is joints[2]
    assert [joint.name for joint in joints] == joints.names == ["shoulder", "weld", "elbow"]
    assert [joint.name for joint in joints.movable] == ["shoulder", "elbow"]
    assert len(joints) == 3
    assert "elbow" in joints
    assert "knee" not in joints
    with pytest.raises(KeyError, match=r"knee.*shoulder, weld, elbow"):
        joints["knee"]
    assert joints[-1] is joints[2]
    for index in (-4, 3):
        with pytest.raises(IndexError, match="0 to 2"):
            joints[index]


def test_links_and_joints_know_each_other(load):
    body = load(SHOULDER, ELBOW)
    elbow = body.joints["elbow"]
    assert elbow.child is body.links["elbow_rod"] is body.links[1]
    assert elbow.parent is body.joints["shoulder"].child
    assert elbow.child.joint is elbow
    assert elbow.child.parent is elbow.parent
    assert body.joints[0].parent is body.links.base is body.links[-1] is body.links["base"]
    assert body.links.base.joint is None
    assert body.links.base.parent is None
    assert len(body.links) == 3


def test_a_joint_tells_what_the_file_says(load):
    joint = load(SHOULDER).joints[0]
    assert joint.type is JointType.REVOLUTE
    assert joint.axis == (0.0, 1.0, 0.0)
    assert joint.limits == (-3.0, 3.0)
    assert joint.effort_limit == 60.0
    assert joint.degrees_of_freedom == 1
    assert "shoulder" in repr(joint)


def test_limits_are_those_enforced_now(load):
    body = load({**SHOULDER, "type": "continuous"}, {**ELBOW, "lower": 1, "upper": -1})
    assert body.joints[0].limits == body.joints[1].limits == (-math.inf, math.inf)
    body.change_dynamics(1, joint_lower_limit=-0.5, joint_upper_limit=0.25)
    assert body.joints[1].limits == (-0.5, 0.25)


def test_position_target_is_reached_and_held_and_clipped_to_the_limits(world, load):
    joint = load(SHOULDER).joints["shoulder"]
    joint.set_position_target(1.0)
    world.step(240)
    assert joint.position == pytest.approx(1.0, abs=1e-6)
    assert joint.velocity == pytest.approx(0.0, abs=1e-6)
    assert joint.motor_torque == pytest.approx(2 * 9.81 * 0.5 * math.sin(1.0), rel=1e-4)
    joint.set_position_target(7.0, max_force=math.inf)
    world.step(240)
    assert joint.position == pytest.approx(3.0, abs=1e-6)


def test_velocity_target_is_kept_and_its_bounds_respected(world, load):
    joint = load(SHOULDER).joints["shoulder"]
    joint.set_velocity_target(0.5)
    world.step(100)
    assert joint.velocity == pytest.approx(0.5)
    joint.set_velocity_target(100.0, max_force=1.0)
    world.step()
    assert joint.motor_torque == pytest.approx(1.0)
    joint.set_position_target(2.0, max_force=1e6, max_velocity=0.25)
    world.step(2)
    assert joint.velocity == pytest.approx(0.25)


def test_motors_are_bounded_by_the_effort_of_the_file(world, load):
    body = load({**SHOULDER, "effort": 3})
    body.joints[0].set_position_target(2.0)
    world.step(3)
    assert body.joints[0].motor_torque == pytest.approx(3.0)


def test_a_motor_force_means_the_same_in_every_substep(world, load):
    joint = load(SHOULDER).joints[0]
    world.parameters.substeps = 4
    world.apply_parameters()
    joint.set_velocity_target(10.0, max_force=2.0)
    world.step()
    assert joint.motor_torque == pytest.approx(2.0)


def test_torque_acts_for_one_step_beside_a_motor_that_is_off(world, load):
    joint = load(SHOULDER).joints["shoulder"]
    joint.free()
    inertia = 2 * (0.1**2 + 1.0**2) / 12 + 2 * 0.5**2
    joint.set_torque(5.0)
    joint.set_torque(3.0)
    world.step()
    assert joint.velocity == pytest.approx(3.0 / inertia / 240, rel=1e-9)
    before = joint.velocity
    world.step()
    assert abs(joint.velocity - before) < 1e-3


def test_a_spring_holds_the_joint_where_it_balances_gravity(world, load):
    joint = load(SHOULDER).joints["shoulder"]
    joint.free()
    joint.set_spring(1.0, stiffness=60.0, damping=10.0)
    world.step(1200)
    assert 60 * (1 - joint.position) == pytest.approx(9.81 * math.sin(joint.position), rel=1e-6)
    joint.free()
    world.step(240)
    assert abs(joint.position) < 0.8


def test_reset_places_a_joint_and_its_links_at_once(world, load):
    body = load(SHOULDER, ELBOW)
    body.joints["shoulder"].reset(math.pi / 2, velocity=2.0)
    assert body.joints["shoulder"].position == math.pi / 2
    assert_allclose(body.links["elbow_rod"].pose.position, [-1.0, 0.0, 0.0], atol=1e-12)
    assert_allclose(body.links["shoulder_rod"].velocity.linear, [0.0, 0.0, 1.0], atol=1e-12)
    assert_allclose(body.links["shoulder_rod"].velocity.angular, [0.0, 2.0, 0.0], atol=1e-12)


def test_a_body_without_joints_has_empty_arrays(world, load):
    joints = load().joints
    lower, upper = joints.limits
    assert lower.shape == upper.shape == joints.positions.shape == (0,)
    joints.set_position_targets([])
    joints.reset([])


def test_no_joint_is_reset_if_one_cannot_be(world, load):
    joints = load(SHOULDER, BALL).joints
    joints.reset([0.2, 0.0, 0.0, 0.0, 1.0])
    with pytest.raises(ValueError, match="quaternion"):
        joints.reset([0.5, 0.0, 0.0, 0.0, 0.0])
    assert joints.positions[0] == 0.2


def test_text_is_no_parameter_of_dynamics(world, load):
    body = load(SHOULDER)
    for changes in ({"lateral_friction": "0.5"}, {"inertia": ("1", 1.0, 1.0)}):
        with pytest.raises((TypeError, ValueError)):
            body.change_dynamics(0, **changes)
    assert body.dynamics(0).lateral_friction == 0.5


def test_arrays_speak_for_all_movable_joints(world, load):
    joints = load(SHOULDER, WELD, ELBOW).joints
    joints.reset([0.2, -0.3], [0.5, 0.0])
    assert_allclose(joints.positions, [0.2, -0.3])
    assert_allclose(joints.velocities, [0.5, 0.0])
    assert_allclose(joints.limits, [[-3.0, -3.0], [3.0, 3.0]])
    assert_allclose(joints.effort_limits, [60.0, 60.0])
    joints.set_position_targets([0.4, -0.6], max_forces=500.0)
    world.step(300)
    assert_allclose(joints.positions, [0.4, -0.6], atol=SOLVED)
    assert_allclose(joints.motor_torques, [joint.motor_torque for joint in joints.movable])
    joints.set_velocity_targets([0.1, 0.2], max_forces=500.0)
    world.step(5)
    assert_allclose(joints.velocities, [0.1, 0.2], atol=SOLVED)


def test_arrays_and_single_joints_command_alike(world, load, tmp_path):
    first, second = load(SHOULDER, ELBOW), load(SHOULDER, ELBOW)
    first.joints.set_position_targets([0.5, 1.0], gains=0.05, velocities=0.1, max_velocities=[1.0, 2.0])
    for joint, target, most in zip(second.joints, (0.5, 1.0), (1.0, 2.0), strict=True):
        joint.set_position_target(target, gain=0.05, velocity=0.1, max_velocity=most)
    world.step(50)
    assert_allclose(first.joints.positions, second.joints.positions, rtol=0, atol=1e-12)
    first.joints.free()
    first.joints.set_torques([1.0, -2.0])
    for joint, torque in zip(second.joints, (1.0, -2.0), strict=True):
        joint.free()
        joint.set_torque(torque)
    world.step()
    assert_allclose(first.joints.velocities, second.joints.velocities, rtol=0, atol=1e-12)


def test_a_prismatic_joint_without_effort_in_the_file_is_as_strong_as_needed(world, load):
    joint = load(SLIDE).joints["slide"]
    assert joint.effort_limit == math.inf
    joint.set_position_target(0.5)
    world.step(240)
    assert joint.position == pytest.approx(0.5, abs=1e-6)


def test_a_fixed_joint_has_no_coordinates_and_takes_no_target(load):
    joint = load(WELD).joints["weld"]
    assert joint.coordinates.shape == joint.rates.shape == (0,)
    for use in (lambda: joint.position, lambda: joint.velocity, lambda: joint.set_velocity_target(1.0)):
        with pytest.raises(ValueError, match=r"'weld' is fixed: it has 0 degrees"):
            use()


def test_a_spherical_joint_turns_to_an_orientation(world, load):
    body = load(BALL)
    ball = body.joints["ball"]
    assert ball.coordinates.tolist() == [0.0, 0.0, 0.0, 1.0]
    assert ball.rates.shape == (3,)
    target = np.array([0.0, math.sin(0.3), 0.0, math.cos(0.3)])
    ball.set_orientation_target(3 * target, gain=0.5, max_force=1e4)
    world.step(480)
    assert_allclose(ball.coordinates, target, atol=1e-3)
    ball.reset([0.0, 0.0, 2.0, 0.0])
    assert_allclose(ball.coordinates, [0.0, 0.0, 1.0, 0.0])
    with pytest.raises(ValueError, match="3 degrees of freedom"):
        body.joints.set_position_targets([0.0, 0.0, 0.0])


def test_the_sensor_feels_the_weight_it_carries(world, load):
    body = load(SHOULDER)
    joint = body.joints["shoulder"]
    joint.enable_sensor()
    world.step(5)
    assert np.linalg.norm(joint.reaction[:3]) == pytest.approx(2 * 9.81, rel=1e-3)
    joint.enable_sensor(False)
    world.step()
    assert not joint.reaction.any()


def test_link_frames_are_told_apart(world, load):
    rod = load(SHOULDER).links["shoulder_rod"]
    rod.body.joints[0].reset(math.pi / 2)
    assert_allclose(rod.pose.position, [0.0, 0.0, 0.0], atol=1e-12)
    assert_allclose(rod.inertial_pose.position, [-0.5, 0.0, 0.0], atol=1e-12)
    assert_allclose(rod.pose.orientation, [0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)], atol=1e-12)
    assert rod.mass == 2.0
    assert_allclose(rod.inertia, [2 * 1.01 / 12, 2 * 1.01 / 12, 2 * 0.02 / 12])


@pytest.mark.parametrize("frame", ["world", "link"])
def test_a_force_at_a_point_turns_the_joint_by_its_moment(world, load, frame):
    world.gravity = (0.0, 0.0, 0.0)
    body = load(SHOULDER)
    joint, rod = body.joints[0], body.links[0]
    joint.free()
    joint.reset(math.pi / 2)
    # At the tip, 1 m from the axis, across the rod: -z in the world is +x in the link frame there.
    if frame == "world":
        rod.apply_force([0.0, 0.0, -3.0], [-1.0, 0.0, 0.0])
    else:
        rod.apply_force([3.0, 0.0, 0.0], [0.0, 0.0, -1.0], frame="link")
    world.step()
    inertia = 2 * 1.01 / 12 + 2 * 0.5**2
    assert joint.velocity == pytest.approx(-3.0 / inertia / 240, rel=1e-9)
    world.step()
    assert joint.velocity == pytest.approx(-3.0 / inertia / 240, rel=1e-3)


def test_forces_and_torques_on_a_link_add_up(world, load):
    world.gravity = (0.0, 0.0, 0.0)
    body = load(SHOULDER)
    joint, rod = body.joints[0], body.links[0]
    joint.free()
    rod.apply_force([2.0, 0.0, 0.0])
    rod.apply_torque([0.0, 5.0, 0.0])
    rod.apply_torque([0.0, -1.0, 0.0], frame="link")
    world.step()
    inertia = 2 * 1.01 / 12 + 2 * 0.5**2
    assert joint.velocity == pytest.approx((4.0 - 0.5 * 2.0) / inertia / 240, rel=1e-9)


def test_handles_stay_valid_while_other_bodies_come_and_go(world, load):
    first = load(SHOULDER)
    others = [load(SHOULDER, ELBOW) for _ in range(5)]
    joint = others[-1].joints["elbow"]
    joint.reset(0.7)
    world.remove(first.id)
    assert joint.position == 0.7
    joint.set_velocity_target(0.3, max_force=1e4)
    world.step(3)
    assert joint.velocity == pytest.approx(0.3, abs=SOLVED)
    assert_allclose(others[0].joints.positions, 0.0, atol=1e-2)


@pytest.mark.parametrize("end", ["remove", "reset", "leave"])
def test_handles_of_a_body_that_is_gone_say_so(world, load, end):
    body = load(SHOULDER)
    joint, link = body.joints[0], body.links[0]
    if end == "remove":
        world.remove(body.id)
        load(ELBOW)
    elif end == "reset":
        world.clear()
    else:
        world.__exit__(None, None, None)
    uses = [
        lambda: joint.position,
        lambda: joint.reset(1.0),
        lambda: joint.set_position_target(1.0),
        lambda: joint.set_torque(1.0),
        joint.enable_sensor,
        lambda: joint.reaction,
        lambda: body.joints.positions,
        lambda: body.joints.set_velocity_targets(1.0),
        lambda: link.pose,
        lambda: link.velocity,
        lambda: link.apply_force([1.0, 0.0, 0.0]),
        lambda: link.apply_torque([1.0, 0.0, 0.0]),
    ]
    for use in uses:
        with pytest.raises(ValueError, match="no longer in its world"):
            use()


@pytest.mark.parametrize(
    "command",
    [
        lambda joint, bad: joint.set_position_target(bad),
        lambda joint, bad: joint.set_position_target(0.0, gain=bad),
        lambda joint, bad: joint.set_position_target(0.0, velocity=bad),
        lambda joint, bad: joint.set_position_target(0.0, max_force=bad),
        lambda joint, bad: joint.set_velocity_target(bad),
        lambda joint, bad: joint.set_velocity_target(0.0, max_force=bad),
        lambda joint, bad: joint.set_spring(bad, stiffness=1.0, damping=0.0),
        lambda joint, bad: joint.set_spring(0.0, stiffness=bad, damping=0.0),
        lambda joint, bad: joint.set_torque(bad),
        lambda joint, bad: joint.reset(bad),
        lambda joint, bad: joint.reset(0.0, bad),
        lambda joint, bad: joint.child.apply_force([bad, 0.0, 0.0]),
        lambda joint, bad: joint.child.apply_force([1.0, 0.0, 0.0], [bad, 0.0, 0.0]),
        lambda joint, bad: joint.child.apply_torque([bad, 0.0, 0.0]),
    ],
)
def test_nan_is_refused_and_changes_nothing(world, load, command):
    body = load(SHOULDER)
    arrays = ("position", "velocity", "motor", "pd", "joint_torque", "link_force")
    before = [getattr(world, name).copy() for name in arrays]
    with pytest.raises(ValueError, match=r"must be"):
        command(body.joints[0], math.nan)
    for name, array in zip(arrays, before, strict=True):
        assert_allclose(getattr(world, name), array)


def test_wrong_shapes_and_frames_are_refused(load):
    body = load(SHOULDER, ELBOW)
    with pytest.raises(ValueError, match="shape"):
        body.joints.reset([0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="one number or 2"):
        body.joints.set_position_targets([0.0, 0.0], gains=[1.0, 1.0, 1.0])
    with pytest.raises(ValueError, match=r"force must have shape \(3,\)"):
        body.links[0].apply_force([1.0, 0.0])
    with pytest.raises(ValueError, match="frame must be"):
        body.links[0].apply_force([1.0, 0.0, 0.0], frame="body")  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match="not spherical"):
        body.joints[0].set_orientation_target([0.0, 0.0, 0.0, 1.0])


ASSETS = Path(__file__).parents[1] / "src" / "pybullet_data"


def test_worlds_load_sdf_and_mjcf_files():
    with World() as world:
        (arm,) = world.load_sdf(ASSETS / "kuka_iiwa" / "model.sdf")
        assert arm.joint_count == 7
        bodies = world.load_mjcf(ASSETS / "mjcf" / "inverted_pendulum.xml")
        assert [body.name for body in bodies][-1] == "cart"
        world.gravity = (0.0, 0.0, -9.8)
        world.step(10)
        assert np.isfinite(world.position).all()


def test_scaled_models_stand_closer(tmp_path):
    text = '<sdf version="1.5"><model name="m"><pose>1 2 3 0 0 0</pose><link name="l"/></model></sdf>'
    (tmp_path / "m.sdf").write_text(text)
    with World() as world:
        (body,) = world.load_sdf(tmp_path / "m.sdf", scale=0.5)
        first = body.first_position
        assert_allclose(world.position[first : first + 3], (0.5, 1.0, 1.5))


def test_of_a_broken_scene_nothing_is_loaded(tmp_path):
    mesh = "<collision name='c'><geometry><mesh><uri>missing.obj</uri></mesh></geometry></collision>"
    models = "".join(
        f'<model name="{name}"><link name="l">{inside}</link></model>'
        for name, inside in (("a", ""), ("b", mesh))
    )
    (tmp_path / "m.sdf").write_text(f'<sdf version="1.5"><world name="w">{models}</world></sdf>')
    with World() as world:
        with pytest.raises(DescriptionError):
            world.load_sdf(tmp_path / "m.sdf")
        assert not world.bodies
