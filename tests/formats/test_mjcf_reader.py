"""What Carom reads in MJCF files beside what PyBullet does."""

from __future__ import annotations

from math import pi, sqrt
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from carom.description import Box, Capsule, ConvexHull, JointType, Pose, Sphere
from carom.errors import DescriptionError
from carom.formats.mjcf import read_mjcf
from carom.formats.placed import PlacedRobot

HALF = sqrt(0.5)


def read(folder: Path, *world: str, before: str = "", colours: bool = False) -> list[PlacedRobot]:
    file = folder / "file.xml"
    text = f'<mujoco model="m">\n{before}\n<worldbody>\n' + "\n".join(world) + "\n</worldbody></mujoco>"
    file.write_text(text, encoding="utf-8")
    return read_mjcf(file, colours=colours)


def only(placed: list[PlacedRobot]) -> PlacedRobot:
    (robot,) = placed
    return robot


@pytest.mark.parametrize(
    ("compiler", "attributes", "expected"),
    [
        ('angle="degree"', 'euler="90 0 0"', (HALF, 0, 0, HALF)),
        ('angle="radian"', f'euler="0 {pi / 2} 0"', (0, HALF, 0, HALF)),
        ('eulerseq="zyx"', 'euler="90 90 0"', (-0.5, 0.5, 0.5, 0.5)),
        ('eulerseq="ZYX"', 'euler="90 90 0"', (0.5, 0.5, 0.5, 0.5)),
        ("", 'axisangle="0 0 2 90"', (0, 0, HALF, HALF)),
        ("", 'xyaxes="0 1 0 -1 1 0"', (0, 0, HALF, HALF)),
        ("", 'zaxis="0 -3 0"', (HALF, 0, 0, HALF)),
        ("", 'zaxis="0 0 -1"', (1, 0, 0, 0)),
        ("", 'quat="2 0 2 0"', (0, HALF, 0, HALF)),
    ],
)
def test_orientations_of_bodies(
    tmp_path: Path, compiler: str, attributes: str, expected: tuple[float, ...]
) -> None:
    placed = only(read(tmp_path, f"<body {attributes}/>", before=f"<compiler {compiler}/>"))
    assert_allclose(placed.pose.orientation, expected, rtol=0, atol=1e-6)


def test_defaults_come_from_classes_and_what_these_begin_with(tmp_path: Path) -> None:
    before = """<default>
      <geom type="box" size="1 1 1"/>
      <joint type="slide" range="0 2" limited="true"/>
      <default class="legs"><geom size="2 2 2"/>
        <default class="feet"><geom type="sphere" size="3"/></default></default>
    </default>"""
    world = """<body name="a" childclass="legs"><joint axis="1 0 0"/>
      <geom/><geom class="feet"/><geom size="4 4 4"/>
      <body name="b"><geom/></body><body name="c" childclass="main"><geom/></body></body>"""
    robot = only(read(tmp_path, world, before=before)).robot
    shapes = {link.name: [collision.geometry for collision in link.collisions] for link in robot.links}
    assert shapes["a"] == [Box((2, 2, 2)), Sphere(3), Box((4, 4, 4))]
    assert shapes["b"] == [Box((2, 2, 2))]
    assert shapes["c"] == [Box((1, 1, 1))]
    slide = robot.joints[-1] if robot.joints[-1].type is JointType.PRISMATIC else robot.joints[0]
    assert (slide.type, slide.limit.lower, slide.limit.upper) == (JointType.PRISMATIC, 0.0, 2.0)


def test_joints_without_a_type_are_hinges_and_balls_are_spherical(tmp_path: Path) -> None:
    robot = only(
        read(tmp_path, '<body><joint name="h" axis="0 0 1"/><joint name="b" type="ball" range="0 1"/></body>')
    ).robot
    assert [(joint.name, joint.type) for joint in robot.joints[:2]] == [
        ("h", JointType.CONTINUOUS),
        ("b", JointType.SPHERICAL),
    ]
    assert robot.joints[2].type is JointType.FIXED


