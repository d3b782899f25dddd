"""Frames that the user moves with the mouse."""

from __future__ import annotations

from math import hypot, isfinite

from carom.description.pose import Quaternion, Vector3
from carom.viewer.board import Board
from carom.viewer.items import Handle


class Handles:
    """Handles by number, on the board. Safe to use from all threads."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._handles: dict[int, Handle] = {}

    def add(self, handle: Handle) -> None:
        """Shows a handle."""
        number = len(self._handles)
        self._handles[number] = handle
        self._show(number, handle)

    def move(self, number: int, position: Vector3, orientation: Quaternion) -> None:
        """Sets the pose of a handle, moved by the user; unknown handles and invalid poses are ignored."""
        handle = self._handles.get(number)
        length = hypot(*orientation)
        if handle is None or not all(map(isfinite, (*position, *orientation))) or length < 1e-6:
            return
        x, y, z, w = (part / length for part in orientation)
        # Position and orientation are replaced together, because other threads may read them.
        handle.pose = (position, (x, y, z, w))
        self._show(number, handle)

    def _show(self, number: int, handle: Handle) -> None:
        position, orientation = handle.pose
        header = {"type": "handle", "handle": number, "name": handle.name}
        self._board.put(("handle", number), {**header, "position": position, "orientation": orientation})
