"""DAE files for drawing: where normals and texture coordinates come from."""

import numpy as np
import pytest

from carom.formats.visuals.reader import read_mesh_visual

SOURCES = {
    "p": (3, "0 0 0  1 0 0  1 1 0  0 1 0"),
    "n": (3, "1 0 0  0 2 0  0 0 -1"),
    "t": (3, "0 0 9  2 0 9  2 2 9"),
}
CORNERS = "0 0 0  1 1 1  2 2 2"
INPUTS = {
    "VERTEX": '<input semantic="VERTEX" source="#v" offset="0"/>',
    "NORMAL": '<input semantic="NORMAL" source="#n" offset="1"/>',
    "TEXCOORD": '<input semantic="TEXCOORD" source="#t" offset="2"/>',
}
ALL_INPUTS = "".join(INPUTS.values())


@pytest.fixture
def read(tmp_path):
    def write_and_read(inputs=ALL_INPUTS, corners=CORNERS, vertices="", node=""):
        sources = "".join(
            f'<source id="{name}"><float_array>{text}</float_array><technique_common>'
            f'<accessor stride="{stride}"/></technique_common></source>'
            for name, (stride, text) in SOURCES.items()
        )
        path = tmp_path / "mesh.dae"
        path.write_text(
            f'<COLLADA><library_geometries><geometry id="g"><mesh>{sources}<vertices id="v">'
            f'<input semantic="POSITION" source="#p"/>{vertices}</vertices>'
            f"<triangles>{inputs}<p>{corners}</p></triangles></mesh></geometry></library_geometries>"
            f'<library_visual_scenes><visual_scene id="x"><node>{node}<instance_geometry url="#g"/></node>'
            "</visual_scene></library_visual_scenes>"
            '<scene><instance_visual_scene url="#x"/></scene></COLLADA>'
        )
        return read_mesh_visual(path)

    return write_and_read


def test_every_corner_has_its_own_normal_and_texture_coordinates(read):
    mesh = read()
    assert mesh.positions.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    assert mesh.normals.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, -1]]
    assert mesh.uvs.tolist() == [[0, 0], [2, 0], [2, 2]]
    assert mesh.triangles.tolist() == [[0, 1, 2]]


def test_normals_may_belong_to_the_vertices(read):
    mesh = read(INPUTS["VERTEX"], corners="2 1 0", vertices='<input semantic="NORMAL" source="#n"/>')
    assert mesh.normals.tolist() == [[0, 0, -1], [0, 1, 0], [1, 0, 0]]


@pytest.mark.parametrize(
    ("inputs", "corners"),
    [
        (INPUTS["VERTEX"], "0 1 2"),
        (INPUTS["VERTEX"] + INPUTS["NORMAL"], "0 0 1 1 2 9"),
        (INPUTS["VERTEX"] + INPUTS["NORMAL"].replace("#n", "#m"), "0 0 1 1 2 2"),
    ],
)
def test_without_usable_normals_triangles_are_flat(read, inputs, corners):
    mesh = read(inputs, corners)
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3
    assert mesh.uvs.tolist() == [[0.5, 0.5]] * 3


def test_normals_turn_and_stretch_with_the_scene(read):
    node = "<rotate>0 0 1 90</rotate><scale>2 1 1</scale>"
    mesh = read(node=node)
    assert mesh.positions == pytest.approx(np.array([[0, 0, 0], [0, 2, 0], [-1, 2, 0]]), abs=1e-6)
    assert mesh.normals == pytest.approx(np.array([[0, 1, 0], [-1, 0, 0], [0, 0, -1]]), abs=1e-6)
