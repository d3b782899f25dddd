"""The camera, which scripts and pages move."""

from __future__ import annotations

from dataclasses import dataclass, replace

from carom.description.pose import Vector3
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page


@dataclass(frozen=True, slots=True)
class Orbit:
    """A camera that circles a target [m]: distance [m], angles [degrees], and size of the image [pixels].

    Yaw is about the upward axis; with a negative pitch the camera looks down from above.
    """

    distance: float = 5.0
    yaw: float = 50.0
    pitch: float = -35.0
    target: Vector3 = (0.0, 0.0, 0.0)
    width: int = 1024
    height: int = 768


class SharedCamera:
    """The camera. A script moves the cameras of all pages; a page moves its own and reports its pose.

    Attributes:
        orbit: The last pose, set by a script or a page.
        chosen: Whether a script or a user has set the view; until then pages fit all bodies into it.
    """

    def __init__(self, latest: LatestMessages, width: int, height: int) -> None:
        self._latest = latest
        self.orbit: Orbit = Orbit(width=width, height=height)
        self.chosen: bool = False
        self._by_script: bool = False
        latest.put("camera", self._message())

    def move(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """Moves the cameras of all pages, for a script."""
        self.chosen = self._by_script = True
        self.orbit = replace(self.orbit, distance=distance, yaw=yaw, pitch=pitch, target=target)
        self._latest.put("camera", self._message())

    def moved(
        self, distance: float, yaw: float, pitch: float, target: Vector3, *, chosen: bool = True
    ) -> None:
        """Records the camera pose of a page: set by its user or, if not `chosen`, by the page itself."""
        if self.chosen and not chosen:
            return
        self.chosen, self._by_script = chosen, False
        self.orbit = replace(self.orbit, distance=distance, yaw=yaw, pitch=pitch, target=target)
        self._latest.amend("camera", self._message())

    def resized(self, width: int, height: int) -> None:
        """Records the new size of a page's image [pixels]."""
        self.orbit = replace(self.orbit, width=width, height=height)

    def _message(self) -> dict[str, object]:
        view = {name: getattr(self.orbit, name) for name in ("distance", "yaw", "pitch", "target")}
        return to_page.CAMERA(**view, chosen=self.chosen, script=self._by_script)
