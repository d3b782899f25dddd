"""Elements called `pid` are servos with one actuator for each input, and move bodies as in MuJoCo."""

import json
from pathlib import Path

import pytest
from numpy.testing import assert_allclose
from tests.beside_mujoco.controlled import CONTROLLED

from carom import World
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "controlled_answers.json").read_text())


def load(world, folder, text):
    (folder / "file.xml").write_text(text)
    return world.load(folder / "file.xml")


@pytest.mark.parametrize("name", CONTROLLED)
def test_motion_is_that_of_mujoco(tmp_path, name):
    answer = ANSWERS[name]
    with World() as world:
        scene = load(world, tmp_path, CONTROLLED[name])
        assert not [it for it in scene.ignored.that_matter if "flag" not in it.element]
        assert len(scene.actuators) == len(answer["control"])
        for actuator, control in zip(scene.actuators.values(), answer["control"], strict=True):
            actuator.control = control
        world.step(400)
        found = [joint.position for body in scene.bodies for joint in body.joints]
        assert_allclose(found, answer["end"], atol=1e-6)


def test_inputs_have_names_and_keyframes_their_controls(tmp_path):
    keys = '<keyframe><key name="home" ctrl=".1 .2 .3 .4"/></keyframe></mujoco>'
    text = CONTROLLED["two inputs"].replace("</mujoco>", keys)
    with World() as world:
        scene = load(world, tmp_path, text)
        first, second, *_ = scene.actuators
        assert (first, second) == ("p", "p@vel")
        scene.reset("home")
        assert [it.control for it in scene.actuators.values()] == [0.1, 0.2, 0.3, 0.4]


@pytest.mark.parametrize(
    ("stated", "attribute"),
    [
        ('ki="2"', "ki"),
        ('slewmax="1"', "slewmax"),
        ('dampratio="1"', "input"),
        ('dampratio="1" input="vel"', "dampratio"),
        ('forcerange="-1 1"', "forcerange"),
    ],
)
def test_what_is_not_built_is_reported(tmp_path, stated, attribute):
    text = CONTROLLED["two inputs"].replace('kp="40" kv="3"/>', f'kp="40" {stated}/><motor joint="j"/>')
    with World() as world:
        scene = load(world, tmp_path, text)
        lost = [name for it in scene.ignored.that_matter if "pid" in it.element for name in it.attributes]
        assert attribute in lost


@pytest.mark.parametrize(
    ("stated", "message"),
    [('input="vel pos"', "pos, vel and ff"), ('input=""', "pos, vel and ff"), ('input="vel" ki="1"', "pos")],
)
def test_broken_inputs_are_errors(tmp_path, stated, message):
    text = CONTROLLED["two inputs"].replace('kv="3"/>', f'kv="3" {stated}/>')
    with World() as world, pytest.raises(DescriptionError, match=message):
        load(world, tmp_path, text)
