"""SDF models made of others: includes, merged ones, placement frames, static ones, and what is missing."""

from __future__ import annotations

import logging
import math
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.description import Mesh
from carom.errors import DescriptionError
from carom.world.scene import Scene

INERTIAL = "<inertial><mass>2</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>"
ARM = f"""<model name="arm"><frame name="grip" attached_to="hand"><pose>0 0 0.5 0 0 0</pose></frame>
<link name="base">{INERTIAL}</link><link name="hand"><pose>1 0 0 0 0 0</pose>{INERTIAL}</link>
<joint name="wrist" type="revolute"><parent>base</parent><child>hand</child>
<axis><xyz>0 1 0</xyz></axis></joint></model>"""


def write(folder: Path, name: str, text: str, version: str = "1.11") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    file.write_text(f'<sdf version="{version}">{text}</sdf>')
    return file


def load(tmp_path: Path, text: str, **options) -> Scene:
    write(tmp_path / "models" / "arm", "model.sdf", ARM)
    file = write(tmp_path, "m.sdf", text)
    return World().load(file, package_paths=[tmp_path / "models"], **options)


def test_a_model_made_of_an_include(tmp_path: Path):
    include = "<include><uri>model://arm</uri><name>left</name><pose>0 2 0 0 0 0</pose></include>"
    weld = '<joint name="j" type="fixed"><parent>stand</parent><child>left::base</child></joint>'
    stand = f'<pose>0 0 1 0 0 0</pose><link name="stand">{INERTIAL}</link>'
    scene = load(tmp_path, f'<model name="m">{stand}{include}{weld}</model>', strict=True)
    (body,) = scene
    assert [it.name for it in body.links] == ["stand", "left::base", "left::hand"]
    assert [it.name for it in body.joints] == ["j", "left::wrist"]
    assert_allclose(body.links["left::hand"].pose.position, (1, 2, 1), atol=1e-12)


def test_a_merged_include_has_no_name_of_its_own(tmp_path: Path):
    turned = f"<pose>0 2 0 0 0 {math.pi / 2}</pose>"
    include = f'<include merge="true"><uri>model://arm</uri>{turned}</include>'
    more = f'<link name="tip"><pose relative_to="grip">0 0 1 0 0 0</pose>{INERTIAL}</link>'
    weld = '<joint name="j" type="fixed"><parent>grip</parent><child>tip</child></joint>'
    (body,) = load(tmp_path, f'<model name="m">{include}{more}{weld}</model>', strict=True)
    assert [it.name for it in body.links] == ["base", "hand", "tip"]
    assert_allclose(body.links["hand"].pose.position, (0, 3, 0), atol=1e-12)
    assert_allclose(body.links["tip"].pose.position, (0, 3, 1.5), atol=1e-12)


def test_a_frame_of_an_include_is_placed(tmp_path: Path):
    place = "<placement_frame>grip</placement_frame><pose>5 0 0 0 0 0</pose>"
    scene = load(tmp_path, f'<world name="w"><include><uri>model://arm</uri>{place}</include></world>')
    assert_allclose(scene[0].links["hand"].pose.position, (5, 0, -0.5), atol=1e-12)
    text = ARM.replace('name="arm"', 'name="arm" placement_frame="hand"')
    assert_allclose(load(tmp_path, text)[0].links["base"].pose.position, (-1, 0, 0), atol=1e-12)


def test_an_include_of_a_world_is_placed_relative_to_a_frame(tmp_path: Path):
    frame = '<frame name="f"><pose>0 0 3 0 0 0</pose></frame>'
    pose = '<pose relative_to="f">1 0 0 0 0 0</pose>'
    scene = load(tmp_path, f'<world name="w">{frame}<include><uri>model://arm</uri>{pose}</include></world>')
    assert_allclose(scene[0].links["base"].pose.position, (1, 0, 3), atol=1e-12)


def test_a_static_include_does_not_fall(tmp_path: Path):
    includes = "".join(
        f"<include><uri>model://arm</uri><name>{name}</name><static>{says}</static></include>"
        for name, says in (("held", "true"), ("free", "0"))
    )
    scene = load(tmp_path, f'<world name="w">{includes}</world>')
    scene.apply_options()
    assert (scene.world.parameters.time_step, list(scene.world.gravity)) == (0.001, [0, 0, -9.8])
    scene.world.step(100)
    assert scene["held"].links["base"].pose.position[2] == 0
    assert_allclose(scene["held"].links["hand"].pose.position, (1, 0, 0), atol=1e-12)
    assert scene["free"].links["base"].pose.position[2] < -0.04


def test_an_include_that_is_missing_is_reported_with_its_joints(tmp_path: Path):
    include = "<include><uri>https://example.org/models/Hand</uri><name>hand</name></include>"
    weld = '<joint name="j" type="fixed"><parent>stand</parent><child>hand::palm</child></joint>'
    text = f'<model name="m"><link name="stand">{INERTIAL}</link>{include}{weld}</model>'
    scene = load(tmp_path, text)
    assert [it.name for it in scene[0].links] == ["stand"]
    assert {it.element: it.consequence for it in scene.ignored.that_matter} == {
        "model/include": "the model is missing",
        "model/joint": "nothing is joined",
    }
    with pytest.raises(DescriptionError, match="there is no link 'palm'"):
        load(tmp_path, text.replace(include, "").replace("hand::palm", "palm"))


