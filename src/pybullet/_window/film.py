"""Videos of the window's view, drawn by the software renderer."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.camera import DAYLIGHT
from carom.recording.recorder import Film
from carom.recording.video import VideoFile
from carom.render.camera_image import NOTHING
from carom.render.renderer import renderer_of
from pybullet._maths.camera_maths import window_lens
from pybullet._window.view import square, view_of_window

if TYPE_CHECKING:
    from pybullet._clients.clients import Client

PICTURES_PER_SECOND = 60.0
"""Default rate of videos, which is that of PyBullet's windows."""

# Width and height without a window [pixels].
_WIDTH, _HEIGHT = 640, 480
# PyBullet's background.
_BACKGROUND = (0.7, 0.7, 0.8)


def film_of(client: Client, path: Path, fps: float = PICTURES_PER_SECOND) -> Film:
    """A video of the world of a client, seen from the camera of its window.

    Its size is the present size of the window. It takes a picture each `1 / fps` seconds of simulated time,
    so it plays in simulated time. A client has one video at a time, as in PyBullet: the one before ends.

    Raises:
        ImportError: PyAV is not installed.
        OSError: The file cannot be written.
        ValueError: The rate is not positive.
    """
    with client.call_lock:
        client.logs.stop_videos(client.world)
    width, height = (int(size) for size in client.window.camera_info()[:2] if isinstance(size, int))
    width, height = width or _WIDTH, height or _HEIGHT
    projection = square(window_lens(width / height))

    def picture() -> NDArray[np.uint8]:
        world = client.world
        image = renderer_of(world).draw(world, view_of_window(client), projection, width, height, DAYLIGHT)
        colour = np.ascontiguousarray(image.rgba[:, :, :3])
        background = client.window.background or _BACKGROUND
        colour[image.label == NOTHING] = [round(255 * min(max(part, 0.0), 1.0)) for part in background]
        return colour

    return Film(client.world, VideoFile(path, width, height, fps), 1.0 / fps, picture)