@pytest.mark.parametrize(("compiler", "limited"), [('autolimits="true"', True), ("", False)])
def test_ranges_are_limits_where_the_file_says_so(tmp_path: Path, compiler: str, limited: bool) -> None:
    robot = only(
        read(tmp_path, '<body><joint range="-90 90"/></body>', before=f"<compiler {compiler}/>")
    ).robot
    joint = robot.joints[0]
    assert joint.type is (JointType.REVOLUTE if limited else JointType.CONTINUOUS)
    assert (joint.limit.lower <= joint.limit.upper) is limited


def test_frames_move_what_is_in_them(tmp_path: Path) -> None:
    world = """<frame pos="1 0 0"><frame axisangle="0 0 1 90"><body name="a" pos="1 0 0">
      <frame pos="0 0 1"><geom type="sphere" size="1" pos="0 0 2"/>
        <joint axis="1 0 0" pos="0 1 0"/></frame></body></frame></frame>"""
    robot = only(read(tmp_path, world, before="<compiler/>")).robot
    hinge = robot.joints[0]
    # The body is at (1, 1, 0), turned to the left; its joint is 1 to its y and 1 up.
    assert_allclose(hinge.frame.position, (0.0, 1.0, 1.0), rtol=0, atol=1e-6)
    body = next(link for link in robot.links if link.name == "a")
    assert_allclose(body.collisions[0].frame.position, (0, 0, 3), rtol=0, atol=1e-6)


def test_global_coordinates_are_those_of_the_world(tmp_path: Path) -> None:
    local = """<body name="a" pos="1 2 3" quat="1 0 0 1"><geom type="capsule" size=".1" fromto="0 0 0 1 0 0"/>
      <body name="b" pos="1 0 0"><joint axis="0 1 0" pos="0 0 1"/>
        <geom type="sphere" size=".1" pos="0 1 0"/></body></body>"""
    world = """<body name="a" pos="1 2 3" quat="1 0 0 1"><geom type="capsule" size=".1" fromto="1 2 3 1 3 3"/>
      <body name="b" pos="1 3 3" quat="1 0 0 1"><joint axis="-1 0 0" pos="1 3 4"/>
        <geom type="sphere" size=".1" pos="0 3 3"/></body></body>"""
    a = only(read(tmp_path, local, before="<compiler/>"))
    b = only(read(tmp_path, world, before='<compiler coordinate="global"/>'))
    assert_pose(a.pose, b.pose)
    for first, second in zip(a.robot.joints, b.robot.joints, strict=True):
        assert_pose(first.frame, second.frame)
        assert_allclose(first.axis, second.axis, rtol=0, atol=1e-6)
    for first, second in zip(a.robot.links, b.robot.links, strict=True):
        assert_pose(first.inertial.frame, second.inertial.frame)
        for one, other in zip(first.collisions, second.collisions, strict=True):
            assert_allclose(one.frame.position, other.frame.position, rtol=0, atol=1e-6)


def assert_pose(a: Pose, b: Pose) -> None:
    assert_allclose(a.position, b.position, rtol=0, atol=1e-6)
    assert_allclose(a.orientation, b.orientation, rtol=0, atol=1e-6)


def test_includes_are_put_where_they_stand(tmp_path: Path) -> None:
    (tmp_path / "leg.xml").write_text(
        '<mujocoinclude><body name="leg"><geom type="sphere" size="1"/></body></mujocoinclude>'
    )
    (tmp_path / "defaults.xml").write_text('<mujoco><default><geom contype="4"/></default></mujoco>')
    robot = only(
        read(
            tmp_path,
            '<body name="a"><include file="leg.xml"/></body>',
            before='<include file="defaults.xml"/>',
        )
    ).robot
    assert [link.name for link in robot.links] == ["a", "leg"]
    assert robot.links[1].collisions[0].group == 4


def test_errors_in_included_files_name_these(tmp_path: Path) -> None:
    (tmp_path / "leg.xml").write_text('<mujoco>\n\n<geom type="box" size="1 x 1"/></mujoco>')
    with pytest.raises(DescriptionError, match="'x' is not a number") as raised:
        read(tmp_path, '<body><include file="leg.xml"/></body>')
    assert (raised.value.file, raised.value.line) == (tmp_path / "leg.xml", 3)


