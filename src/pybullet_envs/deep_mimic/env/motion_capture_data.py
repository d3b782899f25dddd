"""Files of recorded motions: JSON with a list `Frames` of frames: time to the next frame, then a pose."""

from __future__ import annotations

import json
from math import floor
from typing import Any


class MotionCaptureData:
    """A recorded motion. The first three numbers of a pose are the position of the base [m]."""

    def __init__(self) -> None:
        self.Reset()

    def Reset(self) -> None:
        """Removes the motion."""
        self._motion_data: dict[str, Any] = {"Frames": []}
        self._cycleOffset = [0.0, 0.0, 0.0]

    def Load(self, path: str) -> None:
        """Reads a file; raises `OSError` or `ValueError` if it cannot be read or has no frames."""
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        if not isinstance(data, dict) or not data.get("Frames"):
            raise ValueError(f"{path} has no frames in a list 'Frames'")
        self._motion_data = data

    def NumFrames(self) -> int:
        """The number of poses."""
        return len(self._motion_data["Frames"])

    def KeyFrameDuraction(self) -> float:
        """Time from one pose to the next [s]."""
        return self._motion_data["Frames"][0][0]

    def getCycleTime(self) -> float:
        """Time from the first pose to the last [s]."""
        return self.KeyFrameDuraction() * (self.NumFrames() - 1)

    def calcCycleCount(self, simTime: float, cycleTime: float) -> int:
        """The number of complete cycles at a time [s]."""
        return floor(simTime / cycleTime)

    def computeCycleOffset(self) -> list[float]:
        """Displacement of the base from the first pose to the last [m]."""
        first, last = self._motion_data["Frames"][0], self._motion_data["Frames"][-1]
        self._cycleOffset = [end - start for start, end in zip(first[1:4], last[1:4], strict=True)]
        return self._cycleOffset
