"""Triangles from OBJ, STL and DAE files."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from load_cases import DATA

from carom.errors import DescriptionError
from carom.meshes import MeshPart, read_field_bounds, read_mesh
from carom.meshes.part import cut_into_fans

Write = Callable[[str, str | bytes], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file and returns its path."""

    def write(name: str, content: str | bytes) -> Path:
        file = tmp_path / name
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        return file

    return write


def volume(part: MeshPart) -> float:
    """Volume enclosed by a closed surface; negative where triangles face inwards."""
    a, b, c = (part.vertices[part.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def stl(triangles: np.ndarray, count: int | None = None) -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *triangle.ravel(), 0) for triangle in triangles)
    return b"solid, says the header".ljust(80) + struct.pack("<I", count or len(triangles)) + body


TRIANGLES = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 0, 1], [0, 2, 1]]], dtype=float)


class TestObj:
    def test_groups_and_objects_become_parts_with_outward_triangles(self) -> None:
        lower, upper = read_mesh(DATA / "meshes" / "two_boxes.obj")
        assert (lower.name, upper.name) == ("lower", "upper")
        for part, half in ((lower, (0.11, 0.07, 0.05)), (upper, (0.03, 0.04, 0.1))):
            assert part.vertices.shape == (8, 3)
            assert part.triangles.shape == (12, 3)
            assert np.ptp(part.vertices, axis=0) == pytest.approx(2 * np.array(half), rel=1e-6)
            assert volume(part) == pytest.approx(8 * np.prod(half), rel=1e-5)

    def test_types_are_as_promised(self) -> None:
        part = read_mesh(DATA / "meshes" / "two_boxes.obj")[0]
        assert (part.vertices.dtype, part.triangles.dtype) == (np.float64, np.int32)
        assert not part.vertices.flags.writeable
        assert not part.triangles.flags.writeable
        assert (part.vertices == part.vertices.astype(np.float32)).all()

    def test_odd_lines_are_read(self, write: Write) -> None:
        vertices = "\ufeffv\t0 0 0 1 0 0\r\n  v 1 0 0\r\nv 0 1 0 \nvn 0 0 1\n"
        text = vertices + "# x\n\nusemtl x\ng\nf 1//1 2//1 -1//1\nf 1 2\n"
        (part,) = read_mesh(write("m.OBJ", text))
        assert part.name == ""
        assert part.triangles.tolist() == [[0, 1, 2]]

    def test_unused_vertices_are_left_out(self, write: Write) -> None:
        (part,) = read_mesh(write("m.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"))
        assert part.vertices.max() == 1.0

    @pytest.mark.parametrize(
        ("text", "line", "words"),
        [
            ("v 0 0 0\nv 1 0\nf 1 2 1\n", 2, "three numbers"),
            ("v 0 0 0\nv 1 0 x\nf 1 2 1\n", 2, "three numbers"),
            ("v 0 0 0\n\nf 1 2 1\n", 3, r"outside 1\.\.1"),
            ("v 0 0 0\nf 1 0 1\n", 2, "outside"),
            ("v 0 0 0\nf -1 -2 -1\n", 2, "outside"),
            ("v 0 0 0\nf 1 1.5 1\n", 2, "whole numbers"),
            ("v 0 0 0\nf 1 1 99999999999999999999\n", 2, "whole numbers"),
            ("v 0 0 0\n", None, "no triangles"),
            ("hello", None, "no triangles"),
            ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", None, "not finite"),
            ("v 0 0 1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", None, "single precision"),
        ],
    )
    def test_broken_files_are_refused(self, write: Write, text: str, line: int | None, words: str) -> None:
        file = write("m.obj", text)
        with pytest.raises(DescriptionError, match=words) as raised:
            read_mesh(file)
        assert (raised.value.file, raised.value.line) == (file, line)


