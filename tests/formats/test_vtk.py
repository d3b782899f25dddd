"""Tetrahedra from VTK files."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.errors import DescriptionError
from carom.meshes.vtk import read_vtk

HEADER = "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
POINTS = "POINTS 4 double\n0 0 0 1 0 0\n0 1 0\n0 0 1\n"
CELLS = "CELLS 1 5\n4 0 1 2 3\n"
WHOLE = HEADER + POINTS + "\n" + CELLS + "\nCELL_TYPES 1\n10\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "mesh.vtk"
    path.write_text(text)
    return path


def test_points_and_tetrahedra(tmp_path: Path) -> None:
    mesh = read_vtk(written(tmp_path, WHOLE))
    assert mesh.points.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert mesh.tetras.tolist() == [[0, 1, 2, 3]]


def test_other_cells_and_data_are_left_out(tmp_path: Path) -> None:
    text = HEADER + POINTS + "CELLS 2 9\n3 0 1 2\n4 3 2 1 0\nCELL_TYPES 2\n5\n10\nPOINT_DATA 4\nwhatever"
    assert read_vtk(written(tmp_path, text)).tetras.tolist() == [[3, 2, 1, 0]]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("# vtk", "#vtk"),
        ("CELLS 1 5", "CELLS 1 1"),
        ("CELL_TYPES 1\n10\n", "CELL_TYPES 10"),
        ("CELL_TYPES 1\n10", ""),
    ],
)
def test_slips_of_files_that_bullet_reads(tmp_path: Path, right: str, wrong: str) -> None:
    assert right in WHOLE
    assert read_vtk(written(tmp_path, WHOLE.replace(right, wrong))).tetras.tolist() == [[0, 1, 2, 3]]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", r"mesh\.vtk:1: it does not begin with"),
        (WHOLE.replace("ASCII", "BINARY"), r"mesh\.vtk:3: it is binary; write it as ASCII"),
        (WHOLE.replace("ASCII", "text"), r"mesh\.vtk:3: the third line has to be ASCII"),
        (WHOLE.replace("UNSTRUCTURED_GRID", "POLYDATA"), r"mesh\.vtk:4: the data set has to be an"),
        (WHOLE.replace("POINTS 4", "POINTS -4"), r"mesh\.vtk:5: POINTS needs a whole number"),
        (WHOLE.replace("POINTS 4", "POINTS 99999999999"), r"mesh\.vtk:5: 99999999999 vertices"),
        (WHOLE.replace("0 1 0\n", "0 x 0\n"), r"mesh\.vtk:7: 'x' is no coordinate"),
        (WHOLE.replace("0 0 1\n", "0 0 nan\n"), "a point is not finite"),
        (WHOLE.replace("CELLS 1 5", "CELLS 2 5"), r"mesh\.vtk:13: 'CELL_TYPES' is no length of a cell"),
        (WHOLE.replace("4 0 1 2 3", "9 0 1 2 3"), r"mesh\.vtk:13: 'CELL_TYPES' is no index"),
        (WHOLE.replace("4 0 1 2 3", "0 0 1 2 3"), r"mesh\.vtk:11: a cell has from 1 to 10000 corners, not 0"),
        (WHOLE.replace("4 0 1 2 3", "4 0 1 2 4"), r"a cell names a point outside 0\.\.3"),
        (WHOLE.replace("4 0 1 2 3", "4 0 1 2 1.5"), r"mesh\.vtk:11: '1\.5' is no index"),
        (WHOLE.replace("CELL_TYPES 1\n10", "CELL_TYPES 1\n5"), "there are no tetrahedra"),
        (WHOLE.replace("CELL_TYPES 1", "CELL_TYPES 2"), "the file ends where the next type should be"),
        (WHOLE.replace("CELL_TYPES", "CELL_KINDS"), r"mesh\.vtk:13: 'CELL_KINDS' is no section"),
        (HEADER + POINTS, "there are no tetrahedra"),
    ],
)
def test_broken_files_are_refused_with_file_and_line(tmp_path: Path, text: str, problem: str) -> None:
    with pytest.raises(DescriptionError, match=problem):
        read_vtk(written(tmp_path, text))


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="cannot be read"):
        read_vtk(tmp_path / "missing.vtk")


@given(st.data())
def test_any_damage_is_an_error_or_a_mesh(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    text = bytearray(WHOLE.encode())
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(text) - 1))
        text[place] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("vtk") / "mesh.vtk"
    path.write_bytes(bytes(text[: data.draw(st.integers(1, len(text)))]))
    try:
        mesh = read_vtk(path)
    except DescriptionError:
        return
    assert mesh.tetras.max() < len(mesh.points)
