"""Video files."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import positive

# H.264 plays everywhere; some builds of PyAV lack it, but have MPEG-4.
_CODECS = ("libx264", "mpeg4")
# Better quality than the encoder's default, because rendered surfaces have sharp edges.
_QUALITY = {"crf": "18", "preset": "veryfast"}


class VideoFile:
    """An MP4 file being written, of pictures of one size. It can be played after it is closed.

    Raises:
        ImportError: PyAV is not installed.
        OSError: The file cannot be written.
        ValueError: The size or the rate is not positive.
    """

    def __init__(self, path: str | Path, width: int, height: int, fps: float) -> None:
        if width < 1 or height < 1:
            raise ValueError(f"a video of {width} x {height} pixels cannot be written")
        positive(fps, "fps")
        try:
            import av
        except ImportError:
            raise ImportError("videos need PyAV: pip install 'carom[video]'") from None
        self._frame_type = av.VideoFrame
        # The codecs halve the resolution of colours (4:2:0), so width and height have to be even.
        self._margin = ((0, height % 2), (0, width % 2), (0, 0))
        # FFmpeg would open the file only for the first picture; here errors are raised at once.
        self._file = open(path, "wb")  # noqa: SIM115 (it is written to until the video is closed)
        self._container: Any = av.open(self._file, "w", format="mp4")
        codec = next(name for name in _CODECS if name in av.codecs_available)
        self._stream: Any = self._container.add_stream(codec, rate=Fraction(fps).limit_denominator(1001))
        self._stream.width = width + width % 2
        self._stream.height = height + height % 2
        self._stream.pix_fmt = "yuv420p"
        if codec == "libx264":
            self._stream.options = _QUALITY

    def add(self, picture: NDArray[np.uint8]) -> None:
        """Writes the next picture: (height, width, 3) red, green and blue, the top row first."""
        padded = np.pad(picture, self._margin, mode="edge")
        frame = self._frame_type.from_ndarray(padded, format="rgb24")
        self._container.mux(self._stream.encode(frame))

    def close(self) -> None:
        """Finishes the file; closing it again does nothing."""
        container, self._container = self._container, None
        if container is not None:
            # Writes the header of a video that has no pictures.
            container.start_encoding()
            container.mux(self._stream.encode(None))
            container.close()
            self._file.close()
