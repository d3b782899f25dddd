"""Keyframes, sites, cameras, options and collisions of MJCF files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError

KEYS = """<mujoco><option timestep=".004" gravity="0 0 -1"/><worldbody><body name="arm" pos="0 0
 1"><joint name="j"/>
<geom size=".1" pos=".1 0 0"/><site name="tip" pos=".2 0 0"/><camera name="eye" fovy="30" pos="0 0
 1"/></body>
<body name="ball" pos="3 0 1"><freejoint/><geom size=".1" pos="0 .2 0"/></body></worldbody>
<keyframe><key name="home" qpos=".5 1 2 3 0 1 0 0" qvel="2 .1 .2 .3 .4 .5 .6"/></keyframe></mujoco>"""


@pytest.fixture
def load(tmp_path):
    with World() as world:

        def load(text):
            (tmp_path / "file.xml").write_text(text)
            return world.load(tmp_path / "file.xml")

        yield load


def test_a_keyframe_puts_all_bodies_in_their_places(load):
    scene = load(KEYS)
    scene.reset("home")
    assert scene["arm"].joints["j"].position == 0.5
    assert scene["arm"].joints["j"].velocity == 2.0
    base = scene["ball"].links[-1]
    assert_allclose(base.pose.position, (1, 2, 3), atol=1e-15)
    assert_allclose(np.abs(base.pose.orientation), (1, 0, 0, 0), atol=1e-15)
    # The angular velocity is about axes of the body, which is turned by half a turn about x.
    linear, angular = base.velocity
    assert_allclose(angular, (0.4, -0.5, -0.6), atol=1e-15)
    offset = np.array((0.0, -0.2, 0.0))
    assert_allclose(linear, np.array((0.1, 0.2, 0.3)) + np.cross(angular, offset), atol=1e-15)
    with pytest.raises(KeyError, match="home"):
        scene.reset("away")


def test_sites_cameras_and_options_have_their_names(load):
    scene = load(KEYS)
    assert scene.sites["tip"].body == "arm"
    assert scene.sites["tip"].frame.position == (0.2, 0.0, 0.0)
    assert scene.cameras["eye"].field_of_view == 30.0
    assert scene.world.time_step == 0.004
    assert tuple(scene.world.gravity) == (0.0, 0.0, -1.0)


def test_a_body_that_is_welded_to_the_world_stays_there_and_one_on_it_moves(load):
    scene = load(
        '<mujoco><worldbody><body name="stand" pos="0 0 1"><geom size=".1"/><body name="arm">'
        '<joint name="j"/><geom size=".1" pos="0 1 0"/></body></body><body name="free"><freejoint/>'
        '<geom size=".1"/></body></worldbody></mujoco>'
    )
    assert [body.fixed_base for body in scene] == [True, False]
    scene.world.gravity = (-10.0, 0.0, 0.0)
    scene.world.step(40)
    assert_allclose(scene["stand"].links[-1].pose.position, (0, 0, 1))
    assert scene["stand"].joints["j"].position > 0.01
    assert scene["free"].links[-1].pose.position[0] < -0.01


def drops(load, ball, floor, rest=""):
    """Whether a ball falls through a floor."""
    scene = load(
        f'<mujoco><worldbody><geom type="plane" size="1 1 1" {floor}/><body name="b" pos="0 0 .11">'
        f'<freejoint/><geom size=".1" {ball}/></body></worldbody>{rest}</mujoco>'
    )
    scene.world.gravity = (0, 0, -10)
    scene.world.step(100)
    return bool(scene["b"].links[-1].pose.position[2] < 0)


@pytest.mark.parametrize(
    ("ball", "floor", "falls"),
    [
        ("", "", False),
        ('contype="2" conaffinity="0"', 'contype="0" conaffinity="2"', False),
        ('contype="2" conaffinity="4"', 'contype="4" conaffinity="0"', False),
        ('contype="2" conaffinity="2"', "", True),
        ('contype="0" conaffinity="0"', "", True),
    ],
)
def test_geoms_collide_if_the_type_of_either_meets_the_affinity_of_the_other(load, ball, floor, falls):
    assert drops(load, ball, floor) is falls


@pytest.mark.parametrize(
    ("ball", "falls"),
    [
        ("", False),
        ('contype="1" conaffinity="0"', False),
        ('contype="4" conaffinity="1"', False),
        ('contype="2" conaffinity="2"', False),
        ('contype="0" conaffinity="0"', True),
    ],
)
@pytest.mark.parametrize("fixed", [True, False])
def test_bodies_of_a_script_collide_with_geoms_that_collide_with_anything(load, ball, falls, fixed):
    scene = load(
        '<mujoco><worldbody><body pos="5 0 0"><freejoint/><geom size=".1"/></body>'
        f'<body name="b" pos="0 0 .11"><freejoint/><geom size=".1" {ball}/></body></worldbody></mujoco>'
    )
    scene.world.gravity = (0, 0, -10)
    if fixed:
        scene.world.add_plane()
    else:
        scene.world.add_box((1.0, 1.0, 0.5), (0.0, 0.0, -0.25), mass=1e6)
        scene.world.gravity = (0, 0, 0)
        scene["b"].set_base_velocity((0.0, 0.0, -1.0), (0.0, 0.0, 0.0))
    scene.world.step(100)
    assert bool(scene["b"].links[-1].pose.position[2] < 0) is falls


def test_excluded_bodies_do_not_collide(load):
    assert drops(load, "", "", '<contact><exclude body1="b" body2="world"/></contact>')


def test_pairs_of_geoms_collide_whatever_their_bits_and_excluded_bodies_say(load):
    pair = '<contact><exclude body1="b" body2="world"/><pair geom1="ball" geom2="floor"/></contact>'
    off = 'contype="0" conaffinity="0"'
    assert drops(load, f'name="ball" {off}', f'name="floor" {off}', pair) is False
    assert drops(load, f'name="ball" {off}', f'name="floor" {off}') is True


def test_a_pair_of_a_body_with_several_shapes_is_reported(load):
    scene = load(
        '<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/><body name="b" pos="0 0 1">'
        '<freejoint/><geom name="ball" size=".1"/><geom size=".2"/></body></worldbody><contact>'
        '<pair geom1="ball" geom2="floor" condim="1"/></contact></mujoco>'
    )
    assert [it.consequence for it in scene.ignored.that_matter] == ["all geoms of both bodies collide"]
    with pytest.raises(DescriptionError, match="no geom 'no'"):
        load(
            '<mujoco><worldbody><geom name="a" size="1"/></worldbody><contact><pair geom1="a" geom2="no"/>'
            "</contact></mujoco>"
        )


@pytest.mark.parametrize("joints", ["<freejoint/>", '<joint type="slide" axis="0 0 1"/>'])
def test_gravity_is_compensated_by_its_share(load, joints):
    scene = load(
        f'<mujoco><worldbody><body name="b" gravcomp=".75">{joints}<geom size=".1"/></body></worldbody>'
        "</mujoco>"
    )
    scene.world.gravity = (0, 0, -10)
    scene.world.step(10)
    velocity = scene[0].links["b"].velocity.linear[2]
    assert_allclose(velocity, -0.25 * 10 * 10 * scene.world.parameters.time_step, rtol=1e-12)


def overlapping(joint, flag=""):
    return (
        f'<mujoco>{flag}<worldbody><body name="a"><freejoint/><geom size=".2"/><body name="c" pos=".1 0 0">'
        f'<joint type="slide" axis="1 0 0"/><geom size=".2"/>{joint}</body></body></worldbody></mujoco>'
    )


def test_bodies_that_a_joint_connects_do_not_collide_and_others_of_the_tree_do(load):
    deep = '<body name="d"><joint type="slide" axis="1 0 0"/><geom size=".1" contype="2"/></body>'
    scene = load(overlapping(""))
    scene.world.step(5)
    assert_allclose(scene[0].joints[0].position, 0.0, atol=1e-12)
    scene = load(overlapping("", '<option><flag filterparent="disable"/></option>'))
    scene.world.step(5)
    assert abs(scene[0].joints[0].position) > 1e-6
    scene = load(overlapping(deep))
    scene.world.step(5)
    assert abs(scene[0].joints[1].position) > 1e-6


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ('<body><joint/><freejoint/><geom size="1"/></body>', "free joint"),
        ('<body><inertial pos="0 0 0" mass="1" diaginertia="1 1 9"/><freejoint/></body>', "balanceinertia"),
        ('<geom type="mesh" mesh="no"/>', "no mesh 'no'"),
        ('<geom type="box" size="1 1"/>', "needs 3 positive numbers"),
        ('<body childclass="no"><geom size="1"/></body>', "no default class"),
        ('<attach model="no"/>', "no model 'no'"),
        ('<body name="a"/><body name="a"/>', "taken already"),
        ('<replicate count="0"/>', "count=0"),
    ],
)
def test_mistakes_are_named(load, text, problem):
    with pytest.raises(DescriptionError, match=problem):
        load(f"<mujoco><worldbody>{text}</worldbody></mujoco>")


def test_models_are_attached_with_their_own_settings(tmp_path):
    (tmp_path / "part.xml").write_text(
        '<mujoco><compiler angle="radian"/><default><geom density="10"/></default><worldbody>'
        '<body name="arm" pos="1 0 0"><joint name="j" range="-1 1"/><geom size="1"/></body></worldbody>'
        "</mujoco>"
    )
    (tmp_path / "whole.xml").write_text(
        '<mujoco><asset><model name="p" file="part.xml"/></asset><worldbody><frame pos="0 0 1">'
        '<attach model="p" '
        'body="arm" prefix="left-"/></frame></worldbody></mujoco>'
    )
    with World() as world:
        (arm,) = world.load(tmp_path / "whole.xml", strict=True)
        assert arm.joints["left-j"].limits == (-1.0, 1.0)
        assert_allclose(arm.links["left-arm"].mass, 41.8879020478639)
        assert_allclose(arm.links["left-arm"].pose.position, (1, 0, 1))


@pytest.mark.parametrize(("count", "first", "last"), [(9, "0", "8"), (10, "00", "09"), (100, "000", "099")])
def test_copies_have_as_many_digits_as_their_count(load, count, first, last):
    # As in MuJoCo 4.0, where ten copies have two digits, though the last one is the ninth.
    scene = load(
        f'<mujoco><worldbody><replicate count="{count}" offset="1 0 0"><body name="b"><freejoint/>'
        '<geom size=".1"/></body></replicate></worldbody></mujoco>'
    )
    names = [body.name for body in scene.bodies if not body.fixed_base]
    assert (names[0], names[-1], len(names)) == (f"b{first}", f"b{last}", count)


PART = '<worldbody><body name="arm"><joint name="j"/><geom size="1"/></body></worldbody></mujoco>'


@pytest.mark.parametrize(
    ("start", "asset", "name"),
    [
        ('<mujoco model="Arm of mine">', "", "Arm of mine"),
        ("<mujoco>", "", "MuJoCo Model"),
        ('<mujoco model="Arm of mine">', 'name="p"', "p"),
    ],
)
def test_models_to_attach_have_their_own_names_if_the_asset_has_none(tmp_path, start, asset, name):
    # As in MuJoCo 4.0, which knows neither the name of the file nor the model's beside the asset's.
    (tmp_path / "part.xml").write_text(start + PART)
    whole = (
        '<mujoco><asset><model file="part.xml" {}/></asset>'
        '<worldbody><attach model="{}" {}/></worldbody></mujoco>'
    )
    (tmp_path / "whole.xml").write_text(whole.format(asset, name, 'body="arm" prefix="left-"'))
    with World() as world:
        assert world.load(tmp_path / "whole.xml", strict=True)[0].links["left-arm"].name == "left-arm"
        for other in {"part", "Arm of mine", "MuJoCo Model", "p"} - {name}:
            (tmp_path / "whole.xml").write_text(whole.format(asset, other, 'body="arm" prefix="left-"'))
            with pytest.raises(DescriptionError, match=f"there is no model '{other}'"):
                world.load(tmp_path / "whole.xml")


def test_two_models_of_one_name_are_refused(tmp_path):
    (tmp_path / "part.xml").write_text('<mujoco model="p">' + PART)
    (tmp_path / "whole.xml").write_text(
        '<mujoco><asset><model file="part.xml"/>\n<model name="p" file="part.xml"/></asset></mujoco>'
    )
    with World() as world, pytest.raises(DescriptionError, match=r"whole.xml:2.*'p' is taken already"):
        world.load(tmp_path / "whole.xml")


def test_fluids_are_options_of_the_world(load):
    text = '<mujoco><option density="1.2" viscosity=".1" wind="1 2 3"/><worldbody/></mujoco>'
    scene = load(text)
    assert not list(scene.ignored)
    scene.apply_options()
    parameters = scene.world.parameters
    assert (parameters.fluid_density, parameters.fluid_viscosity, parameters.wind) == (1.2, 0.1, (1, 2, 3))


@pytest.mark.parametrize(("kind", "collide"), [("", True), ('mocap="true"', False)])
def test_bodies_do_not_touch_the_mocap_body_that_they_hang_from(load, kind, collide):
    # MuJoCo 3.12 and later: 1 and 0 contacts.
    scene = load(
        f'<mujoco><worldbody><body name="a" {kind}><geom size=".1"/><body name="b"><joint name="j"/>'
        '<geom size=".1" pos=".05 0 0"/></body></body></worldbody></mujoco>'
    )
    scene.world.gravity = (0.0, 0.0, 0.0)
    joint = scene["a"].joints["j"]
    joint.body.set_joint_state(joint.index, [0.0], [1.0])
    scene.world.step(40)
    # The ball of the one body is inside that of the other.
    assert (abs(joint.velocity - 1.0) > 1e-3) is collide
