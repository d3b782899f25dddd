"""Recording a world into one HTML file that replays it."""

from __future__ import annotations

from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any

from carom.checks import positive
from carom.viewer.details import DetailRequest, Details
from carom.viewer.latest_messages import LatestMessages, Reader, latest_of
from carom.viewer.messages import decoded
from carom.viewer.notebook import replay_frame
from carom.viewer.protocol import to_page
from carom.viewer.replay.page import replay_of
from carom.viewer.replay.recording import Recording
from carom.viewer.scene_feed import SceneFeed
from carom.writing import write_text

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

_PAGE = 1
# Tolerance for rounding errors in sums of time steps, as a fraction of the interval between two frames.
_EARLY = 1e-6
# Kinds of messages that are recorded (`Message.kind`); the others are only for live pages.
_OF_BODIES = frozenset({"body", "mesh", "texture", "layout", "dynamics", "constraints"})
_OF_SCRIPTS = frozenset({"item", "slider"})


class ReplayRecorder:
    """Records a world into an HTML file; `World.record` makes one. One of `World.observers`.

    It is a context manager: the file is written when the context is left.

    Args:
        world: The world.
        path: The file; an existing one is replaced.
        fps: Frames for each second of simulated time.
        title: Title of the page; the name of the file by default.
        contacts: Record contacts and their forces.
        joints: Record positions, velocities and torques of joints.

    Raises:
        ValueError: The rate is not positive.
    """

    def __init__(
        self,
        world: WorldCore,
        path: str | Path,
        *,
        fps: float = 60.0,
        title: str | None = None,
        contacts: bool = True,
        joints: bool = True,
    ) -> None:
        self._world = world
        self._path = Path(path)
        self._title = self._path.stem if title is None else title
        self._interval = 1.0 / float(positive(fps, "fps"))
        self._latest = LatestMessages()
        self._bodies = self._latest.reader()
        # The latest messages of the viewer has the drawings of scripts.
        self._scripts: Reader | None = None
        lock = RLock()
        self._feed = SceneFeed(world, lock, self._latest)
        self._details = Details(world, lock, self._latest)
        wish = DetailRequest(
            contacts=contacts, joints="all" if joints else frozenset(), dynamics=True, constraints=True
        )
        self._details.want(_PAGE, wish)
        self._recording = Recording()
        self._due: float | None = None
        self._last = 0.0
        self._facts: dict[str, Any] = {}
        world.observers.append(self)

    def __enter__(self) -> ReplayRecorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def look_from(
        self, distance: float, yaw: float, pitch: float, target: tuple[float, float, float]
    ) -> None:
        """Sets the initial view; by default it shows everything.

        Args:
            distance: Distance from the camera to the target [m].
            yaw: Angle about the upward axis [degrees].
            pitch: Upward angle; a camera with a negative pitch looks down from above [degrees].
            target: The point that the camera looks at [m].
        """
        self._facts["camera"] = {"distance": distance, "yaw": yaw, "pitch": pitch, "target": target}

    def before_step(self) -> None:
        """Takes the first frame."""
        if self._due is None:
            self._due = 1.0
            self._last = float(self._world.time)
            self.shoot()

    def after_step(self) -> None:
        """Takes the frame that is due."""
        assert self._due is not None
        time = float(self._world.time)
        passed = time - self._last
        self._last = time
        # Time goes back when a state is restored: the next frame is taken at once.
        self._due = 0.0 if passed < 0.0 else self._due - passed / self._interval
        if self._due <= _EARLY:
            self.shoot()
            while self._due <= _EARLY:
                self._due += 1.0

    def shoot(self) -> None:
        """Takes a frame now."""
        blocks = self._details.blocks()
        frame = self._feed.frame({}, blocks)
        self._take_from(self._bodies, _OF_BODIES)
        if self._scripts is None and self._world in latest_of:
            self._scripts = latest_of[self._world].reader()
        if self._scripts is not None:
            self._take_from(self._scripts, _OF_SCRIPTS)
        if frame is not None:
            self._recording.add(*decoded(frame))

    def stop(self) -> None:
        """Stops recording and writes the file; calling it again does nothing.

        Raises:
            OSError: The file cannot be written.
        """
        if self not in self._world.observers:
            return
        self._world.observers.remove(self)
        self._details.want(_PAGE, DetailRequest())
        if self._recording.frame_count == 0 or self._last != float(self._world.time):
            self.shoot()
        self._scripts = None
        write_text(self._path, self._page())

    @property
    def frame_count(self) -> int:
        """Number of recorded frames."""
        return self._recording.frame_count

    def _repr_html_(self) -> str:
        """The recording so far, for notebooks, which needs no connection."""
        return replay_frame(self._page())

    def _page(self) -> str:
        return replay_of(self._recording.packed(title=self._title, **self._facts), self._title)

    def _take_from(self, reader: Reader, kept: frozenset[str]) -> None:
        for message in reader.messages():
            header, payload = decoded(message)
            message = to_page.declaration(header)
            if message.kind in kept:
                self._recording.add(header, payload)
            elif message is to_page.OPTIONS:
                self._facts["options"] = header
            elif message is to_page.CAMERA and header["chosen"]:
                self._facts.setdefault("camera", header)
