"""Cameras whose files state a sensor, focal lengths and where the optical axis meets the image."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.each import each

from carom import World, Worlds
from carom.errors import DescriptionError
from carom.world.scene import Scene

FILE = """<mujoco><worldbody><geom size=".01" pos="0 0 -1" rgba="1 0 0 1"/>
<camera name="eye" {}/></worldbody></mujoco>"""
SENSOR = 'resolution="40 30" sensorsize=".04 .03"'


def loaded(folder: Path, attributes: str) -> Scene:
    (folder / "file.xml").write_text(FILE.format(attributes))
    return World().load(folder / "file.xml")


@each(
    ("attributes", "intrinsics"),
    [
        # By MuJoCo 4.0's frusta: the axis is left of the middle, and above it, where `principal` is positive.
        (f'{SENSOR} focal=".05 .06" principal=".002 .001"', (50.0, 60.0, 17.5, 13.5)),
        (f'{SENSOR} focalpixel="50 60" principalpixel="2 1"', (50.0, 60.0, 17.5, 13.5)),
        # Numbers of pixels come first.
        (f'{SENSOR} focal=".05 .06" focalpixel="50 70"', (50.0, 70.0, 19.5, 14.5)),
        ('resolution="40 30" fovy="90"', (15.0, 15.0, 19.5, 14.5)),
    ],
)
def test_a_camera_has_its_intrinsics(tmp_path: Path, attributes: str, intrinsics: tuple[float, ...]):
    scene = loaded(tmp_path, attributes)
    camera = scene.camera("eye")
    (fx, _, cx), (_, fy, cy), _ = camera.intrinsics
    assert_allclose((fx, fy, cx, cy), intrinsics)
    assert not scene.ignored.that_matter


def test_what_is_on_its_axis_is_seen_there(tmp_path: Path):
    scene = loaded(tmp_path, f'{SENSOR} focal=".5 .5" principal=".01 .005"')
    rows, columns = np.nonzero(np.isfinite(scene.camera("eye").capture(scene.world).depth))
    assert (rows.mean(), columns.mean()) == pytest.approx((9.5, 9.5), abs=0.5)


def test_orthographic_cameras_see_far_things_as_large_as_near_ones(tmp_path: Path):
    (tmp_path / "file.xml").write_text(
        """<mujoco><worldbody><geom size=".1" pos="-.4 .25 -1"/><geom size=".1" pos=".2 -.1 -9"/>
<camera name="eye" projection="orthographic" fovy="2" resolution="200 160"/></worldbody></mujoco>"""
    )
    scene = World().load(tmp_path / "file.xml")
    assert not scene.ignored
    camera = scene.camera("eye")
    image = camera.capture(scene.world)
    assert image.depth.min() == pytest.approx(0.9, abs=1e-2)
    for near, far, place in ((0.0, 2.0, (-0.4, -0.25)), (2.0, 20.0, (0.2, 0.1))):
        rows, columns = np.nonzero((image.depth > near) & (image.depth < far))
        # 80 pixels for a metre, from the middle; y is down.
        assert np.ptp(rows) + 1 == pytest.approx(16, abs=1)
        middle = (columns.mean() - 99.5) / 80.0, (rows.mean() - 79.5) / 80.0
        assert middle == pytest.approx(place, abs=0.01)
    points = image.point_cloud().points
    nearest = points[points[:, 2].argmax()]
    assert_allclose(nearest, (-0.4, 0.25, -0.9), atol=0.02)
    images = Worlds(scene.world, 2).images(camera)
    for depth in images.depth:
        assert_allclose(depth, image.depth)
    with pytest.raises(ValueError, match="no field of view"):
        camera.projections(np.array([45.0]))


def test_projections_without_a_meaning_are_refused(tmp_path: Path):
    with pytest.raises(DescriptionError, match="must be perspective or orthographic"):
        loaded(tmp_path, 'projection="fisheye"')


@each("attributes", ['focal="1 1"', 'principal="0 0"', 'sensorsize="0 1" focal="1 1"'])
def test_lenses_without_a_sensor_are_refused(tmp_path: Path, attributes: str):
    with pytest.raises(DescriptionError, match="sensorsize"):
        loaded(tmp_path, attributes)