def test_a_model_that_is_missing_is_not_the_file_itself(tmp_path: Path):
    text = (
        f'<model name="m"><link name="a">{INERTIAL}</link><include><uri>model://arms</uri></include></model>'
    )
    file = write(tmp_path / "other", "model.sdf", text)
    scene = World().load(file, package_paths=[tmp_path])
    assert [it.consequence for it in scene.ignored] == ["the model is missing"]


def test_a_model_that_includes_itself_is_refused(tmp_path: Path):
    write(tmp_path / "models" / "arm", "model.sdf", ARM)
    write(
        tmp_path / "models" / "loop",
        "model.sdf",
        '<model name="loop"><include><uri>model://loop</uri></include></model>',
    )
    file = write(tmp_path, "m.sdf", '<world name="w"><include><uri>model://loop</uri></include></world>')
    with pytest.raises(DescriptionError, match="includes itself"):
        World().load(file, package_paths=[tmp_path / "models"])


def test_a_model_of_the_network_is_looked_for_by_its_name(tmp_path: Path):
    write(tmp_path / "models" / "The arm", "model.sdf", ARM)
    uri = "<uri>https://example.org/1.0/owner/models/The%20arm/tip</uri>"
    scene = load(tmp_path, f'<world name="w"><include>{uri}</include></world>')
    assert [it.name for it in scene] == ["arm"]
    cube = "o c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "models" / "The arm" / "a.obj").write_text(cube)
    mesh = "<mesh><uri>https://example.org/1.0/owner/models/The%20arm/2/files/a.obj</uri></mesh>"
    shape = f'<collision name="c"><geometry>{mesh}</geometry></collision>'
    scene = load(tmp_path, f'<model name="m"><link name="a">{INERTIAL}{shape}</link></model>')
    geometry = scene[0].spec.base.collisions[0].geometry
    assert isinstance(geometry, Mesh)
    assert geometry.path.name == "a.obj"


def test_a_declaration_may_come_after_a_comment(tmp_path: Path):
    file = tmp_path / "m.sdf"
    model = f'<sdf version="1.9"><model name="m"><link name="a">{INERTIAL}</link></model></sdf>'
    file.write_text(f"<!-- licence\n -->\n<?xml version='1.0'?>\n{model}")
    assert World().load(file)[0].name == "m"


def test_a_model_config_names_the_file(tmp_path: Path):
    folder = tmp_path / "models" / "crate"
    write(folder, "new.sdf", f'<model name="crate"><link name="box">{INERTIAL}</link></model>')
    names = '<sdf version="1.4">old.sdf</sdf><sdf version="1.9">new.sdf</sdf>'
    (folder / "model.config").write_text(f"<model>{names}</model>")
    scene = load(tmp_path, '<world name="w"><include><uri>model://crate</uri></include></world>')
    assert [it.name for it in scene["crate"].links] == ["box"]


def test_poses_of_quaternions_and_degrees(tmp_path: Path):
    degrees = f'<link name="a"><pose degrees="true">0 0 0 0 0 90</pose>{INERTIAL}</link>'
    half = math.sqrt(0.5)
    turned = (
        f'<link name="b"><pose rotation_format="quat_xyzw">1 0 0 0 0 {half} {half}</pose>{INERTIAL}</link>'
    )
    first, second = load(tmp_path, f'<model name="m">{degrees}{turned}</model>')
    assert_allclose(first.links[-1].pose.orientation, (0, 0, half, half), atol=1e-12)
    assert_allclose(second.links[-1].pose.orientation, (0, 0, half, half), atol=1e-12)


@pytest.mark.parametrize(("says", "collide"), [("false", False), ("true", True)])
def test_links_of_a_model_collide_if_it_says_so(tmp_path: Path, says: str, collide: bool):
    shape = "<collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry></collision>"
    links = "".join(
        f'<link name="{name}"><pose>{x} 0 0 0 0 0</pose>{INERTIAL}{shape}</link>'
        for name, x in (("a", 0.0), ("b", 0.8))
    )
    scene = load(tmp_path, f'<model name="m"><self_collide>{says}</self_collide>{links}</model>')
    scene.world.step(3)
    assert bool(scene.world.velocity.any()) is collide


def test_a_kinematic_link_is_moved_by_users_only(tmp_path: Path, caplog):
    link = f'<link name="a"><kinematic>true</kinematic>{INERTIAL}</link>'
    with caplog.at_level(logging.WARNING):
        scene = load(tmp_path, f'<model name="m">{link}</model>', strict=True)
    scene.world.gravity = (0, 0, -10)
    scene.world.step(10)
    assert scene[0].links[-1].pose.position[2] == 0
