"""What a camera sees: colour, depth in metres, labels and point clouds."""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.native.products import product
from carom.pose import Pose as WorldPose
from carom.render.projection import poses_to_matrices
from carom.render.scene import LINK_SHIFT

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.link import Link

NOTHING = -1
"""Body id of background pixels."""

_BODY_BITS = np.int32((1 << LINK_SHIFT) - 1)


class PointCloud(NamedTuple):
    """Points of the surfaces in view.

    Attributes:
        points: (n, 3) positions [m].
        colours: (n, 3) uint8 red, green and blue.
        bodies: (n,) ids of the bodies that the points lie on.
    """

    points: NDArray[np.float64]
    colours: NDArray[np.uint8]
    bodies: NDArray[np.int32]


class CameraImage:
    """The image of a camera at one time. Row 0 is the top; no other image shares its arrays.

    Attributes:
        colour: (height, width, 3) uint8 red, green and blue; white for the background.
        depth: (height, width) float32 distance along the optical axis [m]; infinite for the background.
        body_ids: (height, width) int32 ids of bodies; -1 for the background.
        link_indices: (height, width) int32 links of those bodies; -1 is the base, and the background.
        camera_pose: World pose of the camera at that time.
    """

    def __init__(
        self,
        colour: NDArray[np.uint8],
        depth: NDArray[np.float32],
        label: NDArray[np.int32],
        camera_pose: WorldPose,
        intrinsics: Array,
        bodies: dict[int, Body],
        *,
        is_orthographic: bool = False,
    ) -> None:
        self.colour = colour
        self.depth = depth
        self.body_ids: NDArray[np.int32]
        self.link_indices: NDArray[np.int32]
        self.body_ids, self.link_indices = bodies_and_links(label)
        self.camera_pose = camera_pose
        self._intrinsics = intrinsics
        self._is_orthographic = is_orthographic
        # Bodies may be removed after the image is taken; their names are kept.
        self._bodies = {number: (body.name, body.spec) for number, body in bodies.items()}

    def __repr__(self) -> str:
        height, width = self.depth.shape
        seen = np.count_nonzero(np.unique(self.body_ids) != NOTHING)
        return f"<CameraImage {width} x {height}, {seen} bodies in view>"

    def _repr_png_(self) -> bytes:
        """The colours as a PNG file, for notebooks."""
        from PIL import Image

        file = BytesIO()
        Image.fromarray(self.colour).save(file, "png")
        return file.getvalue()

    def save(self, path: str | Path) -> None:
        """Write the colours as an image file, in the format that its name ends with, such as `.png`.

        Raises:
            ValueError: There is no such format.
        """
        from PIL import Image

        Image.fromarray(self.colour).save(path)

    def mask(self, body: Body | int | str, link: Link | int | str | None = None) -> NDArray[np.bool_]:
        """The pixels in which a body, or one link of it, is visible.

        Args:
            body: Handle, id or name; if several bodies have the name, `NAME#ID` as in `names`.
            link: Handle, index (-1 is the base) or name; None for the whole body.

        Returns:
            (height, width) booleans, true where the body or link is visible.

        Raises:
            KeyError: No such body or link existed when the image was taken, or several bodies have the name.
        """
        identifier = self._identifier(body)
        seen: NDArray[np.bool_] = self.body_ids == identifier
        if link is not None:
            seen &= self.link_indices == self._link_index(identifier, link)
        return seen

    def names(self) -> dict[str, int]:
        """Number of pixels of each visible link, by its name as `body/link`.

        Bodies of the same name are told apart by their ids: `arm#0/hand`, `arm#1/hand`. So are links of one
        body by their indices.
        """
        labels, counts = np.unique(
            np.stack([self.body_ids, self.link_indices], axis=-1).reshape(-1, 2), axis=0, return_counts=True
        )
        result: dict[str, int] = {}
        for (identifier, link), count in zip(labels.tolist(), counts.tolist(), strict=True):
            if identifier != NOTHING:
                body = self._names[identifier]
                links = distinct(dict(enumerate(self._link_names(identifier), start=-1)))
                result[f"{body}/{links[link]}"] = count
        return result

    def point_cloud(self, *, frame: Literal["world", "camera"] = "world") -> PointCloud:
        """The points of all pixels except the background, row by row.

        Args:
            frame: Axes of the points: those of the world, or of the camera (x to the right, y down,
                z forwards).
        """
        if frame not in ("world", "camera"):
            raise ValueError(f"frame must be 'world' or 'camera', not {frame!r}")
        rows, columns = np.nonzero(self.body_ids != NOTHING)
        fx, fy, cx, cy = self._intrinsics
        z = self.depth[rows, columns].astype(np.float64)
        spread = np.ones_like(z) if self._is_orthographic else z
        points = np.stack([(columns - cx) / fx * spread, (rows - cy) / fy * spread, z], axis=1)
        if frame == "world":
            position, orientation = self.camera_pose
            rotation = poses_to_matrices(np.concatenate([position, orientation])[None])[0, :3, :3]
            points = product(points, rotation.T) + position
        return PointCloud(points, self.colour[rows, columns], self.body_ids[rows, columns])

    @cached_property
    def _names(self) -> dict[int, str]:
        """Names of the bodies by their ids, each of them once."""
        return distinct({number: name for number, (name, _) in self._bodies.items()})

    def _link_names(self, identifier: int) -> list[str]:
        spec = self._bodies[identifier][1]
        return [link.name for link in (spec.base, *spec.links)]

    def _identifier(self, body: Body | int | str) -> int:
        if not isinstance(body, str):
            identifier = int(body) if isinstance(body, (int, np.integer)) else body.id
            if identifier in self._bodies:
                return identifier
            raise KeyError(f"there was no body {body!r} when the image was taken")
        for identifier, name in self._names.items():
            if name == body:
                return identifier
        several = [self._names[number] for number, (name, _) in self._bodies.items() if name == body]
        if several:
            raise KeyError(f"several bodies are called {body!r}: {', '.join(several)}")
        raise KeyError(f"there was no body {body!r} when the image was taken")

    def _link_index(self, identifier: int, link: Link | int | str) -> int:
        body, links = self._names[identifier], self._link_names(identifier)
        if isinstance(link, str):
            if link not in links:
                raise KeyError(f"body {body!r} has no link {link!r}")
            return links.index(link) - 1
        index = int(link) if isinstance(link, (int, np.integer)) else link.index
        if not -1 <= index < len(links) - 1:
            raise KeyError(f"body {body!r} has no link {index}")
        return index


def bodies_and_links(label: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Ids of bodies and indices of their links (-1: the base) from labels of the renderer, in their memory.

    Both are -1 for the background.
    """
    # A label of the background has all bits set.
    background = label >> 31
    links = label >> LINK_SHIFT
    links -= background
    links -= 1
    label &= _BODY_BITS
    label |= background
    return label, links


def distinct(names: dict[int, str]) -> dict[int, str]:
    """The names of numbered things, with `#NUMBER` behind those that several have."""
    count = Counter(names.values())
    return {number: name if count[name] == 1 else f"{name}#{number}" for number, name in names.items()}
