"""The camera, which scripts and pages move."""

from __future__ import annotations

from dataclasses import dataclass, replace

from carom.description.pose import Vector3
from carom.viewer.board import Board


@dataclass(frozen=True, slots=True)
class Orbit:
    """A camera that circles a target.

    Attributes:
        distance: To the target [m].
        yaw: About the upward axis [degrees].
        pitch: Upwards; negative looks down from above [degrees].
        target: What it looks at [m].
        width: Of the image in pixels.
        height: Of the image.
    """

    distance: float = 5.0
    yaw: float = 50.0
    pitch: float = -35.0
    target: Vector3 = (0.0, 0.0, 0.0)
    width: int = 1024
    height: int = 768


class SharedCamera:
    """The camera. A script moves that of every page; a page moves its own, and tells.

    Attributes:
        orbit: Its last pose, set by a script or a page.
        chosen: A script or a user has set the view; until then pages fit all bodies.
    """

    def __init__(self, board: Board, width: int, height: int) -> None:
        self._board = board
        self.orbit: Orbit = Orbit(width=width, height=height)
        self.chosen: bool = False
        board.put("camera", self._message())

    def move(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """A script moves the camera of every page."""
        self.chosen = True
        self.orbit = replace(self.orbit, distance=distance, yaw=yaw, pitch=pitch, target=target)
        self._board.put("camera", self._message())

    def moved(
        self, distance: float, yaw: float, pitch: float, target: Vector3, *, chosen: bool = True
    ) -> None:
        """The camera of a page was moved, by its user or, if it is not `chosen`, by the page."""
        if self.chosen and not chosen:
            return
        self.chosen = chosen
        self.orbit = replace(self.orbit, distance=distance, yaw=yaw, pitch=pitch, target=target)
        self._board.amend("camera", self._message())

    def resized(self, width: int, height: int) -> None:
        """The image of a page has a new size."""
        self.orbit = replace(self.orbit, width=width, height=height)

    def _message(self) -> dict[str, object]:
        orbit = self.orbit
        return {
            "type": "camera",
            "distance": orbit.distance,
            "yaw": orbit.yaw,
            "pitch": orbit.pitch,
            "target": orbit.target,
            "chosen": self.chosen,
        }
