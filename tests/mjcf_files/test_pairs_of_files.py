"""Contacts of a `<pair>` are as it states them, whatever its geoms say."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tests.mjcf_files.cases.soft import PAIRS, STEPS, pair_of

from carom import World, Worlds
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "cases" / "soft_answers.json").read_text())
# Contacts that yield here do not part for sliding, so balls roll a little farther.
ALONG = {"pair with a margin": 0.03}
OF_GEOMS = """<mujoco><default><geom solimp=".8 .9 .002"/></default><option timestep=".001"
 gravity="2 0 -9.81"/><worldbody><geom type="plane" size="5 5 .1" {0}/><body name="f" pos="0 0 .1999">
<freejoint/><geom size=".2" {0}/></body></worldbody></mujoco>"""
TWO = """<mujoco><worldbody><geom type="plane" size="5 5 .1"/><body name="a" pos="0 0 .099"><freejoint/>
<geom name="g" type="box" size=".1 .1 .1" solref=".05 1"/></body>
<body name="b" pos="0 0 {height}">
<freejoint/><geom name="h" type="box" size=".1 .1 .1"/></body></worldbody>
<contact>{pairs}</contact></mujoco>"""


def loaded(world, folder, text):
    (folder / "file.xml").write_text(text)
    scene = world.load(folder / "file.xml")
    scene.apply_options()
    # MuJoCo's solver converges.
    world.parameters.solver_residual_threshold, world.parameters.solver_iterations = 1e-16, 500
    world.apply_parameters()
    return scene


def moved(folder, text):
    with World() as world:
        scene = loaded(world, folder, text)
        assert not scene.ignored.that_matter
        found, done = [], 0
        for steps in STEPS:
            world.step(steps - done)
            done = steps
            found.append(scene["f"].links[-1].pose.position)
        return np.array(found)


@pytest.mark.parametrize("name", PAIRS)
def test_balls_roll_on_pairs_as_in_mujoco(tmp_path, name):
    found, answer = moved(tmp_path, PAIRS[name]), np.array(ANSWERS[name])
    assert_allclose(found[:, 2], answer[:, 2], atol=1e-5)
    assert_allclose(found[:, :2], answer[:, :2], rtol=ALONG.get(name, 3e-3), atol=1e-15)


@pytest.mark.parametrize(
    ("stated", "of_geoms"),
    [
        ("", ""),
        (
            'margin=".03" solref=".03 .6" solimp=".5 .8 .02"',
            'margin=".015" solref=".03 .6" solimp=".5 .8 .02"',
        ),
        ('condim="6" friction="1 1 .1 .02 .02"', 'condim="6" friction="1 .1 .02"'),
        ('condim="4" friction=".3 .3 .1"', 'condim="4" friction=".3 .1"'),
    ],
)
def test_pairs_are_as_geoms_that_state_the_same(tmp_path, stated, of_geoms):
    assert_array_equal(moved(tmp_path, pair_of(stated)), moved(tmp_path, OF_GEOMS.format(of_geoms)))


def test_other_contacts_of_a_body_are_as_its_geom_has_them(tmp_path):
    stiff = '<pair geom1="g" geom2="h" solref=".005 1" solimp=".99 .999 .001"/>'
    gaps = {}
    for pairs in ("", stiff):
        with World() as world:
            scene = loaded(world, tmp_path, TWO.format(height=0.299, pairs=pairs))
            world.step(2000)
            below, above = (scene[name].links[-1].pose.position[2] for name in "ab")
            gaps[pairs] = (0.1 - below, below + 0.2 - above)
    assert_allclose(gaps[stiff][0], gaps[""][0], rtol=1e-6)
    assert gaps[stiff][1] < 0.1 * gaps[""][1]


def test_margins_of_pairs_are_found(tmp_path):
    pair = '<pair geom1="g" geom2="h" margin=".03"/>'
    with World() as world:
        scene = loaded(world, tmp_path, TWO.format(height=0.335, pairs=pair))
        world.step(2000)
        below, above = (scene[name].links[-1].pose.position[2] for name in "ab")
        assert 0.0275 < above - below - 0.2 < 0.03


def test_copies_worlds_and_saved_worlds_know_pairs(tmp_path):
    with World() as world, World() as other:
        scene = loaded(world, tmp_path, PAIRS["pair with a margin"])
        world.save(tmp_path / "saved")
        saved = other.load(tmp_path / "saved")
        assert other.contact_arrays.shapes.filters.all == world.contact_arrays.shapes.filters.all
        other.parameters.time_step = world.parameters.time_step
        other.apply_parameters()
        worlds, before = Worlds(world, 2), world.snapshot()
        for each in (world, other, worlds):
            each.step(200)
        position = scene["f"].links[-1].pose.position
        assert position[2] > 0.22
        assert_array_equal(saved["f"].links[-1].pose.position, position)
        for found in worlds.bodies["f"].base_inertial_poses:
            assert_allclose(found[:3], position, rtol=0.0, atol=1e-12)
        world.restore(before)
        world.step(200)
        assert_array_equal(scene["f"].links[-1].pose.position, position)


def test_pairs_go_with_their_bodies(tmp_path):
    pairs = '<pair geom1="g" geom2="h" margin=".03"/>'
    with World() as world:
        first = loaded(world, tmp_path, TWO.format(height=0.32, pairs=pairs))
        second = loaded(world, tmp_path, TWO.format(height=0.32, pairs=pairs.replace("3", "2")))
        filters = world.contact_arrays.shapes.filters
        stated = [(a, b, it) for a, b, _, it in filters.all if it is not None]
        assert [it.margin for _, _, it in stated] == [0.03, 0.02]
        world.remove(first["b"].id)
        [(a, b, left)] = [(a, b, it) for a, b, _, it in filters.all if it is not None]
        assert left.margin == 0.02
        assert (a, b) == tuple(second[name].first_link for name in "ab")


def test_what_a_pair_cannot_say_is_reported(tmp_path):
    pairs = '<pair geom1="g" geom2="h"/><pair geom1="h" geom2="g" margin=".1" friction=".5" adhesion="1"/>'
    with World() as world:
        scene = loaded(world, tmp_path, TWO.format(height=0.5, pairs=pairs))
        found = {it.attributes for it in scene.ignored.that_matter}
        assert found == {("adhesion",), ("friction",), ("geom1", "geom2")}


def test_numbers_of_dimensions_are_checked(tmp_path):
    with World() as world, pytest.raises(DescriptionError, match=r"pair.*condim='5' must be 1, 3, 4 or 6"):
        loaded(world, tmp_path, TWO.format(height=1, pairs='<pair geom1="g" geom2="h" condim="5"/>'))
