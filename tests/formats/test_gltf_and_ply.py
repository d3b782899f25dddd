"""glTF and PLY meshes, of small files made here."""

from __future__ import annotations

import base64
import json
import struct
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom import World
from carom.errors import DescriptionError
from carom.meshes.gltf import read_gltf
from carom.meshes.ply import read_ply

FILE = Path("a.mesh")
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], "<f4")
CORNERS = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "<u2")
DATA = POINTS.tobytes() + CORNERS.tobytes()


def gltf(node: dict | None = None, mode: int = 4, **others) -> dict:
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "translation": [1, 0, 0]}, {"mesh": 0, "name": "it", **(node or {})}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 24},
        ],
        "buffers": [{"byteLength": len(DATA)}],
        **others,
    }


def glb(content: dict, data: bytes = DATA) -> bytes:
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def test_binary_and_text():
    (part,) = read_gltf(glb(gltf()), FILE)
    assert part.name == "it"
    np.testing.assert_array_equal(part.vertices, POINTS + np.array([1, 0, 0]))
    np.testing.assert_array_equal(part.triangles, CORNERS)
    uri = "data:application/octet-stream;base64," + base64.b64encode(DATA).decode()
    (other,) = read_gltf(json.dumps(gltf(buffers=[{"uri": uri}])).encode(), FILE)
    np.testing.assert_array_equal(part.vertices, other.vertices)


def test_nodes_are_placed_and_mirrored():
    half = np.sqrt(0.5)
    (part,) = read_gltf(glb(gltf({"rotation": [0, 0, half, half], "scale": [2, 1, 1]})), FILE)
    np.testing.assert_allclose(part.vertices[1], [1, 2, 0], atol=1e-6)
    (part,) = read_gltf(glb(gltf({"scale": [-1, 1, 1]})), FILE)
    np.testing.assert_array_equal(part.triangles, CORNERS[:, ::-1])
    matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]
    (part,) = read_gltf(glb(gltf({"matrix": matrix})), FILE)
    np.testing.assert_array_equal(part.vertices[0], [6, 6, 7])


@pytest.mark.parametrize(("mode", "triangles"), [(5, [[0, 2, 1], [2, 0, 1]]), (6, [[0, 2, 1], [0, 1, 0]])])
def test_strips_and_fans(mode, triangles):
    (part,) = read_gltf(glb(gltf(mode=mode)), FILE)
    assert part.triangles[:2].tolist() == triangles


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (glb(gltf())[:-4], "cut off"),
        (glb(gltf(), DATA[:60]), "reaches beyond its buffer"),
        (glb(gltf(extensionsRequired=["KHR_draco_mesh_compression"])), "compression is not read"),
        (glb(gltf(asset={"version": "1.0"})), "only 2.0"),
        (glb(gltf(buffers=[{"uri": "../../etc/passwd"}])), "not in the folder"),
        (glb(gltf({"children": [0]})), "nested deeper"),
        (b"{}", "not a valid glTF file"),
        (b"{", "not a valid glTF file"),
    ],
)
def test_what_is_broken_is_refused(content, complaint):
    with pytest.raises(DescriptionError, match=complaint):
        read_gltf(content, FILE)


HEADER = (
    "ply\nformat {} 1.0\ncomment a\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {}\nproperty list uchar int vertex_indices\nend_header\n"
)


def ply(order: str) -> bytes:
    if order == "ascii":
        rows = [" ".join(map(str, row)) for row in POINTS.tolist()]
        rows += ["3 " + " ".join(map(str, row)) for row in CORNERS.tolist()] + ["4 0 1 2 3"]
        return (HEADER.format(order, 5) + "\n".join(rows) + "\n").encode()
    sign = "<" if "little" in order else ">"
    faces = b"".join(struct.pack(f"{sign}B3i", 3, *row) for row in CORNERS.tolist())
    faces += struct.pack(f"{sign}B4i", 4, 0, 1, 2, 3)
    return HEADER.format(order, 5).encode() + POINTS.astype(f"{sign}f4").tobytes() + faces


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_of_every_format(order):
    (part,) = read_ply(ply(order), FILE)
    np.testing.assert_array_equal(part.vertices, POINTS)
    assert part.triangles.tolist() == [*CORNERS.tolist(), [0, 1, 2], [0, 2, 3]]
    with pytest.raises(DescriptionError, match="cut off"):
        read_ply(ply(order)[:-8], FILE)


KINDS = ["glb", "ascii", "binary_little_endian"]


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2000), st.binary(min_size=1, max_size=4), st.sampled_from(KINDS))
def test_damaged_files_are_read_or_refused(at, damage, kind):
    whole = glb(gltf()) if kind == "glb" else ply(kind)
    at %= len(whole)
    read = read_gltf if kind == "glb" else read_ply
    with suppress(DescriptionError):
        read(whole[:at] + damage + whole[at + len(damage) :], FILE)


def test_robots_with_such_meshes(tmp_path):
    (tmp_path / "a.glb").write_bytes(glb(gltf()))
    (tmp_path / "b.ply").write_bytes(ply("ascii"))
    shapes = "".join(
        f'<collision><geometry><mesh filename="{name}"/></geometry></collision>'
        for name in ("a.glb", "b.ply")
    )
    (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="l">{shapes}</link></robot>')
    with World() as world:
        assert len(world.load(tmp_path / "r.urdf")) == 1
        with pytest.raises(DescriptionError, match="must end in"):
            world.load_urdf(tmp_path / "r.urdf", as_pybullet=True)
