"""Small pictures of what the last camera image of a script shows."""

from __future__ import annotations

from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.viewer.board import Board

_WIDTH = 200
# Scripts may take hundreds of images a second; people see less [s].
_PERIOD = 0.1
# Neighbouring numbers get colours far apart: each turns the hue by the golden ratio.
_HUE_STEP = 0.61803398875


class Previews:
    """Shows colours, depth and segmentation of images on the board."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._due = 0.0

    def show(self, rgba: NDArray[np.uint8], depth: NDArray[np.float32], labels: NDArray[np.int32]) -> None:
        """Shows an image, unless the last one is very recent.

        Args:
            rgba: (height, width, 4) colours.
            depth: (height, width) depth from 0 to 1, as OpenGL has it.
            labels: (height, width) numbers of bodies; -1 where there is nothing.
        """
        now = monotonic()
        if now < self._due:
            return
        self._due = now + _PERIOD
        every = -(-rgba.shape[1] // _WIDTH)
        small = np.s_[::every, ::every]
        pictures = [rgba[small][..., :3], _shades(depth[small]), _colours(labels[small])]
        height, width = pictures[0].shape[:2]
        header: dict[str, Any] = {"type": "previews", "width": width, "height": height}
        self._board.put("previews", header, b"".join(np.ascontiguousarray(p).tobytes() for p in pictures))


def _shades(depth: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Near is dark. Ranks and not distances are shown: most of the depth of a scene is its horizon."""
    shades = np.full(depth.shape, 255, dtype=np.uint8)
    seen = depth < 1.0
    _, ranks = np.unique(depth[seen], return_inverse=True)
    if ranks.size:
        shades[seen] = 40 + 190 * ranks.reshape(-1) // max(int(ranks.max()), 1)
    return np.repeat(shades[..., None], 3, axis=2)


def _colours(labels: NDArray[np.int32]) -> NDArray[np.uint8]:
    """A colour for each number; white for none."""
    hue = (labels.astype(np.float64)[..., None] * _HUE_STEP + np.array([0.0, 1.0 / 3.0, 2.0 / 3.0])) % 1.0
    colours = 90.0 + 150.0 * np.clip(np.abs(6.0 * hue - 3.0) - 1.0, 0.0, 1.0)
    return np.where(labels[..., None] < 0, 255.0, colours).astype(np.uint8)
