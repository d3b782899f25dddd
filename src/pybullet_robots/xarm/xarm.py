"""An xArm on a table, with a slider for each joint: `python -m pybullet_robots.xarm.xarm`."""

from __future__ import annotations

import pybullet
import pybullet_data
from pybullet_robots._sliders import follow_sliders


def main() -> None:
    """Runs until the window is closed."""
    pybullet.connect(pybullet.GUI)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    pybullet.loadURDF("table/table.urdf", [0, 0, -0.625], useFixedBase=True)
    follow_sliders(pybullet.loadURDF("xarm/xarm6_robot.urdf", useFixedBase=True), 5 * 240.0)


if __name__ == "__main__":
    main()