class TestStl:
    def test_binary_files_are_read_whatever_their_header_says(self, write: Write) -> None:
        (part,) = read_mesh(write("m.stl", stl(TRIANGLES)))
        assert part.vertices[part.triangles].tolist() == TRIANGLES.tolist()

    def test_ascii_files_are_read(self, write: Write) -> None:
        text = "solid x\n" + "".join(
            "facet normal 0 0 1\n outer loop\n"
            + "".join("  vertex {} {} {:e}\n".format(*corner) for corner in triangle)
            + " endloop\nendfacet\n"
            for triangle in TRIANGLES
        )
        (part,) = read_mesh(write("m.stl", text + "endsolid x\n"))
        assert part.vertices[part.triangles].tolist() == TRIANGLES.tolist()

    @pytest.mark.parametrize(
        ("content", "words"),
        [
            (b"", "cut off"),
            (b"\x01" * 100, "cut off"),
            (stl(TRIANGLES)[:-1].replace(b"solid", b"mesh "), "cut off"),
            (stl(TRIANGLES, count=2**31).replace(b"solid", b"mesh "), "cut off"),
            (stl(TRIANGLES[:0]), "no triangles"),
            (b"solid\nendsolid\n", "no triangles"),
            (b"solid\nvertex 0 0 0\nvertex 1 0 0\n", "lacks vertices"),
            (b"solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 1", "lacks vertices"),
            (b"solid\nvertex 0 0 0\nvertex 1 0 x\nvertex 1 1 1\n", "three numbers"),
        ],
    )
    def test_broken_files_are_refused(self, write: Write, content: bytes, words: str) -> None:
        with pytest.raises(DescriptionError, match=words):
            read_mesh(write("m.stl", content))


class TestCollada:
    def test_the_scene_is_placed_and_brought_to_metres_but_not_turned_up(self) -> None:
        first, second = read_mesh(DATA / "meshes" / "wedge.dae")
        (original,) = read_mesh(DATA / "meshes" / "wedge.stl")
        corners = np.unique(original.vertices, axis=0)
        turned = np.stack([-corners[:, 1], corners[:, 0], corners[:, 2]], axis=1)
        for part, origin in ((first, (0.02, 0.03, -0.01)), (second, (0.02, 0.33, -0.01))):
            expected = turned + np.array(origin)
            assert sorted(part.vertices.tolist()) == [
                pytest.approx(row, abs=1e-6) for row in sorted(expected.tolist())
            ]
            assert volume(part) == pytest.approx(volume(original), rel=1e-4)

    def document(self, primitive: str, node: str = "") -> str:
        return f"""<COLLADA><library_geometries><geometry id="g"><mesh>
          <source id="s"><float_array>0 0 0 9  2 0 0 9  2 2 0 9  0 2 0 9</float_array><technique_common>
            <accessor stride="4"/></technique_common></source>
          <vertices id="v"><input semantic="POSITION" source="#s"/></vertices>{primitive}</mesh></geometry>
        </library_geometries><library_visual_scenes><visual_scene id="x"><node>{node}
          <instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
        <scene><instance_visual_scene url="#x"/></scene></COLLADA>"""

    INPUT = '<input semantic="VERTEX" source="#v" offset="1"/><input semantic="NORMAL" offset="0"/>'

    @pytest.mark.parametrize(
        "primitive",
        [
            f"<polylist>{INPUT}<vcount>4</vcount><p>7 0 7 1 7 2 7 3</p></polylist>",
            f"<polygons>{INPUT}<p>7 0 7 1 7 2 7 3</p></polygons>",
            f"<triangles>{INPUT}<p>7 0 7 1 7 2 7 0 7 2 7 3</p></triangles>",
        ],
    )
    def test_polygons_become_triangles(self, write: Write, primitive: str) -> None:
        (part,) = read_mesh(write("m.dae", self.document(primitive)))
        assert part.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert part.vertices.tolist() == [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]

    def test_transforms_apply_in_the_order_of_the_file(self, write: Write) -> None:
        node = "<translate>1 0 0</translate><rotate>0 0 2 90</rotate><scale>3 1 1</scale>"
        node += "<rotate>0 0 0 5</rotate>"
        primitive = f"<triangles>{self.INPUT}<p>0 0 0 1 0 2</p></triangles>"
        (part,) = read_mesh(write("m.dae", self.document(primitive, node)))
        assert part.vertices == pytest.approx(np.array([[1, 0, 0], [1, 6, 0], [-1, 6, 0]]), abs=1e-6)

    @pytest.mark.parametrize(
        ("primitive", "words"),
        [
            ("", "shows no triangles"),
            ("<lines/>", "shows no triangles"),
            ("<triangles><p>0 1 2</p></triangles>", "no VERTEX input"),
            (f"<triangles>{INPUT}<p>0 0 0 1 0 9</p></triangles>", r"outside 0\.\.3"),
            (f"<triangles>{INPUT}<p>0 0 0 1 0</p></triangles>", "do not make corners"),
            (f"<triangles>{INPUT}<p>0 0 0 1 0 x</p></triangles>", "whole numbers"),
            (f"<triangles>{INPUT}<p>0 0 0 1</p></triangles>", "do not fit"),
            (f"<polylist>{INPUT}<vcount>9</vcount><p>0 0 0 1</p></polylist>", "do not fit"),
            (f"<polylist>{INPUT}<vcount>-3 6</vcount><p>0 0 0 1 0 2</p></polylist>", "do not fit"),
        ],
    )
    def test_broken_geometry_is_refused(self, write: Write, primitive: str, words: str) -> None:
        with pytest.raises(DescriptionError, match=words):
            read_mesh(write("m.dae", self.document(primitive)))

    @pytest.mark.parametrize(
        ("before", "after", "words"),
        [
            ("<COLLADA>", "<DAE>", "no <COLLADA>|does not match"),
            ('url="#g"', 'url="#h"', "no geometry 'h'"),
            ('url="#x"', 'url="#y"', "shows no triangles"),
            ('source="#s"', 'source="#t"', "no POSITION input"),
            ("float_array>", "int_array>", "<float_array> is missing"),
            ('stride="4"', 'stride="5"', "do not make rows"),
            ('stride="4"', 'stride="1"', "stride has to be from 3 to"),
            ("0 0 0 9", "0 0 nan 9", "finite"),
            ("0 0 0 9", "0 0 x 9", "numbers"),
        ],
    )
    def test_broken_documents_are_refused(self, write: Write, before: str, after: str, words: str) -> None:
        text = self.document(f"<triangles>{self.INPUT}<p>0 0 0 1 0 2</p></triangles>")
        assert read_mesh(write("m.dae", text))
        with pytest.raises(DescriptionError, match=words):
            read_mesh(write("m.dae", text.replace(before, after)))


