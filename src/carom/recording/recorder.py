"""Recording a video of a world while it is stepped."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.checks import positive
from carom.recording.video import VideoFile

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.world.world import World

# Tolerance for rounding errors in sums of time steps, as a fraction of the interval between two pictures.
_EARLY = 1e-6
# Maximum number of pictures per step: the video of a longer step is cut short.
_MAX_OF_A_STEP = 240


class Film:
    """Takes pictures at even intervals of simulated time [s]; one of `World.observers`.

    The first picture shows the world before the next step. If a step is longer than the interval, its picture
    is repeated. `take` renders a picture: (height, width, 3) red, green and blue.

    Attributes:
        automatic: Take pictures as time passes; otherwise only `shoot` takes pictures.
    """

    def __init__(
        self, world: World, file: VideoFile, interval: float, take: Callable[[], NDArray[np.uint8]]
    ) -> None:
        self.automatic = True
        self._world = world
        self._file = file
        self._interval = float(positive(interval, "interval"))
        self._take = take
        # Time until the next picture, in intervals; None until the first step.
        self._due: float | None = None
        self._last = 0.0

    def shoot(self) -> None:
        """Takes a picture now."""
        self._file.add(self._take())

    def before_step(self) -> None:
        """Takes the first picture."""
        if self._due is None:
            self._due = 1.0
            self._last = float(self._world.time)
            if self.automatic:
                self.shoot()

    def after_step(self) -> None:
        """Takes the pictures that are due."""
        assert self._due is not None
        time = float(self._world.time)
        # Time goes back when a state is restored: the video continues.
        self._due -= max(time - self._last, 0.0) / self._interval
        self._last = time
        if not self.automatic or self._due > _EARLY:
            return
        picture = self._take()
        self._due = max(self._due, 1.0 - _MAX_OF_A_STEP)
        while self._due <= _EARLY:
            self._file.add(picture)
            self._due += 1.0

    def close(self) -> None:
        """Finishes the file."""
        self._file.close()


class Recorder:
    """Records a world with a camera into an MP4 file. Needs PyAV: `pip install 'carom[video]'`.

        with Recorder("fall.mp4", camera, world):
            world.step(480)

    It is a context manager: recording stops when the context is left.

    Args:
        path: The file; an existing one is replaced.
        camera: The camera, mounted on a link or fixed in the world; it may be moved while it records.
        world: The world to record; by default the world of the link that the camera is mounted on.
        fps: Pictures per second of video.
        speed: Simulated time / time of the video; below 1 for slow motion.

    Raises:
        ImportError: PyAV is not installed.
        OSError: The file cannot be written.
        ValueError: No world is given and the camera is not mounted, or a number is not positive.
    """

    def __init__(
        self,
        path: str | Path,
        camera: Camera,
        world: World | None = None,
        *,
        fps: float = 30.0,
        speed: float = 1.0,
    ) -> None:
        if world is None and camera.link is not None:
            world = camera.link.body.world
        if world is None:
            raise ValueError("a camera that is not mounted needs to be told which world to look at")
        self._world = world
        interval = float(positive(speed, "speed") / positive(fps, "fps"))
        file = VideoFile(path, camera.width, camera.height, fps)
        self._film = Film(world, file, interval, lambda: camera.capture(world).colour)
        world.observers.append(self._film)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Stops recording and finishes the file; calling it again does nothing."""
        if self._film in self._world.observers:
            self._world.observers.remove(self._film)
        self._film.close()
