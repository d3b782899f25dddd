"""What the URDF reader makes of single elements, and how it words its errors."""

from __future__ import annotations

import json
import logging
import math
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from load_cases import LIMITS
from tests.each import each

from carom.description import (
    Box,
    Capsule,
    Cylinder,
    JointType,
    Material,
    Mesh,
    Mimic,
    Plane,
    Robot,
    SafetyController,
    SignedDistanceField,
    Sphere,
)
from carom.errors import DescriptionError
from carom.files.budget import Budget
from carom.formats.search import AssetSearch
from carom.formats.urdf import read_urdf

Read = Callable[..., Robot]
INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Reads the inside of a `<robot>`."""

    def read(*parts: str, scale: float = 1.0) -> Robot:
        file = tmp_path / "r.urdf"
        file.write_text('<robot name="r">\n' + "\n".join(parts) + "\n</robot>", encoding="utf-8")
        return read_urdf(file, scale=scale)

    return read


def link(name: str = "a", inside: str = "") -> str:
    return f'<link name="{name}">{INERTIAL}{inside}</link>'


def joint(
    inside: str = "", kind: str = "continuous", name: str = "j", parent: str = "a", child: str = "b"
) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


def refusal(read: Read, *parts: str) -> DescriptionError:
    with pytest.raises(DescriptionError) as raised:
        read(*parts)
    return raised.value


def test_a_file_is_kept_as_read_until_a_mesh_that_it_names_is_found_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "robots").mkdir()
    file, near = tmp_path / "robots" / "r.urdf", tmp_path / "robots" / "m.stl"
    mesh = '<collision><geometry><mesh filename="m.stl"/></geometry></collision>'
    file.write_text(f'<robot name="r">{link("a", mesh)}</robot>')
    # What has just been written may still change within the same tick of the clock, and is not kept.
    os.utime(file, (1e9, 1e9))
    near.write_text("solid")
    monkeypatch.chdir(tmp_path)

    def found() -> tuple[Robot, Path]:
        robot = read_urdf(file)
        shape = robot.links[0].collisions[0].geometry
        assert isinstance(shape, Mesh)
        return robot, shape.path.resolve()

    first, path = found()
    assert path == near.resolve()
    assert found()[0] is first
    here = tmp_path / "m.stl"
    here.write_text("solid")
    second, path = found()
    assert path == here.resolve()
    assert second is not first


def test_shapes_are_read_and_scaled(read: Read, tmp_path: Path) -> None:
    (tmp_path / "m.stl").write_text("solid")
    (tmp_path / "d.cdf").write_text("")
    shapes = [
        '<sphere radius="1"/>',
        '<box size="1 2 3"/>',
        '<cylinder radius="1" length="4"/>',
        '<capsule radius="0.5" length="1"/>',
        '<plane normal="0 3 4"/>',
        '<mesh filename="m.stl" scale="1 2 -3"/>',
        '<cdf filename="d.cdf"/>',
    ]
    inside = "".join(f"<collision><geometry>{shape}</geometry></collision>" for shape in shapes)
    robot = read(link(inside=inside), scale=2.0)
    assert [collision.geometry for collision in robot.links[0].collisions] == [
        Sphere(2.0),
        Box((1.0, 2.0, 3.0)),
        Cylinder(2.0, 8.0),
        Capsule(1.0, 2.0),
        Plane((0.0, 0.6, 0.8)),
        Mesh(tmp_path / "m.stl", (2.0, 4.0, -6.0)),
        SignedDistanceField(tmp_path / "d.cdf"),
    ]


def test_collisions_carry_name_pose_filter_and_concavity(read: Read, tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("")
    robot = read(
        link(
            inside='<collision name="c" group="4" mask="-1" concave="no"><origin xyz="1 2 3"/>'
            '<geometry><mesh filename="m.obj"/></geometry></collision>'
        ),
        scale=0.5,
    )
    (collision,) = robot.links[0].collisions
    assert (collision.name, collision.group, collision.mask) == ("c", 4, -1)
    assert collision.frame.position == (0.5, 1.0, 1.5)
    assert isinstance(collision.geometry, Mesh)
    assert collision.geometry.concave


@each(
    ("text", "bits"),
    [
        ("non_gripper", 0),
        ("", 0),
        ("nan", 0),
        ("0x2", 2),
        ("2abc", 2),
        ("2.9", 2),
        ("1e1", 10),
        (" +3 ", 3),
        ("4294967295", -1),
        ("99999999999", -(1 << 31)),
        ("-1e999", -(1 << 31)),
    ],
)
def test_filters_are_read_as_pybullet_reads_numbers(read: Read, text: str, bits: int) -> None:
    shape = '<geometry><sphere radius="1"/></geometry>'
    robot = read(link(inside=f'<collision group="{text}" mask="{text}">{shape}</collision>'))
    (collision,) = robot.links[0].collisions
    assert (collision.group, collision.mask) == (bits, bits)


def test_materials_are_global_inline_or_defined_later(read: Read, tmp_path: Path) -> None:
    (tmp_path / "t.png").write_text("")

    def visual(material: str) -> str:
        return f'<visual><geometry><sphere radius="1"/></geometry>{material}</visual>'

    robot = read(
        '<material name="red"><color rgba="1 0 0 1"/></material>',
        '<material name="red"><color rgba="0 0 0 1"/></material>',
        link(
            "a",
            visual('<material name="red"/>')
            + visual('<material name="late"/>')
            + visual('<material name="unknown"/>')
            + visual("")
            + visual('<material name="red"><color rgba="0 1 0 1"/><specular rgb="1 1 1"/></material>')
            + visual('<material name="red"/>'),
        ),
        link("b", visual('<material name="late"><texture filename="t.png"/></material>')),
        joint(),
    )
    green = Material("red", (0.0, 1.0, 0.0, 1.0), (1.0, 1.0, 1.0))
    late = Material("late", texture=tmp_path / "t.png")
    assert [shape.material for shape in robot.links[0].visuals] == [
        Material("red", (1.0, 0.0, 0.0, 1.0)),
        late,
        Material("unknown"),
        None,
        green,
        green,
    ]
    assert robot.links[1].visuals[0].material == late
    assert set(robot.materials) == {green, late}


def test_user_data_is_kept_for_robot_link_and_visual(read: Read) -> None:
    def data(value: str) -> str:
        return f'<bullet><user-data key="k">{value}</user-data></bullet>'

    shape = '<visual><geometry><sphere radius="1"/></geometry>' + data("visual") + "</visual>"
    robot = read(data("first"), data("robot &amp; more"), link(inside=shape + data("link")))
    assert robot.user_data == {"k": "robot & more"}
    assert robot.links[0].user_data == {"k": "link"}
    assert robot.links[0].visuals[0].user_data == {"k": "visual"}


def test_contact_parameters_complete_each_other(read: Read) -> None:
    def contact(inside: str) -> str:
        return f"<contact>{inside}</contact>"

    robot = read(
        link("a", contact('<stiffness value="7"/><friction_anchor/>')),
        link("b", contact('<damping value="3"/><inertia_scaling value="2"/>')),
        link("c"),
        joint(),
        joint(name="k", child="c"),
    )
    first, second, third = (item.contact for item in robot.links)
    assert (first.stiffness, first.damping, first.friction_anchor) == (7.0, 1.0, True)
    assert (second.stiffness, second.damping, second.inertia_scaling) == (1e4, 3.0, 2.0)
    assert (third.stiffness, third.lateral_friction, third.friction_anchor) == (None, None, False)


def test_joints_carry_everything_the_file_states(read: Read) -> None:
    robot = read(
        link("a"),
        link("b"),
        joint(
            '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 2"/>'
            '<limit lower="-1" upper="2" effort="3" velocity="4"/><dynamics damping="5" friction="6"/>'
            '<mimic joint="k" multiplier="-2" offset="0.5"/>'
            '<safety_controller soft_lower_limit="-0.5" soft_upper_limit="1.5" k_position="7"'
            ' k_velocity="8"/>',
            kind="prismatic",
        ),
        scale=2.0,
    )
    (only,) = robot.joints
    assert (only.name, only.type, only.parent, only.child) == ("j", JointType.PRISMATIC, 0, 1)
    assert only.frame.position == (2.0, 0.0, 0.0)
    assert only.frame.orientation == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert (only.axis, only.axis_length) == ((0.0, 0.0, 1.0), 2.0)
    assert (only.limit.lower, only.limit.upper) == (-2.0, 4.0)
    assert (only.limit.effort, only.limit.velocity, only.limit.twist) == (3.0, 4.0, -1.0)
    assert (only.damping, only.friction) == (5.0, 6.0)
    assert only.mimic == Mimic("k", -2.0, 1.0)
    assert only.safety == SafetyController(-1.0, 3.0, 7.0, 8.0)


@pytest.mark.parametrize("element", ['<mimic multiplier="x"/>', '<safety_controller k_velocity="x"/>'])
def test_bad_elements_nobody_simulates_are_ignored_with_a_warning(
    read: Read, caplog: pytest.LogCaptureFixture, element: str
) -> None:
    robot = read(link("a"), link("b"), joint(element))
    assert (robot.joints[0].mimic, robot.joints[0].safety) == (None, None)
    assert "ignored" in caplog.text


def test_links_without_inertial_weigh_a_kilogram_but_for_the_world(
    read: Read, caplog: pytest.LogCaptureFixture
) -> None:
    links = [f'<link name="{name}"/>' for name in ("world", "a", "b")]
    robot = read(*links, joint(), joint(name="w", parent="world", child="a"))
    assert [item.inertial.mass for item in robot.links] == [0.0, 1.0, 1.0]
    assert robot.links[robot.root].name == "world"
    assert [record.getMessage().endswith("for a, b") for record in caplog.records] == [True]


def collision(shape: str) -> str:
    return f"<collision>\n<geometry>{shape}</geometry></collision>"


def inertial(mass: str) -> str:
    return f'<inertial>\n<inertia ixx="1" iyy="1" izz="1"/>\n<mass value="{mass}"/></inertial>'


A, B = link("a"), link("b")

# What stands inside <robot>, from line 2 on; the line, the element and some words of the error.
BROKEN = [
    ([f'<link name="b">{inertial("nan")}</link>'], 4, "<mass>", "value='nan' is not a finite number"),
    ([f'<link name="b">{inertial("heavy")}</link>'], 4, "<mass>", "value='heavy' is not a number"),
    ([f'<link name="b">{inertial("0x10")}</link>'], 4, "<mass>", "value='0x10' is not a number"),
    ([f'<link name="b">{inertial("-2")}</link>'], 4, "<mass>", "must not be negative"),
    ([link(inside=collision('<box size="1 1 inf"/>'))], 3, "<box>", "'1 1 inf' is not finite"),
    ([link(inside=collision('<box size="1 1 x"/>'))], 3, "<box>", "'x' is not a number"),
    ([link(inside=collision('<sphere radius="-1"/>'))], 3, "<sphere>", "must not be negative"),
    ([link(inside=collision('<cylinder radius="${r}" length="1"/>'))], 3, "<cylinder>", "${r}"),
    ([A, B, joint("<axis xyz='0 0 " + "9" * 5000 + "'/>")], 4, "<axis>", "9999...'"),
    ([A, B, joint('<limit lower="nan"/>')], 4, "<limit>", "lower='nan' is not a number"),
    ([A, B, joint('<axis xyz="0 0 0"/>')], 4, "<axis>", "no length"),
    ([A, B, joint('<axis xyz="0 0 1e300"/>')], 4, "<axis>", "out of range"),
    ([A, B, joint(), joint(name="k")], 5, '<joint name="k">', "is already the child of joint 'j'"),
    ([A, B], 1, '<robot name="r">', "2 root links, where one is needed: 'a', 'b'"),
    ([A, A], 3, '<link name="a">', "taken already, on line 2"),
    ([A, link("b"), joint(child="c")], 4, "<child>", "there is no link 'c'"),
    (
        [A, B, link("c"), joint(parent="c"), joint(name="k", parent="b", child="c")],
        1,
        '<robot name="r">',
        "links form a loop: 'b', 'c'",
    ),
    (["<deformable/>", A], 2, "<deformable>", "attribute 'name' is missing"),
    (['<deformable name="a"/>', A], 2, '<deformable name="a">', "<visual> is missing"),
]


@pytest.mark.parametrize(("parts", "line", "element", "reason"), BROKEN)
def test_errors_name_file_line_element_and_reason(
    read: Read, tmp_path: Path, parts: list[str], line: int, element: str, reason: str
) -> None:
    error = refusal(read, *parts)
    assert error.file == tmp_path / "r.urdf"
    assert error.line == line
    assert error.element is not None
    assert error.element.endswith(element.rsplit(" > ", maxsplit=1)[-1])
    assert reason in error.reason
    assert str(error) == f"{error.file}:{line}: {error.element}: {error.reason}"


LIMITS_OF_PYBULLET = json.loads(
    (Path(__file__).parent / "answers" / "limits_oracle.json").read_text(encoding="utf-8")
)


@each("case", LIMITS)
def test_limits_are_read_as_by_pybullet(case: str, tmp_path: Path) -> None:
    file = tmp_path / "limits.urdf"
    file.write_text(LIMITS[case], encoding="utf-8")
    limit = read_urdf(file).joints[0].limit
    assert [limit.lower, limit.upper, limit.effort, limit.velocity] == LIMITS_OF_PYBULLET[case]


@pytest.mark.parametrize("text", ["pi", "", "1.0 2.0"])
def test_limits_that_are_no_single_number_are_warned_of(
    read: Read, text: str, caplog: pytest.LogCaptureFixture
) -> None:
    read(A, B, joint(f'<limit lower="{text}"/>'))
    (record,) = caplog.records
    assert f"lower='{text}' is" in record.getMessage()


@pytest.mark.parametrize("text", ["0.5", " 0.5 ", "+.5", "5e-1", "0.5f", "0.5 metres", "0.5,"])
def test_numbers_are_read_as_far_as_they_go(read: Read, text: str) -> None:
    robot = read(link(inside=f'<collision><geometry><sphere radius="{text}"/></geometry></collision>'))
    assert robot.links[0].collisions[0].geometry == Sphere(0.5)


@pytest.mark.parametrize(
    ("text", "position"),
    [
        ("1 2 3", (1.0, 2.0, 3.0)),
        ("  1\t2\n3 4 ", (1.0, 2.0, 3.0)),
        ("1, 2, 3", (1.0, 2.0, 3.0)),
        ("1 2", (0.0, 0.0, 0.0)),
        ("", (0.0, 0.0, 0.0)),
        ("$(arg x 1) 0.5", (0.0, 0.0, 1.0)),
    ],
)
def test_positions_are_read_as_far_as_they_go(read: Read, text: str, position: tuple[float, ...]) -> None:
    robot = read(link("a"), link("b"), joint(f'<origin xyz="{text}"/>'))
    assert robot.joints[0].frame.position == position


def test_warnings_name_file_and_line(read: Read, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        read(link("a"), link("b"), joint('<origin xyz="1 2"/>'))
    assert f"{tmp_path / 'r.urdf'}:4: <origin>" in caplog.text


@pytest.mark.parametrize("scale", [0.0, -1.0, math.nan, math.inf])
def test_the_scale_must_be_positive(read: Read, scale: float) -> None:
    with pytest.raises(ValueError, match="scale"):
        read(link(), scale=scale)


def test_missing_and_huge_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match=r"no such file: nowhere\.urdf"):
        read_urdf(Path("nowhere.urdf"), search=AssetSearch(tmp_path))
    huge = tmp_path / "huge.urdf"
    with open(huge, "wb") as stream:
        stream.truncate(Budget().document_bytes + 1)
    with pytest.raises(DescriptionError, match="are more than"):
        read_urdf(huge)


def test_files_are_found_in_the_additional_directory(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{link()}</robot>')
    robot = read_urdf(Path("r.urdf"), search=AssetSearch(tmp_path))
    assert robot.source == tmp_path / "r.urdf"


class TestCache:
    """Reloading is fast where nothing has changed, and only there."""

    @pytest.fixture
    def file(self, tmp_path: Path) -> Path:
        (tmp_path / "above").mkdir()
        file = tmp_path / "above" / "r.urdf"
        mesh = '<collision><geometry><mesh filename="m.obj"/></geometry></collision>'
        file.write_text(f'<robot name="one">{link(inside=mesh)}</robot>')
        (tmp_path / "m.obj").write_text("")
        os.utime(file, (1e9, 1e9))
        return file

    def test_an_unchanged_file_is_not_read_again(self, file: Path) -> None:
        assert read_urdf(file) is read_urdf(file)

    def test_options_are_told_apart(self, file: Path) -> None:
        assert read_urdf(file) is not read_urdf(file, scale=2.0)
        assert read_urdf(file).links[0].collisions != read_urdf(file, scale=2.0).links[0].collisions

    def test_a_changed_file_is_read_again(self, file: Path) -> None:
        assert read_urdf(file).name == "one"
        file.write_text(file.read_text().replace("one", "two"))
        assert read_urdf(file).name == "two"

    def test_a_mesh_that_appears_nearer_is_noticed(self, file: Path) -> None:
        def mesh_of(robot: Robot) -> Path:
            geometry = robot.links[0].collisions[0].geometry
            assert isinstance(geometry, Mesh)
            return geometry.path

        assert mesh_of(read_urdf(file)) == file.parents[1] / "m.obj"
        (file.parent / "m.obj").write_text("")
        assert mesh_of(read_urdf(file)) == file.parent / "m.obj"

    def test_a_mesh_that_disappears_is_noticed(self, file: Path) -> None:
        read_urdf(file)
        (file.parents[1] / "m.obj").unlink()
        with pytest.raises(DescriptionError, match=r"m\.obj"):
            read_urdf(file)
