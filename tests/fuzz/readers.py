"""Kinds of files that `World.load` and the tools around it read: seeds, harm that fits them, and loading."""

from __future__ import annotations

import json
import struct
import zlib
from base64 import b64encode
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
from tests.budget.hostile import hfield, mesh, ply, png, urdf
from tests.fuzz.damage import damaged
from tests.fuzz.invariants import Broken

import carom
from carom.errors import CaromError, SimulationError

_CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 2)], "<f4")
_FACES = np.array(
    [
        0,
        1,
        3,
        0,
        3,
        2,
        4,
        6,
        7,
        4,
        7,
        5,
        0,
        4,
        5,
        0,
        5,
        1,
        2,
        3,
        7,
        2,
        7,
        6,
        0,
        2,
        6,
        0,
        6,
        4,
        1,
        5,
        7,
        1,
        7,
        3,
    ],
    "<u4",
)
_SEEDS = Path(__file__).with_name("seeds")


def _gltf(*, embedded: bool) -> tuple[dict[str, object], bytes]:
    """The JSON of a cuboid in glTF, and its buffer."""
    data = _CORNERS.tobytes() + _FACES.tobytes()
    uri = "data:application/octet-stream;base64," + b64encode(data).decode()
    buffer = {"byteLength": len(data)} | ({"uri": uri} if embedded else {})
    views = [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 144}]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": 36, "type": "SCALAR"},
    ]
    node = {
        "mesh": 0,
        "translation": [0, 0, 1],
        "rotation": [0, 0, 0, 1],
        "scale": [1, 2, 1],
        "children": [1],
    }
    return {
        "asset": {"version": "2.0"}, "buffers": [buffer], "bufferViews": views, "accessors": accessors,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
        "nodes": [node, {"mesh": 0, "matrix": np.eye(4).ravel().tolist()}], "scenes": [{"nodes": [0]}],
    }, data  # fmt: skip


def _glb(text: bytes, data: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _plys() -> list[bytes]:
    rows = np.zeros(12, [("n", "u1"), ("corners", "<i4", 3)])
    rows["n"], rows["corners"] = 3, _FACES.reshape(-1, 3)
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment x\nelement vertex 8\nproperty float x\n"
        "property float y\nproperty float z\nelement face 12\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    return [ply("").encode(), header.encode() + _CORNERS.tobytes() + rows.tobytes()]


def _msh() -> list[bytes]:
    counts = struct.pack("<4i", 8, 0, 0, 12)
    return [
        counts + _CORNERS.tobytes() + _FACES.tobytes(),
        struct.pack("<4i", 8, 0, 0, 0) + _CORNERS.tobytes(),
    ]


def _worlds() -> list[bytes]:
    contents = []
    _documents()
    for name in ("tree.xml", "world.sdf"):
        world = carom.World()
        world.load(name)
        world.step(3)
        world.save("seed.carom")
        contents.append(Path("seed.carom").read_bytes())
    return contents


def _fields() -> list[bytes]:
    heights = np.arange(12, dtype="<f4")
    return [struct.pack("<2i", 3, 4) + heights.tobytes(), struct.pack("<2i", 2, 2) + heights[:4].tobytes()]


def _documents(*names: str) -> list[bytes]:
    """The contents of documents; what they include is put into the working directory."""
    for file in _SEEDS.iterdir():
        Path(file.name).write_bytes(file.read_bytes())
    return [Path(name).read_bytes() for name in names]


SEEDS: dict[str, Callable[[], list[bytes]]] = {
    "mjcf": lambda: _documents("tree.xml", "tree.xml", "attaching.xml"),
    "xacro": lambda: _documents("macros.xacro", "loops.xacro"),
    "written.sdf": lambda: _documents("world.sdf"),
    "yaml": lambda: _documents("part.yaml"),
    "ply": _plys,
    "gltf": lambda: [json.dumps(_gltf(embedded=True)[0]).encode()],
    "glb": lambda: [_glb(json.dumps(_gltf(embedded=False)[0]).encode(), _gltf(embedded=False)[1])],
    "msh": _msh,
    "height.png": lambda: [png(5, 4, bytes((n % 6 and n) for n in range(24))), png(2, 2), png(30, 30)],
    "hfield": _fields,
    "carom": _worlds,
}  # fmt: skip


def _document(name: str) -> carom.World:
    world = carom.World()
    world.load(name)
    return world


def _yaml(name: str) -> carom.World:
    text = Path("loops.xacro").read_text(encoding="utf-8").replace("part.yaml", name)
    Path("of.xacro").write_text(text, encoding="utf-8")
    return _document("of.xacro")


def _shape(name: str) -> carom.World:
    """A mesh as a URDF and as an MJCF file have it."""
    Path("of.urdf").write_text(urdf(name), encoding="utf-8")
    Path("of.xml").write_text(mesh(f'file="{name}"'), encoding="utf-8")
    try:
        world = _document("of.urdf")
    except CaromError:
        return _document("of.xml")
    world.load("of.xml")
    return world


def _msh_shape(name: str) -> carom.World:
    Path("of.xml").write_text(mesh(f'file="{name}"', 'type="capsule"'), encoding="utf-8")
    return _document("of.xml")


def _height_field(name: str) -> carom.World:
    Path("of.xml").write_text(hfield(f'file="{name}"'), encoding="utf-8")
    return _document("of.xml")


LOADERS: dict[str, Callable[[str], carom.World]] = {
    **dict.fromkeys(("mjcf", "xacro", "written.sdf", "carom"), _document),
    "yaml": _yaml,
    **dict.fromkeys(("ply", "gltf", "glb"), _shape),
    "msh": _msh_shape,
    **dict.fromkeys(("height.png", "hfield"), _height_field),
}


def damaged_glb(content: bytes, random: Random) -> bytes:
    """A binary glTF with a damaged document, or with any damage."""
    if random.random() < 0.2:
        return damaged(content, random)
    length = int.from_bytes(content[12:16], "little")
    text, data = content[20 : 20 + length], content[28 + length :]
    return _glb(damaged(text, random), data if random.random() < 0.7 else damaged(data, random))


def damaged_png(content: bytes, random: Random) -> bytes:
    """An image with damaged chunks whose checksums are right, or with any damage."""
    if random.random() < 0.2:
        return damaged(content, random)
    result, at = content[:8], 8
    while at + 12 <= len(content):
        length = int.from_bytes(content[at : at + 4], "big")
        name, body = content[at + 4 : at + 8], content[at + 8 : at + 8 + length]
        if random.random() < 0.5:
            is_packed = name == b"IDAT" and random.random() < 0.5
            body = (
                zlib.compress(damaged(zlib.decompress(body), random)) if is_packed else damaged(body, random)
            )
        checked = name + body
        result += struct.pack(">I", len(body)) + checked + struct.pack(">I", zlib.crc32(checked))
        at += 12 + length
    return result


def load(kind: str, name: str) -> str:
    """Load a file into a world of its own and step it; what came of it.

    Raises:
        Broken: Something came but an error of Carom's, or numbers are not finite.
    """
    try:
        world = LOADERS[kind](name)
    except CaromError:
        return "refused"
    try:
        world.step(2)
    except SimulationError:
        return "loaded, cannot be stepped"
    if not np.isfinite(world.link_pose).all():
        raise Broken("a pose is not finite")
    return "loaded"
