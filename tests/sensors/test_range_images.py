"""Range finders that show more than distances, and those of cameras, beside MuJoCo 4.0."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.each import each
from tests.sensors.data.range_images import ANGLE, RANGES

from carom import RangeFinder, World, Worlds
from carom.description.sensor import RangeImage
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "data" / "range_images.json").read_text())


def loaded(world, tmp_path, text):
    (tmp_path / "ranges.xml").write_text(text)
    return world.load(tmp_path / "ranges.xml")


def test_they_show_what_those_of_mujoco_do(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, RANGES)
        assert not scene.ignored
        scene["a"].joints["j"].position = ANGLE
        assert list(scene.sensors) == list(ANSWERS)
        for name, answer in ANSWERS.items():
            np.testing.assert_allclose(np.ravel(scene.sensors[name].read()), answer, atol=2e-6, err_msg=name)


def test_many_worlds_have_their_own_images(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, RANGES)
        worlds = Worlds(world, 2)
        worlds.bodies["a"].joints.positions[1] = ANGLE
        many = worlds.bodies["a"].sensors["everything of a camera"].read()
        np.testing.assert_allclose(many[1], ANSWERS["everything of a camera"], atol=2e-6)
        np.testing.assert_allclose(
            many[0], np.ravel(scene.sensors["everything of a camera"].read()), atol=1e-9
        )


@each(
    ("lens", "is_orthographic"),
    [
        ('focal=".01 .012" principal=".001 .002" sensorsize=".02 .015"', False),
        ('fovy="40"', False),
        ('fovy="1.5" projection="orthographic"', True),
    ],
)
def test_they_agree_with_the_images_of_the_camera(tmp_path, lens, is_orthographic):
    text = f"""<mujoco><worldbody><geom type="plane" size="9 9 .1"/>
      <geom type="box" size=".3 .2 .2" pos=".2 .1 .2"/>
      <body name="a" pos="0 0 2" euler="10 20 30"><joint axis="0 1 0"/><geom size=".01"/>
        <camera name="c" {lens} resolution="24 16"/></body></worldbody>
      <sensor><rangefinder name="r" camera="c" data="depth"/></sensor></mujoco>"""
    with World() as world:
        scene = loaded(world, tmp_path, text)
        image = scene.camera("c").capture(world)
        depth = np.reshape(scene.sensors["r"].read(), (16, 24))
        seen = np.isfinite(image.depth)
        assert seen.mean() > 0.9
        # Edges of the box may be a pixel apart.
        near = np.abs(depth - image.depth) < 2e-3
        assert near[seen].mean() > 0.97, is_orthographic


def test_a_sensor_of_the_program_has_an_image(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, RANGES)
        half = RangeImage(3, 2, (1.0, 1.5))
        scene["a"].add_sensor("own", RangeFinder("s", shows=("dist", "dir"), image=half))
        distances, directions = np.split(scene["a"].sensors["own"].read().reshape(6, 4), [1], axis=1)
        # It looks up, along -z of a site whose z is down, and sees nothing; the other one down.
        assert (distances == -1.0).all()
        assert not directions.any()
        scene["a"].add_sensor("down", RangeFinder("looking up", shows=("dist", "dir"), image=half))
        distances, directions = np.split(scene["a"].sensors["down"].read().reshape(6, 4), [1], axis=1)
        np.testing.assert_allclose(directions[0] / -directions[0][2], (-1 / 3, 1 / 6, -1.0), atol=1e-9)
        assert distances[0] > 1.0
        with pytest.raises(DescriptionError, match="in this order"):
            scene["a"].add_sensor("bad", RangeFinder("looking up", shows=("depth", "dist")))
        with pytest.raises(DescriptionError, match="an image of 1 to"):
            scene["a"].add_sensor("bad", RangeFinder("looking up", image=RangeImage(0, 2, (1.0, 1.0))))
        with pytest.raises(DescriptionError, match="positive focal lengths"):
            scene["a"].add_sensor("bad", RangeFinder("looking up", image=RangeImage(1, 2, (0.0, 1.0))))


def test_saved_worlds_have_them(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, RANGES)
        before = np.ravel(scene.sensors["everything of a camera"].read())
        world.save(tmp_path / "saved.carom")
        with World() as other:
            other.load(tmp_path / "saved.carom")
            (body,) = [body for body in other.bodies.values() if "everything of a camera" in body.sensors]
            np.testing.assert_array_equal(np.ravel(body.sensors["everything of a camera"].read()), before)


@each(
    ("sensor", "says"),
    [
        ('<rangefinder camera="c" data="depth dist"/>', "in this order"),
        ('<rangefinder camera="c" data="colour"/>', "must be some of dist, dir"),
        ('<rangefinder camera="gone"/>', "there is no site 'gone'|there is no .* 'gone'"),
        ('<rangefinder camera="c" site="s"/>', "a site or a camera, and not both"),
    ],
)
def test_broken_ones_are_errors_that_say_what_is_wrong(tmp_path, sensor, says):
    text = (
        '<mujoco><worldbody><body><joint/><geom size=".1"/><site name="s"/><camera name="c"/></body>'
        f"</worldbody><sensor>{sensor}</sensor></mujoco>"
    )
    with World() as world, pytest.raises(DescriptionError, match=says):
        loaded(world, tmp_path, text)


def test_cameras_that_aim_are_reported(tmp_path):
    text = (
        '<mujoco><worldbody><body name="b"><joint/><geom size=".1"/>'
        '<camera name="c" mode="targetbody" target="b"/></body></worldbody>'
        '<sensor><rangefinder camera="c"/></sensor></mujoco>'
    )
    with World() as world:
        (lost,) = loaded(world, tmp_path, text).ignored.that_matter
        assert "track or aim" in lost.reason
