"""Lights, sky and cameras of files in saved worlds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from carom import World
from carom.description.place import Place
from carom.render.appearance import appearance_of

SCENE = """<mujoco>
  <visual><headlight ambient="0.3 0.2 0.1"/></visual>
  <asset><texture type="skybox" builtin="gradient" rgb1="0 0 1" rgb2="1 1 1" width="8" height="48"/></asset>
  <worldbody>
    <light pos="0 0 3" dir="0 0 -1" diffuse="0.2 0.4 0.6"/>
    <body name="ball" pos="0 0 1">
      <freejoint/><light pos="0 0 0.5" mode="targetbody" target="box"/><camera name="eye" pos="0 -1 0"/>
      <geom size="0.1"/>
    </body>
    <body name="box"><geom type="box" size="0.1 0.1 0.1"/></body>
  </worldbody>
</mujoco>"""


@pytest.fixture
def scene(tmp_path: Path) -> World:
    (tmp_path / "scene.xml").write_text(SCENE)
    world = World()
    world.load(tmp_path / "scene.xml")
    return world


def test_a_saved_world_has_the_lights_sky_and_cameras_of_its_files(scene: World, tmp_path: Path):
    scene.save(tmp_path / "scene.carom")
    other = World()
    other.load(tmp_path / "scene.carom")
    before, after = appearance_of(scene).stage, appearance_of(other).stage
    assert before is not None
    assert after is not None
    assert len(after.lights) == 2
    assert (after.lights, after.cameras, after.headlight) == (before.lights, before.cameras, before.headlight)
    assert before.sky is not None
    assert after.sky is not None
    # What is made when it is first drawn is saved as it is.
    assert before.sky.texels is None
    assert after.sky.texels is not None
    made = before.sky.with_texels().texels
    assert made is not None
    assert np.array_equal(after.sky.texels, made)


def test_lights_go_with_their_bodies_into_a_world_that_has_others(scene: World, tmp_path: Path):
    scene.save(tmp_path / "scene.carom")
    other = World()
    (tmp_path / "first.xml").write_text(SCENE)
    other.load(tmp_path / "first.xml")
    first = len(other.bodies)
    other.load(tmp_path / "scene.carom")
    stage, own = appearance_of(other).stage, appearance_of(scene).stage
    assert stage is not None
    assert own is not None
    assert len(stage.lights) == 4
    carried = next(it for it in own.lights if it.place != Place())
    found = stage.lights[2 + own.lights.index(carried)]
    assert (found.place.body, found.place.link) == (carried.place.body + first, carried.place.link)


def test_a_world_without_a_stage_has_none_when_it_is_loaded(tmp_path: Path):
    world = World()
    (tmp_path / "ball.urdf").write_text('<robot name="ball"><link name="ball"/></robot>')
    world.load_urdf(tmp_path / "ball.urdf")
    world.save(tmp_path / "ball.carom")
    other = World()
    other.load(tmp_path / "ball.carom")
    assert appearance_of(other).stage is None
