"""Previews of the last camera image of a script, and the pose of its camera."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.render.image_target import RawImage

# Width of previews, unless a page that shows larger ones asks for more; and the largest width [pixels].
_WIDTH = 200
_MAX_WIDTH = 640
# Minimum interval between previews [s]; scripts may take hundreds of images a second.
_PERIOD = 0.1
# Each label rotates the hue by the golden ratio [turns], so that neighbouring labels get different colours.
_HUE_STEP = 0.61803398875
# Depth of the frustum that is drawn for a camera [m].
_PYRAMID_DEPTH = 0.25
# Corners of the image, one after the other, in OpenGL's coordinates.
_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


class _Taken(NamedTuple):
    """The points of an image that its preview has, and the matrix (4, 4) from the world to clip space."""

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    label: NDArray[np.int32]
    camera: NDArray[np.float64]


class Previews:
    """Shows colours, depth and segmentation of images among the latest messages.

    Of images that are taken one after the other, or while nobody looks, the last one waits for `catch_up`.
    """

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self._due = 0.0
        self._corners: list[list[float]] | None = None
        self._widths: dict[int, int] = {}
        self._waiting: _Taken | None = None

    def ask(self, page: int, width: int) -> None:
        """Sets the width that a page needs at least, as far as images have it [pixels]."""
        self._widths[page] = min(max(width, 1), _MAX_WIDTH)

    def forget(self, page: int) -> None:
        """Drops what a page needed that has been closed."""
        self._widths.pop(page, None)

    def show(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Shows an image at the next `catch_up`; `camera` is (4, 4), from world to clip coordinates."""
        every = -(-image.rgba.shape[1] // max([_WIDTH, *self._widths.copy().values()]))
        small = np.s_[::every, ::every]
        # The script may write to its image.
        self._waiting = _Taken(
            image.rgba[small][..., :3].copy(), image.depth[small].copy(), image.label[small].copy(), camera
        )

    def catch_up(self, *, at_once: bool = False) -> None:
        """Shows the image that waits, unless another one was just shown, or also then."""
        taken, now = self._waiting, monotonic()
        if taken is None or (now < self._due and not at_once):
            return
        self._due = now + _PERIOD
        pictures = [taken.colour, _shades(taken.depth), _colours(taken.label)]
        height, width = taken.label.shape
        header = to_page.PREVIEWS(width=width, height=height)
        self._latest.put("previews", header, b"".join(picture.tobytes() for picture in pictures))
        self._show_pyramid(taken.camera)
        if self._waiting is taken:
            self._waiting = None

    def _show_pyramid(self, camera: NDArray[np.float64]) -> None:
        """Shows the near part of the camera's frustum."""
        corners = pyramid(camera)
        # A camera that does not move is shown once.
        if corners is not None and corners != self._corners:
            self._corners = corners
            self._latest.put("pyramid", to_page.PYRAMID(corners=corners))


def pyramid(camera: NDArray[np.float64]) -> list[list[float]] | None:
    """Corners in the world of a camera's frustum from its near plane to 25 cm behind it: four near, four far.

    `camera` is the (4, 4) matrix from the world to clip coordinates, as in OpenGL; None without an inverse.
    """
    try:
        back = np.linalg.inv(camera)
    except np.linalg.LinAlgError:
        return None
    ends = []
    for plane in (-1.0, 1.0):
        points = np.column_stack((_CORNERS, np.full(4, plane), np.ones(4))) @ back.T
        ends.append(points[:, :3] / points[:, 3:])
    near, far = ends
    depth = float(np.linalg.norm((far - near).mean(axis=0)))
    corners = np.concatenate((near, near + (far - near) * min(1.0, _PYRAMID_DEPTH / max(depth, 1e-9))))
    return corners.round(5).tolist() if np.isfinite(corners).all() else None


def _shades(depth: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Grey levels of a depth image; near is dark.

    They show ranks, not depths: most of a scene's range of depths is at its horizon.
    """
    shades = np.full(depth.shape, 255, dtype=np.uint8)
    seen = depth < 1.0
    _, ranks = np.unique(depth[seen], return_inverse=True)
    if ranks.size:
        shades[seen] = 40 + 190 * ranks.reshape(-1) // max(int(ranks.max()), 1)
    return np.repeat(shades[..., None], 3, axis=2)


def _colours(labels: NDArray[np.int32]) -> NDArray[np.uint8]:
    """A colour for each label; white for negative labels."""
    hue = (labels.astype(np.float64)[..., None] * _HUE_STEP + np.array([0.0, 1.0 / 3.0, 2.0 / 3.0])) % 1.0
    colours = 90.0 + 150.0 * np.clip(np.abs(6.0 * hue - 3.0) - 1.0, 0.0, 1.0)
    return np.where(labels[..., None] < 0, 255.0, colours).astype(np.uint8)
