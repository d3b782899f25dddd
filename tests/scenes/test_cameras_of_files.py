"""Cameras of MJCF files, as cameras for images; places and directions are MuJoCo's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from carom import World
from carom.world.scene import Scene

FILE = """<mujoco><compiler angle="radian"/><worldbody>
  <camera name="over" pos="0 0 2" xyaxes="1 0 0 0 0.6 0.8"/>
  <body name="arm" pos="0.3 0 1"><joint name="j" axis="0 1 0" pos="0.1 0 0"/><geom size="0.1" pos="0.2 0 0"/>
    <body name="tip" pos="0.4 0 0"><joint name="k" axis="0 0 1" pos="0 0.2 0"/><geom size="0.05"/>
      <camera name="hand" pos="0.1 0 0.05" euler="0.2 0.3 0.4" fovy="60" resolution="64 48"/></body></body>
  <body name="ball" pos="0 1 1"><freejoint/><geom size="0.1"/><camera name="own" pos="0 0 0.2"/></body>
</worldbody></mujoco>"""
# Position, direction in which it looks, and direction of the upper edge, with both joints at 0.7 rad.
OF_MUJOCO = {
    "over": ((0, 0, 2), (0, 0.8, -0.6), (0, 0.6, 0.8)),
    "hand": (
        (0.818707, 0.111453, 0.712701),
        (-0.869568, -0.045215, -0.491738),
        (-0.460604, 0.433272, 0.774674),
    ),
    "own": ((0, 1, 1.2), (0, 0, -1), (0, 1, 0)),
}


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    file = tmp_path / "cameras.xml"
    file.write_text(FILE)
    scene = World().load(file)
    for joint in ("j", "k"):
        scene["arm"].joints[joint].reset(0.7)
    return scene


@pytest.mark.parametrize("name", OF_MUJOCO)
def test_a_camera_looks_where_the_file_has_it(name: str, scene: Scene) -> None:
    camera = scene.camera(name)
    turn = camera.view[:3, :3].T
    found = camera.pose.position, turn @ (0, 0, -1), turn @ (0, 1, 0)
    np.testing.assert_allclose(found, OF_MUJOCO[name], atol=1e-6)


def test_a_camera_has_the_size_and_the_field_of_view_of_the_file(scene: Scene) -> None:
    camera = scene.camera("hand")
    assert (camera.width, camera.height) == (64, 48)
    assert camera.intrinsics[1, 1] == pytest.approx(24 / np.tan(np.radians(30)))
    other = scene.camera("own", 200, 100)
    assert (other.width, other.height) == (200, 100)


def test_a_camera_that_is_not_there_is_named(scene: Scene) -> None:
    with pytest.raises(KeyError, match=r"has no camera 'eye'; it has 'over', 'hand', 'own'"):
        scene.camera("eye")
