"""Damaged mesh and material files, read for drawing: each either can be drawn or is refused by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from load_cases import DATA
from test_urdf_fuzz import MUTATIONS, PATIENT, mutated
from tests.thorough.profiles import cases

from carom.errors import DescriptionError
from carom.formats.visuals.mtl import read_materials
from carom.formats.visuals.reader import read_mesh_visual

MATERIALS = b"newmtl red\nKd 1 0 0\nd 0.5\nmap_Kd -s 1 1 1 red.png\nnewmtl blue\nKd 0 0 1\nTr 0.25\n"
TEXTURED = b"""mtllib m.mtl
o box
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5
vt 0 0\nvt 2 0\nvt 2 2\nvn 1 0 0\nvn 0 1 0
usemtl red
f 1/1/1 2/2/1 3/3/2\nf -4//1 -3//2 -1//1
usemtl blue
f 1 2 3 4
"""
FILES = {
    "textured.obj": TEXTURED,
    **{name: (DATA / "meshes" / name).read_bytes() for name in ("two_boxes.obj", "wedge.stl", "wedge.dae")},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("looks")


@pytest.mark.parametrize("name", FILES)
@settings(max_examples=cases(60), **PATIENT)
@given(MUTATIONS)
def test_damaged_meshes_can_be_drawn_or_are_refused(
    folder: Path, name: str, mutations: list[tuple[str, float, float, bytes]]
) -> None:
    (folder / "m.mtl").write_bytes(MATERIALS)
    file = folder / name
    file.write_bytes(mutated(FILES[name], mutations))
    try:
        mesh = read_mesh_visual(file)
    except DescriptionError as error:
        assert error.file == file
        return
    assert np.isfinite(mesh.positions).all()
    assert np.isfinite(mesh.normals).all()
    assert not mesh.triangles.size or 0 <= mesh.triangles.min() <= mesh.triangles.max() < len(mesh.positions)


@settings(max_examples=cases(120), **PATIENT)
@given(MUTATIONS)
@example([("replace", MATERIALS.index(b"1 0 0") / len(MATERIALS), 1e-3, b"nan")])
def test_damaged_materials_have_colours(
    folder: Path, mutations: list[tuple[str, float, float, bytes]]
) -> None:
    file = folder / "damaged.mtl"
    file.write_bytes(mutated(MATERIALS, mutations))
    for material in read_materials(file).values():
        assert len(material.rgba) == 4
        assert np.isfinite(material.rgba).all()