@given(st.lists(st.integers(0, 7), max_size=12))
def test_fans_share_the_first_corner_of_their_polygon(sizes: list[int]) -> None:
    corners = np.arange(sum(sizes))
    expected = []
    start = 0
    for size in sizes:
        expected += [[start, start + k + 1, start + k + 2] for k in range(size - 2)]
        start += size
    assert cut_into_fans(corners, np.array(sizes, dtype=np.int64)).tolist() == expected


def test_a_mesh_is_read_again_only_after_a_change(write: Write) -> None:
    file = write("m.stl", stl(TRIANGLES))
    os.utime(file, (1e9, 1e9))
    first = read_mesh(file)
    assert read_mesh(file)[0] is first[0]
    write("m.stl", stl(TRIANGLES * 2))
    assert read_mesh(file)[0].vertices.max() == 4.0


def test_missing_files_and_unknown_kinds_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="cannot be read"):
        read_mesh(tmp_path / "m.stl")
    with pytest.raises(DescriptionError, match="unknown kind of mesh"):
        read_mesh(tmp_path / "m.fbx")


def test_bounds_of_distance_fields_are_read(write: Write) -> None:
    assert read_field_bounds(write("f.cdf", struct.pack("<6d", 0, -1, -2, 1, 2, 3) + b"rest")) == (
        (0.0, -1.0, -2.0),
        (1.0, 2.0, 3.0),
    )
    with pytest.raises(DescriptionError, match="cut off before the bounds"):
        read_field_bounds(write("f.cdf", b"short"))
    for high in (-1.0, np.nan, 1e300):
        with pytest.raises(DescriptionError, match="not in order"):
            read_field_bounds(write("f.cdf", struct.pack("<6d", 0, 0, 0, 1, 1, high)))
    with pytest.raises(DescriptionError, match="cannot be read"):
        read_field_bounds(Path("nowhere.cdf"))
