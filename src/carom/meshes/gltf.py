"""glTF 2.0, text and binary: one part for each primitive of each node of the scene.

Positions are those of the file, in its own axes, as other programs read meshes of robots; y is not turned up.
Source: Khronos Group, glTF 2.0 specification.
"""

from __future__ import annotations

import base64
import binascii
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.files.budget import charge
from carom.meshes.part import MeshPart, make_part
from carom.native.products import determinants, product

_MAGIC = b"glTF"
_HEADER, _CHUNK = 12, 8
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_MAX_NODES = 10_000
_DEEPEST = 100
_NUMBERS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_UNREAD = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(data: bytes, file: Path) -> list[MeshPart]:
    """Reads a .gltf or .glb file; raises `DescriptionError` if it is broken, cut off or compressed."""
    try:
        return _Gltf(data, file).parts()
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, RecursionError) as problem:
        raise DescriptionError(f"not a valid glTF file: {problem!r}", file=file) from None


class _Gltf:
    def __init__(self, data: bytes, file: Path) -> None:
        self.file = file
        self.binary: bytes | None = None
        self.buffers: dict[int, bytes] = {}
        self.nodes = 0
        content = self._chunks(data) if data.startswith(_MAGIC) else data
        self.root: dict[str, Any] = json.loads(content)
        version = str(self.root["asset"]["version"])
        if not version.startswith("2."):
            raise self._error(f"glTF {version[:20]} is not read, only 2.0")
        for name in self.root.get("extensionsRequired", ()):
            if name in _UNREAD:
                raise self._error(f"{name} is not read; export the mesh without compression")

    def _error(self, reason: str) -> DescriptionError:
        return DescriptionError(reason, file=self.file)

    def _chunks(self, data: bytes) -> bytes:
        """The JSON of a binary file; its binary chunk is kept."""
        content: bytes | None = None
        at = _HEADER
        if len(data) < int.from_bytes(data[8:12], "little"):
            raise self._error(f"cut off: {len(data)} bytes are fewer than its header states")
        while at + _CHUNK <= len(data):
            length, kind = (int.from_bytes(data[at + k : at + k + 4], "little") for k in (0, 4))
            chunk = data[at + _CHUNK : at + _CHUNK + length]
            if len(chunk) < length:
                raise self._error("cut off within a chunk")
            if kind == _JSON and content is None:
                content = chunk
            elif kind == _BIN and self.binary is None:
                self.binary = chunk
            at += _CHUNK + length
        if content is None:
            raise self._error("it has no JSON chunk")
        return content

    def parts(self) -> list[MeshPart]:
        """The parts of the scene; of all nodes that are in no other if there is no scene."""
        nodes = self.root.get("nodes", [])
        scenes = self.root.get("scenes", [])
        if scenes:
            roots = scenes[self.root.get("scene", 0)].get("nodes", [])
        else:
            inner = {child for node in nodes for child in node.get("children", ())}
            roots = [index for index in range(len(nodes)) if index not in inner]
        parts: list[MeshPart] = []
        for root in roots:
            self._node(root, np.eye(4), 0, parts)
        return parts

    def _node(self, index: int, above: NDArray[np.float64], depth: int, parts: list[MeshPart]) -> None:
        self.nodes += 1
        if depth > _DEEPEST or self.nodes > _MAX_NODES:
            raise self._error(f"more than {_MAX_NODES} nodes, or nested deeper than {_DEEPEST}")
        node = self.root["nodes"][_index(index)]
        pose = product(above, _matrix(node))
        if "mesh" in node:
            mesh = self.root["meshes"][_index(node["mesh"])]
            for primitive in mesh["primitives"]:
                part = self._primitive(primitive, pose, str(node.get("name") or mesh.get("name") or ""))
                if part is not None:
                    parts.append(part)
        for child in node.get("children", ()):
            self._node(child, pose, depth + 1, parts)

    def _primitive(self, primitive: dict[str, Any], pose: NDArray[np.float64], name: str) -> MeshPart | None:
        """The triangles of a primitive; None for points and lines."""
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            return None
        positions = self._accessor(primitive["attributes"]["POSITION"])
        if positions.shape[1] != 3:
            raise self._error("positions need three numbers")
        if "indices" in primitive:
            corners = self._accessor(primitive["indices"])[:, 0].astype(np.int64)
        else:
            corners = np.arange(len(positions), dtype=np.int64)
        charge("vertices", 1 + len(positions) + len(corners))
        if len(corners) and not 0 <= corners.min() <= corners.max() < len(positions):
            raise self._error("a triangle has a vertex that does not exist")
        triangles = _triangles(corners, mode)
        if not len(triangles):
            return None
        placed = product(positions, pose[:3, :3].T) + pose[:3, 3]
        if determinants(pose[:3, :3]) < 0.0:
            triangles = triangles[:, ::-1]
        return make_part(self.file, placed, np.ascontiguousarray(triangles), name)

    def _accessor(self, index: int) -> NDArray[np.float64]:
        """The values of an accessor, (count, width)."""
        accessor = self.root["accessors"][_index(index)]
        if "sparse" in accessor:
            raise self._error("sparse accessors are not read; export the mesh without them")
        number = np.dtype(_NUMBERS[accessor["componentType"]])
        width, count = _WIDTHS[accessor["type"]], _index(accessor["count"])
        charge("vertices", count)
        if "bufferView" not in accessor:
            return np.zeros((count, width))
        view = self.root["bufferViews"][_index(accessor["bufferView"])]
        size = number.itemsize * width
        stride = _index(view.get("byteStride", size)) or size
        start = _index(view.get("byteOffset", 0)) + _index(accessor.get("byteOffset", 0))
        data = self._buffer(_index(view["buffer"]))
        if count and start + (count - 1) * stride + size > len(data):
            raise self._error("cut off: an accessor reaches beyond its buffer")
        values = np.ndarray((count, width), number, data, start, (stride, number.itemsize))
        result = values.astype(np.float64)
        if accessor.get("normalized"):
            result = np.maximum(result / float(np.iinfo(number).max), -1.0)
        return result

    def _buffer(self, index: int) -> bytes:
        if index not in self.buffers:
            uri = self.root["buffers"][index].get("uri")
            if uri is None:
                if self.binary is None:
                    raise self._error("its binary chunk is missing")
                self.buffers[index] = self.binary
            elif uri.startswith("data:"):
                try:
                    self.buffers[index] = base64.b64decode(uri.partition(",")[2], validate=True)
                except binascii.Error:
                    raise self._error("the data of a buffer is not valid base64") from None
            else:
                path = self.file.parent / uri
                if not path.resolve().is_relative_to(self.file.parent.resolve()):
                    raise self._error(f"buffer {uri[:60]!r} is not in the folder of the file")
                self.buffers[index], _ = read_bounded(path)
        return self.buffers[index]


def _index(value: Any) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f"{value!r} is no index")
    return value


def _matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    """The transform of a node, (4, 4)."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = (float(it) for it in node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
    result = np.eye(4)
    turn = np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
    result[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    result[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return result


def _triangles(corners: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    """Triangles (m, 3) of a list, a strip or a fan."""
    if mode == _TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    count = max(len(corners) - 2, 0)
    steps = np.arange(count)
    if mode == _FAN:
        return np.stack([np.repeat(corners[:1], count), corners[steps + 1], corners[steps + 2]], axis=1)
    odd = steps % 2
    return np.stack([corners[steps], corners[steps + 1 + odd], corners[steps + 2 - odd]], axis=1)
