"""The order in which places are searched for files."""

from __future__ import annotations

from pathlib import Path

import pytest

from carom import World
from carom.errors import DescriptionError
from carom.formats.search import AssetSearch


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory three levels below a fresh one."""
    work = tmp_path / "top" / "middle" / "work"
    work.mkdir(parents=True)
    monkeypatch.chdir(work)
    return tmp_path


def put(file: Path) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("x")
    return file


def same(found: Path | None, expected: Path) -> bool:
    return found is not None and found.resolve() == expected.resolve()


def test_scripts_search_as_named_then_data_folders_then_the_additional_directory(
    place: Path,
) -> None:
    search = AssetSearch(place / "extra")
    assert search.find("r.urdf") is None
    additional = put(place / "extra" / "r.urdf")
    assert same(search.find("r.urdf"), additional)
    assert same(search.find("/r.urdf"), additional)
    above = put(place / "top" / "middle" / "data" / "r.urdf")
    assert same(search.find("r.urdf"), above)
    near = put(place / "top" / "middle" / "work" / "data" / "r.urdf")
    assert same(search.find("r.urdf"), near)
    here = put(place / "top" / "middle" / "work" / "r.urdf")
    assert same(search.find("r.urdf"), here)
    assert same(search.find(additional), additional)


def test_a_relative_additional_directory_counts_from_the_working_directory(place: Path) -> None:
    additional = put(place / "top" / "middle" / "extra" / "r.urdf")
    assert same(AssetSearch(Path("../extra")).find("r.urdf"), additional)


def test_directories_and_impossible_names_are_not_files(place: Path) -> None:
    assert AssetSearch(place).find("top") is None
    assert AssetSearch(place).find("to\0p") is None
    assert AssetSearch(place).find("") is None


def test_robot_files_find_meshes_in_the_working_directory_then_beside_them_then_above(place: Path) -> None:
    source = put(place / "robots" / "arm" / "urdf" / "arm.urdf")
    search = AssetSearch(place / "extra")
    put(place / "extra" / "m.obj")
    assert search.find_referenced("m.obj", source) is None, "the additional directory is for scripts"
    two_above_work = put(place / "top" / "m.obj")
    assert same(search.find_referenced("m.obj", source), two_above_work)
    above = put(place / "robots" / "m.obj")
    assert same(search.find_referenced("m.obj", source), above)
    beside = put(place / "robots" / "arm" / "urdf" / "m.obj")
    assert same(search.find_referenced("m.obj", source), beside)
    here = put(place / "top" / "middle" / "work" / "m.obj")
    assert same(search.find_referenced("m.obj", source), here)


@pytest.mark.parametrize("scheme", ["package://", "model://", "file://", "file://package://"])
def test_schemes_are_taken_off(place: Path, scheme: str) -> None:
    source = put(place / "robots" / "arm" / "arm.urdf")
    mesh = put(place / "robots" / "meshes" / "m.obj")
    assert same(AssetSearch().find_referenced(f"{scheme}meshes/m.obj", source), mesh)


def test_absolute_references_are_found(place: Path) -> None:
    source = put(place / "robots" / "arm.urdf")
    mesh = put(place / "elsewhere" / "m.obj")
    assert same(AssetSearch().find_referenced(str(mesh), source), mesh)
    assert same(AssetSearch().find_referenced(f"file://{mesh}", source), mesh)


@pytest.mark.parametrize("load", ["load_urdf", "load_mjcf", "load_sdf"])
def test_the_text_of_a_file_is_no_path(load: str) -> None:
    with pytest.raises(
        DescriptionError, match=r"the text of a file, not its path: `World\.load` takes texts"
    ):
        getattr(World(), load)('<robot name="r"><link name="a"/></robot>')
