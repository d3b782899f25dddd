"""SRDF files: groups of joints, states as keyframes, and links that do not collide."""

import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError
from carom.layouts.flags import LoadFlags

LINK = (
    '<link name="{}"><inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>'
    '</inertial><collision><geometry><sphere radius=".2"/></geometry></collision></link>'
)
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><origin xyz=".1 0 0"/>'
    '<axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="9" velocity="9"/>{4}</joint>'
)
URDF = (
    '<robot name="r">'
    + "".join(map(LINK.format, ("base", "upper", "lower", "palm", "left", "right")))
    + JOINT.format("shoulder", "revolute", "base", "upper", "")
    + JOINT.format("elbow", "revolute", "upper", "lower", "")
    + JOINT.format("wrist", "fixed", "lower", "palm", "")
    + JOINT.format("slide", "prismatic", "palm", "left", "")
    + JOINT.format(
        "follower", "prismatic", "palm", "right", '<mimic joint="slide" multiplier="-2" offset=".05"/>'
    )
    + "</robot>"
)
SRDF = """<robot name="r"><group name="arm"><chain base_link="base" tip_link="palm"/></group>
<group name="hand"><link name="palm"/><joint name="slide"/><link name="right"/><link name="base"/></group>
<group name="all"><group name="arm"/><group name="hand"/></group>
<group_state name="home" group="arm"><joint name="shoulder" value=".5"/>
 <joint name="elbow" value="-1"/></group_state>
<group_state name="open" group="hand"><joint name="slide" value=".1"/></group_state>
<group_state name="away" group="arm"><joint name="elbow" value="1"/></group_state>
<group_state name="away" group="hand"><joint name="slide" value=".2"/></group_state>
<end_effector name="e" parent_link="palm" group="hand"/><virtual_joint name="v" type="fixed" parent_frame="w"
 child_link="base"/>
<disable_collisions link1="upper" link2="base" reason="Adjacent"/>{more}</robot>"""

WHOLE = SRDF.format(more="")


@pytest.fixture
def load(tmp_path):
    (tmp_path / "r.urdf").write_text(URDF)

    def load(text=WHOLE, name="r.srdf", **options):
        (tmp_path / name).write_text(text)
        return World().load(tmp_path / "r.urdf", fixed_base=True, srdf=tmp_path / name, **options)

    return load


def touching(scene):
    world = scene.world
    world.gravity = (0.0, 0.0, 0.0)
    world.step()
    return {tuple(sorted((it.a.name, it.b.name))) for it in world.contacts()}


def test_groups_are_names_of_joints_that_move(load):
    scene = load()
    assert scene.groups == {
        "arm": ("shoulder", "elbow"),
        "hand": ("slide", "follower"),
        "all": ("shoulder", "elbow", "slide", "follower"),
    }
    assert not scene.ignored.that_matter
    assert {it.element for it in scene.ignored} >= {"robot/end_effector", "robot/virtual_joint"}


def test_states_are_keyframes(load):
    scene = load()
    joints = scene.bodies[0].joints
    assert set(scene.keyframes) == {"home", "open", "arm/away", "hand/away"}
    scene.reset("home")
    assert [joints[name].position for name in ("shoulder", "elbow", "slide")] == [0.5, -1.0, 0.0]
    scene.reset("open")
    positions = [joints[name].position for name in ("shoulder", "elbow", "slide", "follower")]
    assert_allclose(positions, [0.0, 0.0, 0.1, -0.15], atol=1e-12)
    scene.reset("arm/away")
    assert joints["elbow"].position == 1.0


def test_lengths_have_the_scale_of_the_robot(load):
    scene = load(scale=2.0)
    scene.reset("open")
    assert_allclose(scene.bodies[0].joints["slide"].position, 0.2)
    scene.reset("home")
    assert scene.bodies[0].joints["shoulder"].position == 0.5


@pytest.mark.parametrize(
    ("more", "apart"),
    [
        ("", {("base", "upper")}),
        ('<disable_collisions link1="left" link2="palm"/>', {("base", "upper"), ("left", "palm")}),
        (
            '<disable_default_collisions link="upper"/><enable_collisions link1="upper" link2="lower"/>',
            {("base", "upper"), ("palm", "upper"), ("left", "upper"), ("right", "upper")},
        ),
    ],
)
def test_links_are_kept_apart(load, tmp_path, more, apart):
    flags = int(LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_INCLUDE_PARENT)
    found = touching(load(SRDF.format(more=more), flags=flags))
    without = touching(World().load(tmp_path / "r.urdf", fixed_base=True, flags=flags))
    assert ("base", "upper") in without
    assert found == without - apart


def test_it_may_be_xacro(load):
    text = SRDF.format(more="").replace('name="r">', 'name="r" xmlns:xacro="http://ros.org/wiki/xacro">'
        '<xacro:arg name="angle" default=".5"/>').replace('value=".5"', 'value="$(arg angle)"')  # fmt: skip
    scene = load(text, "r.srdf.xacro")
    scene.reset("home")
    assert scene.bodies[0].joints["shoulder"].position == 0.5


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ('<group name="g"><joint name="x"/></group>', "the robot has no joint 'x'"),
        ('<group name="g"><link name="x"/></group>', "the robot has no link 'x'"),
        ('<group name="g"><group name="x"/></group>', "there is no group 'x'"),
        ('<group name="g"><group name="g"/></group>', "group 'g' contains itself"),
        ('<group name="g"/><group name="g"/>', "there are two groups 'g'"),
        (
            '<group name="g"><chain base_link="palm" tip_link="base"/></group>',
            "'palm' is not above",
        ),
        ('<group_state name="s" group="g"/>', "there is no group 'g'"),
        (
            '<group name="g"/>' + '<group_state name="s" group="g"/>' * 2,
            "there are two states 's' of",
        ),
        ('<disable_collisions link1="base" link2="x"/>', "the robot has no link 'x'"),
        ('<disable_collisions link1="base"/>', "link2"),
        ("<group/>", "name"),
    ],
)
def test_what_is_not_there_is_an_error_that_names_the_place(load, text, problem):
    with pytest.raises(DescriptionError, match=problem) as error:
        load(f'<robot name="r">\n{text}</robot>')
    assert "r.srdf:2" in str(error.value)


def test_what_of_a_state_has_no_effect_is_reported(load):
    scene = load(
        '<robot name="r"><group name="g"/><group_state name="s" group="g"><joint name="wrist" value="1"/>'
        '</group_state><passive_joint name="elbow"/><odd/></robot>'
    )
    says = {it.element: it.consequence for it in scene.ignored}
    assert says["group_state/joint"] == "none: it does not move"
    assert says["robot/odd"] == "it has no effect"
    assert says["robot/passive_joint"].startswith("none")


def test_it_is_for_urdf_files(tmp_path):
    (tmp_path / "m.xml").write_text("<mujoco/>")
    with pytest.raises(ValueError, match="srdf is for URDF"):
        World().load(tmp_path / "m.xml", srdf=tmp_path / "r.srdf")
    with pytest.raises(DescriptionError, match="no such file"):
        (tmp_path / "r.urdf").write_text(URDF)
        World().load(tmp_path / "r.urdf", srdf=tmp_path / "none.srdf")
