"""STL files for drawing: normals are those of the file, where it has any."""

import struct

import numpy as np
import pytest

from carom.formats.visuals.reader import read_mesh_visual
from carom.formats.visuals.stl import read_stl_visual
from carom.meshes import read_mesh

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0))
OF_CORNERS = [0, 0, 1]


def _binary(*normals):
    facets = [
        struct.pack("<12fH", *normal, *(x for corner in CORNERS for x in corner), 0) for normal in normals
    ]
    return b"solid by its first bytes".ljust(80) + struct.pack("<I", len(facets)) + b"".join(facets)


def _ascii(*normals):
    vertices = "".join(f"vertex {x} {y} {z}\n" for x, y, z in CORNERS)
    facets = [f"facet{normal}\nouter loop\n{vertices}endloop\nendfacet\n" for normal in normals]
    return f"solid\n{''.join(facets)}endsolid\n".encode()


@pytest.fixture
def normals(tmp_path):
    """Normals of a file, one for each triangle."""

    def read(content):
        path = tmp_path / "mesh.stl"
        path.write_bytes(content)
        found = read_mesh_visual(path).normals.reshape(-1, 3, 3)
        assert np.ptp(found, axis=1).max() == 0.0
        return found[:, 0].tolist()

    return read


def test_triangles_have_the_normals_of_the_file_at_length_one(normals):
    turned = normals(_binary((0, 0, -2), (1, 0, 0), (0, -3, 4)))
    assert turned == [[0, 0, -1], [1, 0, 0], pytest.approx([0, -0.6, 0.8])]
    assert normals(_ascii(" normal 2 0 0", " NORMAL -1e0 0 0")) == [[1, 0, 0], [-1, 0, 0]]


@pytest.mark.parametrize("useless", [(0, 0, 0), (np.nan, 0, 1), (np.inf, 0, 0)])
def test_triangles_without_usable_normals_are_flat(normals, useless):
    assert normals(_binary(useless, (1, 0, 0))) == [OF_CORNERS, [1, 0, 0]]


@pytest.mark.parametrize("said", ["", " normal", " normal one 0 0", " normal nan 0 0"])
def test_text_that_is_no_normal_leaves_triangles_flat(normals, said):
    assert normals(_ascii(said, " normal 1 0 0"))[0] == OF_CORNERS


def test_a_file_that_has_changed_since_is_flat(tmp_path):
    path = tmp_path / "mesh.stl"
    path.write_bytes(_binary((1, 0, 0)))
    parts = read_mesh(path)
    path.write_bytes(_binary((1, 0, 0), (1, 0, 0)))
    assert read_stl_visual(path, parts).normals.tolist() == [OF_CORNERS] * 3