def test_includes_cannot_go_on_for_ever(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text('<mujoco><include file="b.xml"/></mujoco>')
    (tmp_path / "b.xml").write_text('<mujoco><include file="a.xml"/></mujoco>')
    with pytest.raises(DescriptionError, match="includes itself"):
        read_mjcf(tmp_path / "a.xml")
    for level in range(12):
        text = f"<mujoco>{f'<include file={chr(34)}{level + 1}.xml{chr(34)}/>' * 4}</mujoco>"
        (tmp_path / f"{level}.xml").write_text(text)
    (tmp_path / "12.xml").write_text("<mujoco/>")
    with pytest.raises(DescriptionError, match="513 included files are more than the 512"):
        read_mjcf(tmp_path / "0.xml")


def test_ellipsoids_are_hulls_and_weigh_what_they_should(tmp_path: Path) -> None:
    link = only(read(tmp_path, '<body><geom type="ellipsoid" size=".1 .2 .3"/></body>')).robot.links[0]
    hull = link.collisions[0].geometry
    assert isinstance(hull, ConvexHull)
    assert_allclose(hull.points.max(axis=0), (0.1, 0.2, 0.3), rtol=0.02)
    assert_allclose(((hull.points / (0.1, 0.2, 0.3)) ** 2).sum(axis=1), 1.0, rtol=1e-6)
    assert_allclose(link.inertial.mass, 1000.0 * 4.0 / 3.0 * pi * 0.1 * 0.2 * 0.3, rtol=1e-6)


def test_a_full_inertia_has_its_products_after_its_moments(tmp_path: Path) -> None:
    world = '<body><inertial mass="1" fullinertia="1 2 3 .1 .2 .3"/></body>'
    compiler = '<compiler inertiafromgeom="false"/>'
    tensor = only(read(tmp_path, world, before=compiler)).robot.links[0].inertial.tensor
    assert_allclose(tensor, (1, 0.1, 0.2, 2, 0.3, 3), rtol=1e-6)


def test_a_shape_given_by_its_ends_lies_between_them(tmp_path: Path) -> None:
    link = only(
        read(tmp_path, '<body><geom type="capsule" size=".1" fromto="1 0 0 1 0 -2"/></body>')
    ).robot.links[0]
    assert link.collisions[0].geometry == Capsule(pytest.approx(0.1), 2.0)  # type: ignore[arg-type]
    assert link.collisions[0].frame == Pose((1.0, 0.0, -1.0), (0.0, 1.0, 0.0, 0.0))


def test_colours_count_when_they_are_asked_for(tmp_path: Path) -> None:
    before = '<asset><material name="red" rgba="1 0 0 1"/></asset>'
    world = """<body><geom type="sphere" size="1" material="red"/>
      <geom type="sphere" size="1" rgba="0 1 0 .5"/></body>"""

    def colours(asked: bool) -> list[object]:
        link = only(read(tmp_path, world, before=before, colours=asked)).robot.links[0]
        return [visual.material.rgba for visual in link.visuals if visual.material]

    assert colours(False) == [(1, 1, 1, 1)] * 2
    assert colours(True) == [(1, 0, 0, 1), (0, 1, 0, 0.5)]


@pytest.mark.parametrize(
    ("world", "before", "line", "message"),
    [
        ("<body><geom type='box' size='1 2'/></body>", "", 4, "needs three numbers"),
        ("<body><geom type='sphere' size='-1'/></body>", "", 4, "must not be negative"),
        ("<body><geom type='capsule'/></body>", "", 4, "needs a size"),
        ("<body><geom type='capsule' size='1' fromto='1 2'/></body>", "", 4, "needs six numbers"),
        ("<body quat='0 0 0 0'/>", "", 4, "no rotation"),
        ("<body euler='1 2'/>", "", 4, "needs 3 numbers"),
        ("<body zaxis='0 0 0'/>", "", 4, "no length"),
        ("<body pos='nan 0 0'/>", "", 4, "not a finite number"),
        ("<body><joint type='screw'/></body>", "", 4, "unknown joint type 'screw'"),
        ("<body>\n<body><joint type='free'/></body></body>", "", 5, "unknown joint type 'free'"),
        ("<body><joint limited='true'/></body>", "", 4, "needs a range"),
        ("<body><joint axis='0 0 0'/></body>", "", 4, "no length"),
        ("<body name='a'><body name='a'/></body>", "", 4, "taken already"),
        ("<body><geom class='x'/></body>", "", 4, "no default class 'x'"),
        ("<body><inertial mass='-1'/></body>", "", 4, "must not be negative"),
        ("<body/>", "<compiler angle='turns'/>", 2, "neither degree nor radian"),
        ("<body/>", "<compiler eulerseq='xyq'/>", 2, "needs three of"),
        ("<body/>", "<default><default/></default>", 2, "'class' is missing"),
        ("<include/>", "", 4, "'file' is missing"),
        ("<include file='nowhere.xml'/>", "", 4, "found neither"),
    ],
)
def test_errors_say_where(tmp_path: Path, world: str, before: str, line: int, message: str) -> None:
    with pytest.raises(DescriptionError, match=message) as raised:
        read(tmp_path, world, before=before)
    assert raised.value.line == line
    assert raised.value.element is not None


def test_what_is_no_mjcf_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    file.write_text("<robot name='r'/>")
    with pytest.raises(DescriptionError, match="there is no <mujoco> element"):
        read_mjcf(file)
    with pytest.raises(DescriptionError, match=r"no such file: nowhere\.xml"):
        read_mjcf(Path("nowhere.xml"))


def _joint_of(folder: Path, attributes: str, *, as_mujoco: bool) -> tuple[float, float]:
    file = folder / "file.xml"
    file.write_text(
        f"""<mujoco><default><joint limited="true" range="-1 2"/>
          <default class="free"><joint limited="false"/></default>
          <default class="arm"><joint limited="true" range="-3 4"/></default></default>
        <worldbody><body><joint axis="0 0 1" {attributes}/></body></worldbody></mujoco>""",
        encoding="utf-8",
    )
    joint = only(read_mjcf(file, as_mujoco=as_mujoco)).robot.joints[0]
    return joint.limit.lower, joint.limit.upper


@pytest.mark.parametrize(
    ("attributes", "pybullet", "mujoco"),
    [
        ("", (-1, 2), (-1, 2)),
        ('class="free"', (-1, 2), (1, 0)),
        ('class="arm"', (-1, 2), (-3, 4)),
        ('class="arm" range="-5 6"', (-5, 6), (-5, 6)),
        ('class="arm" limited="false"', (1, 0), (1, 0)),
        # Where PyBullet ends the process.
        ('class="arm" limited="true"', (-3, 4), (-3, 4)),
    ],
)
def test_named_classes_limit_no_joint_in_pybullet(
    tmp_path: Path, attributes: str, pybullet: tuple[float, float], mujoco: tuple[float, float]
) -> None:
    assert _joint_of(tmp_path, attributes, as_mujoco=False) == pybullet
    assert _joint_of(tmp_path, attributes, as_mujoco=True) == mujoco


def test_axisangle_turns_bodies_in_mujoco_alone(tmp_path: Path) -> None:
    file = tmp_path / "file.xml"
    body = '<body axisangle="0 0 1 90" quat="2 2 0 0"/>'
    file.write_text(f"<mujoco><compiler/><worldbody>{body}</worldbody></mujoco>", encoding="utf-8")
    turned, left = (only(read_mjcf(file, as_mujoco=so)).pose.orientation for so in (True, False))
    assert_allclose(turned, (0, 0, HALF, HALF), rtol=0, atol=1e-6)
    assert_allclose(left, (HALF, 0, 0, HALF), rtol=0, atol=1e-6)


def test_a_class_that_does_not_exist_is_the_main_one_in_pybullet(tmp_path: Path) -> None:
    file = tmp_path / "file.xml"
    body = (
        '<body><joint name="j" class="nowhere"/><geom type="sphere" class="nowhere" rgba="1 0 0 1"/></body>'
    )
    defaults = '<default><joint limited="true" range="-1 2"/><geom size="3"/></default>'
    file.write_text(f"<mujoco><compiler angle='radian'/>{defaults}<worldbody>{body}</worldbody></mujoco>")
    limit = only(read_mjcf(file, as_mujoco=False)).robot.joints[0].limit
    assert (limit.lower, limit.upper) == (-1, 2)
    with pytest.raises(DescriptionError, match="there is no default class 'nowhere'"):
        read_mjcf(file, as_mujoco=True)
