"""A Panda arm whose hand moves along an ellipse over a tray, with a camera image at each step."""

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
    """A Panda arm; each `step` advances the path of its hand by 1/60 s."""

    takes_pictures = True

    def step(self) -> None:
        """Sets the motors; the script calls `stepSimulation`."""
        if self.takes_pictures:
            self.bullet_client.getCameraImage(320, 200)
        x, y, z = self.offset
        place = [x + 0.2 * sin(1.5 * self.t), y + 0.044, z - 0.6 + 0.1 * cos(1.5 * self.t)]
        self.t += 1.0 / 60.0
        self._move_hand(place, 5)
