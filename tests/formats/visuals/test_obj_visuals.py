"""OBJ files for drawing: corners of every form, normals, materials, and clear errors."""

import logging
from pathlib import Path
from time import process_time

import numpy as np
import pytest

from carom.errors import DescriptionError
from carom.formats.visuals.mtl import read_materials
from carom.formats.visuals.obj import read_obj_visual
from carom.formats.visuals.reader import read_mesh_visual
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvn 1 0 0\nvn 0 1 0\n"


@pytest.fixture
def read(tmp_path):
    def write_and_read(text, name="mesh.obj"):
        path = tmp_path / name
        path.write_bytes(text.encode())
        return read_obj_visual(path)

    return write_and_read


def corner_values(mesh, values):
    return np.asarray(values)[mesh.triangles].tolist()


@pytest.mark.parametrize("face", ["f 1 2 3", "f -4 -3 -2", "f\t1\t2 3  "])
def test_faces_without_normals_are_flat_and_have_no_texture_coordinates(read, face):
    mesh = read(SQUARE + face)
    assert corner_values(mesh, mesh.positions) == [[[0, 0, 0], [1, 0, 0], [1, 1, 0]]]
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3


@pytest.mark.parametrize("face", ["f 1/1/1 2/2/1 3/3/2", "f -4/-3/-2 -3/-2/-2 -2/-1/-1"])
def test_full_corners(read, face):
    mesh = read(SQUARE + face)
    assert corner_values(mesh, mesh.uvs) == [[[0, 0], [2, 0], [2, 2]]]
    assert corner_values(mesh, mesh.normals) == [[[1, 0, 0], [1, 0, 0], [0, 1, 0]]]


def test_corners_with_texture_coordinates_only(read):
    mesh = read(SQUARE + "f 1/1 2/2 3/3")
    assert corner_values(mesh, mesh.uvs) == [[[0, 0], [2, 0], [2, 2]]]
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3


def test_corners_with_normals_only(read):
    mesh = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 2 0\nf 1//1 2//1 3//1")
    assert mesh.normals.tolist() == [[0, 1, 0]] * 3
    assert mesh.uvs.tolist() == [[NO_TEXTURE_UV, NO_TEXTURE_UV]] * 3


def test_corners_of_mixed_form(read):
    mesh = read(SQUARE + "f 1//1 2/2/ 3\nf 1/1/1 3/3/1 4/1/1")
    assert corner_values(mesh, mesh.normals) == [[[0, 0, 1]] * 3, [[1, 0, 0]] * 3]
    assert corner_values(mesh, mesh.uvs)[1] == [[0, 0], [2, 2], [0, 0]]


def test_polygons_become_fans(read):
    mesh = read(SQUARE + "f 1 2 3 4")
    assert corner_values(mesh, mesh.positions) == [
        [[0, 0, 0], [1, 0, 0], [1, 1, 0]],
        [[0, 0, 0], [1, 1, 0], [0, 1, 0]],
    ]


def test_equal_corners_are_one_vertex(read):
    assert len(read(SQUARE + "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/1/1").positions) == 4


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        (SQUARE + "f 1 2 9", 10, "vertex outside 1..4"),
        (SQUARE + "f 1/1 2/2 3/4", 10, "texture coordinate outside 1..3"),
        (SQUARE + "f 1//1 2//2 3//3", 10, "normal outside 1..2"),
        (SQUARE + "f 1 2 -5", 10, "vertex outside"),
        (SQUARE + "f 1 2 3\nf 1 x 3", 11, "whole numbers"),
        (SQUARE + "f 1/1/1 2/2/2 3/3/q", 10, "whole numbers"),
        ("v 0 0 0\nv 0 0\nf 1 1 1", 2, "3 numbers"),
        ("v 0 0 0\nvt\nf 1 1 1", 2, "1 numbers"),
        ("v 0 nan 0\nf 1 1 1", 1, "not finite"),
    ],
)
def test_errors_name_the_line(read, text, line, reason):
    with pytest.raises(DescriptionError, match=reason) as caught:
        read(text)
    assert caught.value.line == line


def test_the_first_material_with_a_texture_serves_the_whole_mesh(read, tmp_path):
    (tmp_path / "some.mtl").write_text(
        "newmtl plain\nKd 1 0 0\nnewmtl wood\nKd 0.5 0.25 1\nd 0.5\nmap_Kd -s 1 1 1 wood.png\n"
        "newmtl unused\nmap_Kd other.png\n"
    )
    mesh = read("mtllib some.mtl\n" + SQUARE + "usemtl plain\nf 1 2 3\nusemtl wood\nf 1 3 4")
    assert mesh.texture_file == tmp_path / "wood.png"
    assert mesh.material_rgba == (0.5, 0.25, 1.0, 0.5)


@pytest.mark.parametrize(("between", "texture"), [("", None), ("o b\n", "wood.png"), ("g b\n", "wood.png")])
def test_a_group_has_the_material_at_its_end(read, tmp_path, between, texture):
    (tmp_path / "some.mtl").write_text("newmtl plain\nKd 1 0 0\nnewmtl wood\nmap_Kd wood.png\n")
    mesh = read(
        f"mtllib some.mtl\n{SQUARE}usemtl wood\nf 1 2 3\n{between}usemtl plain\nf 1 3 4",
        f"mesh{len(between)}.obj",
    )
    assert mesh.texture_file == (tmp_path / texture if texture else None)


def test_without_textures_the_last_material_gives_the_colour(read, tmp_path):
    (tmp_path / "some.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nTr 0.25\n")
    mesh = read("mtllib some.mtl\n" + SQUARE + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4")
    assert mesh.material_rgba == (0.0, 1.0, 0.0, 0.75)
    assert mesh.texture_file is None


def test_a_missing_material_file_is_no_error(read, caplog):
    caplog.set_level(logging.INFO, "carom")
    mesh = read("mtllib nowhere.mtl\n" + SQUARE + "usemtl a\nf 1 2 3")
    assert mesh.material_rgba is None
    assert "nowhere.mtl" in caplog.text


def test_broken_lines_of_a_material_file_are_skipped(tmp_path, caplog):
    path = tmp_path / "broken.mtl"
    path.write_text("newmtl a\nKd red\nd\nmap_Kd my wood.png\n")
    material = read_materials(path)["a"]
    assert material.rgba == (0.0, 0.0, 0.0, 1.0)
    assert material.texture == tmp_path / "my wood.png"
    assert "broken.mtl:2" in caplog.text


def test_a_changed_file_is_read_anew(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text(SQUARE + "f 1 2 3")
    assert len(read_mesh_visual(path).triangles) == 1
    path.write_text(SQUARE + "f 1 2 3 4")
    assert len(read_mesh_visual(path).triangles) == 2


@pytest.mark.parametrize(
    "lines",
    [
        b"mtllib\n" * 100_000,
        b"mtllib missing.mtl\n" * 100_000,
        b"".join(b"mtllib %d.mtl\n" % number for number in range(100_000)),
        b"".join(b"usemtl %d\nf 1 2 3\n" % number for number in range(50_000)),
    ],
    ids=["no name", "one name", "many names", "many materials"],
)
def test_materials_take_linear_time(tmp_path: Path, lines: bytes) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + lines)
    start = process_time()
    read_obj_visual(path)
    assert process_time() - start < 3.0
