"""Viewing a robot: `python -m carom view`, with a slider for each joint and no gravity."""

from __future__ import annotations

import time
from math import isfinite, pi
from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.any_file import read_robots
from carom.formats.search import AssetSearch
from carom.layouts.codes import SLIDING_JOINTS
from carom.layouts.flags import LoadFlags
from carom.model.from_files import usd_solids
from carom.scene.body import Body
from carom.soft.from_urdf import robot_body
from carom.viewer.items import Slider
from carom.viewer.viewer import Viewer
from carom.world.world import World

_PERIOD = 1.0 / 60.0
# Range of the sliders of joints without limits, to either side of 0 [rad or m].
_FULL_TURN = pi
_SLIDE = 1.0
# Distance of the camera from the robot, in sizes of the robot.
_DISTANCE = 1.1
_LOOKS = (
    LoadFlags.USE_MATERIAL_COLORS_FROM_MTL
    | LoadFlags.USE_MATERIAL_TRANSPARENCY_FROM_MTL
    | LoadFlags.ONLY_MATERIALS_THERE_ARE
)


class RobotView:
    """Shows the robots of a file (URDF, SDF or MJCF), and moves their joints by sliders.

    Raises:
        DescriptionError: The file cannot be used, or there is no robot in it.
        OSError: The page cannot be served at this address and port.

    Attributes:
        viewer: The viewer.
    """

    def __init__(self, file: Path, search: AssetSearch, host: str, port: int | None) -> None:
        self._world = World()
        bodies = [
            self._world.load(
                robot_body(placed.robot, flags=_LOOKS, fixed_base=True),
                placed.pose.position,
                placed.pose.orientation,
            )
            for placed in read_robots(file, search=search, solids=usd_solids)[1]
        ]
        if not bodies:
            raise DescriptionError("it holds no robot", file=file)
        self.viewer: Viewer = Viewer(self._world, host=host, port=port, title=file.name)
        self.viewer.configure({"names": True})
        self._sliders: list[tuple[Body, int, Slider]] = []
        for body in bodies:
            self._add_sliders(body)
        self._look_at_it()
        self.viewer.open_browser()

    def run(self) -> None:
        """Update the joints from the sliders until the user closes the page."""
        while self.viewer.is_open:
            self.follow()
            time.sleep(_PERIOD)

    def follow(self) -> None:
        """Set the joint positions to the values of the sliders."""
        for body, joint, slider in self._sliders:
            if body.joints[joint].position != slider.value:
                body.set_joint_state(joint, [slider.value], [0.0])

    def _add_sliders(self, body: Body) -> None:
        for joint, code in enumerate(body.joint_types):
            if body.velocity_count[joint] != 1:
                continue
            reach = _SLIDE if code in SLIDING_JOINTS else _FULL_TURN
            lower, upper = body.joints[joint].limits
            if not (isfinite(lower) and isfinite(upper) and lower < upper):
                lower, upper = -reach, reach
            slider = Slider(body.joints[joint].name, lower, upper, min(max(0.0, lower), upper))
            self.viewer.controls.add(len(self._sliders), slider)
            self._sliders.append((body, joint, slider))

    def _look_at_it(self) -> None:
        """Move the camera so that all links are in view."""
        self.follow()
        points = self._world.link_pose[:, :3]
        lower, upper = points.min(axis=0), points.max(axis=0)
        x, y, z = (float(value) for value in 0.5 * (lower + upper))
        size = max(float(max(upper - lower)), 0.5)
        self.viewer.camera.move(_DISTANCE * size, 50.0, -20.0, (x, y, z))
