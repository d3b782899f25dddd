"""The hand of a Panda draws ellipses over a tray, and takes pictures as it goes."""

from __future__ import annotations

from math import cos, sin

from pybullet_robots.panda._arm import (
    ARM_JOINTS,
    END_EFFECTOR,
    FIRST_POSE,
    LOWER,
    RANGES,
    UPPER,
    PandaOverTray,
)

useNullSpace = 1
ikSolver = 0
pandaEndEffectorIndex = END_EFFECTOR
pandaNumDofs = ARM_JOINTS
ll, ul, jr = LOWER, UPPER, RANGES
jointPositions = rp = FIRST_POSE


class PandaSim(PandaOverTray):
    """An arm that moves by a sixtieth of a second with each `step`."""

    takes_pictures = True

    def step(self) -> None:
        """Sets the motors; `stepSimulation` is for the script to call."""
        if self.takes_pictures:
            self.bullet_client.getCameraImage(320, 200)
        x, y, z = self.offset
        place = [x + 0.2 * sin(1.5 * self.t), y + 0.044, z - 0.6 + 0.1 * cos(1.5 * self.t)]
        self.t += 1.0 / 60.0
        self._move_hand(place, 5)
