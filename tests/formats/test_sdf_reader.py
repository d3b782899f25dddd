"""What Carom reads in SDF files beside what PyBullet does: includes, several trees, joints to the world."""

from __future__ import annotations

from pathlib import Path

import pytest
from scene_cases import DATA, sdf, sdf_collision, sdf_joint

from carom.description import JointType
from carom.errors import DescriptionError
from carom.formats.sdf import read_sdf
from carom.formats.search import AssetSearch

SDF = DATA / "sdf"
A = '<link name="a"><pose>1 0 0 0 0 0</pose></link>'
B = '<link name="b"><pose>1 0 2 0 0 0</pose></link>'
C = '<link name="c"><pose>0 5 0 0 0 0</pose></link>'


def write(folder: Path, text: str, name: str = "file.sdf") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def test_includes_are_found_and_placed() -> None:
    first, second, own = read_sdf(SDF / "includes.sdf")
    assert [placed.robot.name for placed in (first, second, own)] == ["crate", "second", "own"]
    assert first.pose.position == (9.0, 9.0, 9.0)
    assert second.pose.position == (1.0, 2.0, 3.0)
    assert first.robot.links == second.robot.links


@pytest.mark.parametrize(("text", "static"), [("true", True), ("1", True), ("false", False), ("yes", False)])
def test_static_models_are_fixed(text: str, static: bool, tmp_path: Path) -> None:
    file = write(tmp_path, f"<sdf><model name='m'><static>{text}</static>{A}</model></sdf>")
    (placed,) = read_sdf(file)
    assert placed.fixed_base == static
    (placed,) = read_sdf(file, words_are_true=False)
    assert placed.fixed_base == (text == "1")


def test_a_file_that_includes_itself_is_refused(tmp_path: Path) -> None:
    write(tmp_path, "<sdf><include><uri>b.sdf</uri></include></sdf>", "a.sdf")
    write(tmp_path, "<sdf><include><uri>a.sdf</uri></include></sdf>", "b.sdf")
    with pytest.raises(DescriptionError, match="includes itself"):
        read_sdf(tmp_path / "a.sdf")


def test_includes_cannot_multiply_without_end(tmp_path: Path) -> None:
    for level in range(12):
        below = f"<include><uri>{level + 1}.sdf</uri></include>"
        write(tmp_path, f"<sdf>{below * 4}</sdf>", f"{level}.sdf")
    write(tmp_path, sdf(A), "12.sdf")
    with pytest.raises(DescriptionError, match="513 included files are more than the 512"):
        read_sdf(tmp_path / "0.sdf")


@pytest.mark.parametrize("uri", ["<uri>model://nowhere</uri>", "<uri/>", ""])
def test_an_include_that_is_nowhere_is_left_out(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, uri: str
) -> None:
    """As worlds for Gazebo have them; PyBullet leaves out all."""
    file = write(tmp_path, f"<sdf><model name='m'>{A}</model>\n<include>{uri}</include></sdf>")
    assert [placed.robot.name for placed in read_sdf(file)] == ["m"]
    assert ":2: <include>: " in caplog.text
    assert "was not found" in caplog.text


def test_models_are_looked_for_where_scripts_have_files_searched(tmp_path: Path) -> None:
    part = tmp_path / "models" / "part"
    part.mkdir(parents=True)
    write(part, sdf(A), "model.sdf")
    file = write(tmp_path, "<sdf><include><uri>model://part</uri><name>copy</name></include></sdf>")
    (copy,) = read_sdf(file, search=AssetSearch(tmp_path / "models"))
    assert copy.robot.name == "copy"


def test_links_that_hang_on_nothing_are_bodies_of_their_own(tmp_path: Path) -> None:
    """PyBullet dies of them."""
    pair, single = read_sdf(write(tmp_path, sdf("<pose>0 0 1 0 0 0</pose>", A, C, B, sdf_joint())))
    assert [link.name for link in pair.robot.links] == ["a", "b"]
    assert pair.pose.position == (1.0, 0.0, 1.0)
    assert pair.robot.joints[0].frame.position == (0.0, 0.0, 2.0)
    assert [link.name for link in single.robot.links] == ["c"]
    assert single.pose.position == (0.0, 5.0, 1.0)


def test_a_loop_beside_a_tree_is_refused(tmp_path: Path) -> None:
    loop = sdf_joint() + sdf_joint(parent="b", child="a").replace('"j"', '"k"')
    with pytest.raises(DescriptionError, match="loop"):
        read_sdf(write(tmp_path, sdf(A, B, loop)))


def test_the_world_can_carry_joints(tmp_path: Path) -> None:
    (placed,) = read_sdf(write(tmp_path, sdf(A, sdf_joint(parent="world", child="a"))))
    root = placed.robot.links[placed.robot.root]
    assert (root.name, root.inertial.mass) == ("world", 0.0)
    assert placed.robot.joints[0].frame.position == (1.0, 0.0, 0.0)


def test_ball_joints_are_spherical(tmp_path: Path) -> None:
    (placed,) = read_sdf(write(tmp_path, sdf(A, B, sdf_joint(kind="ball"))))
    assert placed.robot.joints[0].type is JointType.SPHERICAL


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), float("inf")])
def test_a_scale_that_makes_no_sense_is_refused(scale: float) -> None:
    with pytest.raises(ValueError, match="scale must be positive"):
        read_sdf(SDF / "arm.sdf", scale=scale)


def test_a_missing_file_is_named() -> None:
    with pytest.raises(DescriptionError, match=r"no such file: nowhere\.sdf"):
        read_sdf(Path("nowhere.sdf"))


def test_scripts_find_files_in_their_search_path() -> None:
    assert len(read_sdf(Path("arm.sdf"), search=AssetSearch(SDF))) == 1


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (sdf("<link name='a'>", "<inertial><mass>x</mass></inertial></link>"), 3, "'x' is not a number"),
        (sdf(A, B, sdf_joint("<axis><xyz>0 0 0</xyz></axis>")), 4, "has no length"),
        (sdf(A, "<link name='b'><pose>1 2 nan 0 0 0</pose></link>"), 3, "not a finite number"),
        (sdf(sdf_collision("<box><size>1 -1 1</size></box>")), 2, "must not be negative"),
    ],
)
def test_errors_say_where(tmp_path: Path, text: str, line: int, message: str) -> None:
    with pytest.raises(DescriptionError, match=message) as raised:
        read_sdf(write(tmp_path, text))
    assert raised.value.line == line
    assert raised.value.element is not None
    assert "model" in raised.value.element
