"""The meshes and images of a recording, and the shapes that use them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO
from typing import Any

import numpy as np

from carom.description import Pose
from carom.description.transform import compose, inverse
from carom.replay.replay import ReplayMesh, ReplayShape, ReplayTexture
from carom.viewer.protocol import to_page

_NO_TEXTURE = -1
# Numbers of four bytes of a vertex and of a triangle.
_OF_VERTEX, _OF_TRIANGLE = 8, 3


class Assets:
    """Meshes and images by number. Numbers are not used again, so nothing is removed."""

    def __init__(self) -> None:
        self._meshes: dict[int, ReplayMesh] = {}
        self._textures: dict[int, ReplayTexture] = {}

    def take(self, header: Mapping[str, Any], payload: bytes) -> None:
        """Takes a message about a mesh or an image.

        Raises:
            ValueError: It has fewer bytes than it says.
        """
        if header["type"] == to_page.MESH.type:
            self._meshes[header["mesh"]] = _mesh(header, payload)
        elif header["type"] == to_page.TEXTURE.type:
            self._textures[header["texture"]] = _texture(header, payload)

    def shape(
        self, shape: Mapping[str, Any], names: Sequence[str], links: Sequence[Mapping[str, Any]], body: str
    ) -> ReplayShape:
        """A shape of a body: its fields in the message, and names and fields of the links.

        Raises:
            ValueError: Its mesh or its image is not there.
        """
        link = links[shape["link"]]
        frame = inverse(Pose(tuple(link["position"]), tuple(link["orientation"])))
        mesh, texture = shape["meshes"][0][0], shape["texture"]
        if mesh not in self._meshes:
            raise ValueError(f"there is no mesh {mesh}, which a shape of {body!r} has")
        if texture != _NO_TEXTURE and texture not in self._textures:
            raise ValueError(f"there is no image {texture}, which a shape of {body!r} has")
        return ReplayShape(
            link=str(names[shape["link"]]),
            mesh=self._meshes[mesh],
            pose=compose(frame, Pose(tuple(shape["position"]), tuple(shape["orientation"]))),
            scale=tuple(shape["scale"]),
            rgba=tuple(shape["rgba"]),
            texture=self._textures.get(texture),
            two_sided=shape["twoSided"],
            collision=shape.get("collision", False),
        )


def _mesh(header: Mapping[str, Any], payload: bytes) -> ReplayMesh:
    vertices, triangles = header["vertices"], header["triangles"]
    numbers = np.frombuffer(payload, "<u4")
    if len(numbers) != _OF_VERTEX * vertices + _OF_TRIANGLE * triangles:
        raise ValueError(
            f"mesh {header['mesh']} has {len(payload)} bytes, "
            f"not those of {vertices} vertices and {triangles} triangles"
        )
    ends = np.cumsum((3 * vertices, 3 * vertices, 2 * vertices))
    positions, normals, uvs, corners = np.split(numbers, ends)
    return ReplayMesh(
        positions.view("<f4").reshape(-1, 3),
        normals.view("<f4").reshape(-1, 3),
        uvs.view("<f4").reshape(-1, 2),
        corners.reshape(-1, 3),
    )


def _texture(header: Mapping[str, Any], payload: bytes) -> ReplayTexture:
    if "file" in header:
        return ReplayTexture(header["file"], payload)
    from PIL import Image

    shape = (header["height"], header["width"], 3)
    if len(payload) != np.prod(shape):
        raise ValueError(
            f"image {header['texture']} has {len(payload)} bytes, not those of {shape[1]} x {shape[0]} pixels"
        )
    file = BytesIO()
    Image.fromarray(np.frombuffer(payload, np.uint8).reshape(shape)[::-1]).save(file, "png")
    return ReplayTexture("image/png", file.getvalue())
