"""Files of recorded motions: JSON with a list `Frames`, each the time to the next and then a pose."""

from __future__ import annotations

import json
from math import floor
from typing import Any


class MotionCaptureData:
    """A recorded motion. The first three numbers of a pose are the position of the base."""

    def __init__(self) -> None:
        self.Reset()

    def Reset(self) -> None:
        """Forgets the motion."""
        self._motion_data: dict[str, Any] = {"Frames": []}
        self._cycleOffset = [0.0, 0.0, 0.0]

    def Load(self, path: str) -> None:
        """Reads a file; raises `OSError` or `ValueError` where it cannot be read or holds no frames."""
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        if not isinstance(data, dict) or not data.get("Frames"):
            raise ValueError(f"{path} holds no list 'Frames'")
        self._motion_data = data

    def NumFrames(self) -> int:
        """How many poses there are."""
        return len(self._motion_data["Frames"])

    def KeyFrameDuraction(self) -> float:
        """Time from one pose to the next [s]."""
        return self._motion_data["Frames"][0][0]

    def getCycleTime(self) -> float:
        """Time from the first pose to the last [s]."""
        return self.KeyFrameDuraction() * (self.NumFrames() - 1)

    def calcCycleCount(self, simTime: float, cycleTime: float) -> int:
        """How often the motion has been gone through at a time [s]."""
        return floor(simTime / cycleTime)

    def computeCycleOffset(self) -> list[float]:
        """How far the base comes from the first pose to the last [m]."""
        first, last = self._motion_data["Frames"][0], self._motion_data["Frames"][-1]
        self._cycleOffset = [end - start for start, end in zip(first[1:4], last[1:4], strict=True)]
        return self._cycleOffset
