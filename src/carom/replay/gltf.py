"""A replay as binary glTF 2.0: a node for each body, link and shape, and one animation that moves the links.

glTF points y up and has no way to hide a node over time, so the root turns the world, and shapes that are not
there have the scale 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.replay.glb import ARRAY, FLOATS, INDICES, WHOLES, Glb
from carom.replay.poses import continuous
from carom.replay.replay import Replay, ReplayLink, ReplayLook, ReplayMesh, ReplayShape, ReplayTexture
from carom.version import __version__

# Turns z up to y up.
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
_ROUGHNESS = 0.6


def gltf(replay: Replay) -> bytes:
    """The file; its times are those of `Replay.clock`."""
    return _Scene(replay).packed()


class _Scene:
    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self._clock = replay.clock - replay.clock[0]
        self._glb = Glb()
        self._nodes: list[dict[str, Any]] = []
        self._meshes: list[dict[str, Any]] = []
        self._materials: list[dict[str, Any]] = []
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []
        self._images: list[dict[str, Any]] = []
        self._known: dict[Any, int] = {}

    def packed(self) -> bytes:
        root = self._node({"name": self._replay.title or "Carom", "rotation": _UPRIGHT, "children": []})
        for body in self._replay.bodies.values():
            children = [
                self._link(link, [(look, shape) for look in body.looks for shape in look.shapes])
                for link in body.links.values()
            ]
            self._nodes[root]["children"].append(self._node({"name": body.name, "children": children}))
        if not self._nodes[root]["children"]:
            del self._nodes[root]["children"]
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": f"Carom {__version__}"},
            "scene": 0,
            "scenes": [{"nodes": [root]}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": self._materials,
            "images": self._images,
            "textures": [{"source": number} for number in range(len(self._images))],
        }
        if self._channels:
            animation = {"name": "replay", "samplers": self._samplers, "channels": self._channels}
            document["animations"] = [animation]
        return self._glb.packed(document)

    def _node(self, node: dict[str, Any]) -> int:
        self._nodes.append(node)
        return len(self._nodes) - 1

    def _link(self, link: ReplayLink, shapes: list[tuple[ReplayLook, ReplayShape]]) -> int:
        node: dict[str, Any] = {"name": link.name}
        number = self._node(node)
        poses = link.pose
        frames = np.flatnonzero(~np.isnan(poses[:, 0]))
        poses = poses[frames]
        if len(frames):
            lengths = np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
            turns = continuous(poses[:, 3:] / lengths)
            node["translation"], node["rotation"] = poses[0, :3].tolist(), turns[0].tolist()
            for path, values in (("translation", poses[:, :3]), ("rotation", turns)):
                if np.any(values != values[0]):
                    self._animate(number, path, frames, values, "LINEAR")
        children = [
            self._shape(look, shape)
            for look, shape in shapes
            if shape.link == link.name
            and not shape.collision
            and shape.rgba[3] > 0.0
            and len(shape.mesh.triangles)
        ]
        if children:
            node["children"] = children
        return number

    def _shape(self, look: ReplayLook, shape: ReplayShape) -> int:
        number = self._node(
            {
                "mesh": self._mesh(shape),
                "translation": list(shape.pose.position),
                "rotation": list(shape.pose.orientation),
                "scale": list(shape.scale),
            }
        )
        count = len(self._clock)
        if look.begin > 0 or look.end < count:
            frames = np.array(sorted({0, look.begin, look.end} - {count}))
            seen = (look.begin <= frames) & (frames < look.end)
            self._animate(
                number, "scale", frames, np.where(seen[:, None], np.array(shape.scale), 0.0), "STEP"
            )
        return number

    def _animate(
        self, node: int, path: str, frames: NDArray[np.int64], values: NDArray[np.float64], interpolation: str
    ) -> None:
        key = "times", frames.tobytes()
        if key not in self._known:
            self._known[key] = self._glb.numbers(self._clock[frames].astype("<f4"), FLOATS, bounded=True)
        output = self._glb.numbers(values.astype("<f4"), FLOATS)
        self._samplers.append({"input": self._known[key], "output": output, "interpolation": interpolation})
        target = {"node": node, "path": path}
        self._channels.append({"sampler": len(self._samplers) - 1, "target": target})

    def _mesh(self, shape: ReplayShape) -> int:
        material = self._material(shape)
        key = "mesh", id(shape.mesh), material
        if key not in self._known:
            attributes, indices = self._geometry(shape.mesh, textured=shape.texture is not None)
            primitive = {"attributes": attributes, "indices": indices, "material": material}
            self._meshes.append({"primitives": [primitive]})
            self._known[key] = len(self._meshes) - 1
        return self._known[key]

    def _geometry(self, mesh: ReplayMesh, *, textured: bool) -> tuple[dict[str, int], int]:
        arrays = {"POSITION": mesh.positions, "NORMAL": _units(mesh.normals)}
        if textured:
            # Here v points down.
            arrays["TEXCOORD_0"] = mesh.uvs * np.array([1, -1], np.float32) + np.array([0, 1], np.float32)
        attributes = {}
        for name, array in arrays.items():
            key = name, id(mesh)
            if key not in self._known:
                bounded = name == "POSITION"
                self._known[key] = self._glb.numbers(array.astype("<f4"), FLOATS, ARRAY, bounded=bounded)
            attributes[name] = self._known[key]
        key = "triangles", id(mesh)
        if key not in self._known:
            self._known[key] = self._glb.numbers(mesh.triangles.reshape(-1).astype("<u4"), WHOLES, INDICES)
        return attributes, self._known[key]

    def _material(self, shape: ReplayShape) -> int:
        texture = shape.texture
        key = "material", shape.rgba, shape.two_sided, None if texture is None else id(texture)
        if key not in self._known:
            surface: dict[str, Any] = {
                "baseColorFactor": [*map(_linear, shape.rgba[:3]), min(shape.rgba[3], 1.0)],
                "metallicFactor": 0.0,
                "roughnessFactor": _ROUGHNESS,
            }
            if texture is not None:
                surface["baseColorTexture"] = {"index": self._image(texture)}
            material: dict[str, Any] = {"pbrMetallicRoughness": surface, "doubleSided": shape.two_sided}
            if shape.rgba[3] < 1.0:
                material["alphaMode"] = "BLEND"
            self._materials.append(material)
            self._known[key] = len(self._materials) - 1
        return self._known[key]

    def _image(self, texture: ReplayTexture) -> int:
        key = "image", id(texture)
        if key not in self._known:
            view = self._glb.part(texture.data)
            self._images.append({"bufferView": view, "mimeType": texture.media_type})
            self._known[key] = len(self._images) - 1
        return self._known[key]


def _linear(part: float) -> float:
    """A part of a colour as light, from 0 to 1, by its value on screens (sRGB)."""
    value = min(max(part, 0.0), 1.0)
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _units(normals: NDArray[np.float32]) -> NDArray[np.float32]:
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    # Corners of degenerate triangles only have none.
    return np.where(
        lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), np.array([0, 0, 1], np.float32)
    )
