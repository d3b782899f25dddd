"""Actuators of MJCF files act as in MuJoCo: their forces, their activations, and the motion that follows."""

import json
from math import inf
from pathlib import Path

import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.driven import ACTUATED, arm

from carom import World, Worlds
from carom.description.actuator import Motor
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled.actuation.law import FILTER, FILTER_EXACT, NONE, Laws

ANSWERS = json.loads((Path(__file__).parent / "cases" / "driven_answers.json").read_text())


def load(world, folder, text):
    (folder / "file.xml").write_text(text)
    return world.load(folder / "file.xml")


def joints_of(scene):
    return {joint.name: joint for body in scene.bodies for joint in body.joints}


def start(scene, answer):
    joints = joints_of(scene)
    for name, q, v in zip(answer["joints"], answer["q"], answer["v"], strict=True):
        joints[name].body.set_joint_state(joints[name].index, [q], [v])
    for actuator, control in zip(scene.actuators.values(), answer["control"], strict=True):
        actuator.control = control
    moving = [it for it in scene.actuators.values() if it.spec.dynamics]
    for actuator, activation in zip(moving, answer["activation"], strict=True):
        actuator.activation = activation


def free_joints(scene):
    for joint in joints_of(scene).values():
        joint.body.change_dynamics(joint.index, joint_lower_limit=1.0, joint_upper_limit=-1.0)


@pytest.mark.parametrize("name", ACTUATED)
def test_forces_are_those_of_mujoco(tmp_path, name):
    answer = ANSWERS[name]
    with World() as world:
        sensors = "".join(f'<jointactuatorfrc name="{it}" joint="{it}"/>' for it in answer["joints"])
        text = ACTUATED[name].replace("</mujoco>", f"<sensor>{sensors}</sensor></mujoco>")
        scene = load(world, tmp_path, text)
        assert not scene.ignored.that_matter or "flag" in str(scene.ignored)
        free_joints(scene)
        start(scene, answer)
        world.gravity = (0.0, 0.0, 0.0)
        world.parameters.time_step = 1e-9
        world.apply_parameters()
        world.step()
        forces = [scene.sensors[joint].read()[0] for joint in answer["joints"]]
        assert_allclose(forces, answer["force"], rtol=1e-6, atol=1e-6)
        own = [actuator.force for actuator in scene.actuators.values()]
        assert_allclose(own, answer["own"], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("name", [name for name in ACTUATED if name != "copies"])
def test_motion_is_that_of_mujoco(tmp_path, name):
    answer = ANSWERS[name]
    with World() as world:
        scene = load(world, tmp_path, ACTUATED[name])
        free_joints(scene)
        scene.apply_options()
        start(scene, answer)
        world.step(400)
        joints = joints_of(scene)
        ends = [joints[joint].position for joint in answer["joints"]]
        assert_allclose(ends, answer["end"], atol=1e-3)
        moving = [it.activation for it in scene.actuators.values() if it.spec.dynamics]
        assert_allclose(moving, answer["end_activation"], rtol=1e-6, atol=1e-6)


def test_worlds_copies_and_saved_worlds_bound_the_sum_of_forces(tmp_path):
    text = arm('<motor joint="j" gear="9"/><position joint="j" kp="500"/>', bounded=True)
    with World() as world, World() as other:
        body = load(world, tmp_path, text)["a"]
        world.save(tmp_path / "saved")
        saved = other.load(tmp_path / "saved")["a"]
        worlds = Worlds(world, 2)
        for each in (body.actuators, saved.actuators, worlds.bodies["a"].actuators):
            each.controls = [1.0, 0.5]
        worlds.bodies["a"].actuators[0].change(where=[1], joint_lower=-1.0, joint_upper=1.0)
        for each in (world, other, worlds):
            each.step(20)
        position = body.joints["j"].position
        assert saved.joints["j"].position == position
        found = worlds.bodies["a"].joints.positions[:, body.joints["j"].index]
        assert_allclose(found[0], position, rtol=0.0, atol=1e-12)
        assert abs(found[1] - position) > 1e-3
        before = [it.force for it in body.actuators]
        assert before[0] == 1.0
        assert sum(it.force * it.gear for it in body.actuators) > 8.0
        exact = world.linearize(["actuators"], tight=True)
        near = world.linearize(["actuators"], tight=True, method="differences")
        assert_allclose(exact.A, near.A, rtol=0.0, atol=1e-6)
        assert_allclose(exact.B, near.B, rtol=0.0, atol=1e-6)
        with pytest.raises(DescriptionError, match="joint_range must be that of"):
            body.add_actuator("third", Motor("j"))
        assert len(body.actuators) == 2
        world.step()


def test_actuators_have_the_names_and_the_order_of_the_file(tmp_path):
    text = arm('<motor name="second" joint="k"/><motor name="first" joint="j"/><motor joint="j"/>')
    with World() as world:
        scene = load(world, tmp_path, text)
        names = list(scene.actuators)
        assert names[:2] == ["second", "first"]
        assert scene.actuators["first"].joint.name == "j"
        assert scene["a"].actuators.names == names


def test_a_keyframe_sets_controls_and_activations(tmp_path):
    actuators = (
        '<motor name="m" joint="j"/><general name="x" joint="j" dyntype="muscle"/>'
        '<intvelocity name="i" joint="k" kp="2" actrange="-1 1"/>'
    )
    key = '<keyframe><key name="home" ctrl=".1 .2 .3" act=".5 .6"/><key name="rest"/></keyframe></mujoco>'
    with World() as world:
        scene = load(world, tmp_path, arm(actuators).replace("</mujoco>", key))
        assert list(scene.actuators) == ["m", "i"]
        scene.reset("home")
        assert [it.control for it in scene.actuators.values()] == [0.1, 0.3]
        assert scene.actuators["i"].activation == 0.6
        scene.reset("rest")
        assert [it.control for it in scene.actuators.values()] == [0.0, 0.0]
        assert scene.actuators["i"].activation == 0.0
        (lost,) = [it for it in scene.ignored.that_matter if it.element == "actuator/general"]
        assert "muscle" in lost.reason


@pytest.mark.parametrize(
    ("actuator", "problem"),
    [
        ('<motor joint="no"/>', "no joint 'no'"),
        ("<motor/>", "nothing that it acts on"),
        ('<motor joint="j" ctrllimited="true"/>', "needs a ctrlrange"),
        ('<motor joint="j" forcerange="2 1" forcelimited="true"/>', "first number must be less"),
        ('<intvelocity joint="j" actlimited="true"/>', "needs a actrange"),
        ('<damper joint="j" ctrlrange="-1 1"/>', "must not be negative"),
        ('<motor joint="j" class="no"/>', "no default class 'no'"),
        ('<motor name="a" joint="j"/><motor name="a" joint="j"/>', "taken already, on line"),
        ('<position joint="j" kp="x"/>', "not a number"),
        ('<engine joint="j"/>', "not known as an actuator"),
    ],
)
def test_mistakes_are_named(tmp_path, actuator, problem):
    with World() as world, pytest.raises(DescriptionError, match=problem):
        load(world, tmp_path, arm(actuator))


MOTOR = 'motorconst=".5" resistance="2"'


@pytest.mark.parametrize(
    "lost",
    [
        'inductance=".1"',
        'cogging=".1 6 0"',
        'lugre="1 2 3 4 5"',
        'thermal="1 2 3 4 5 6"',
        'input="none"',
        'input="pos" controller="1 2"',
    ],
)
def test_dcmotors_with_another_law_are_left_out(tmp_path, lost):
    with World() as world:
        scene = load(world, tmp_path, arm(f'<dcmotor name="m" joint="j" {MOTOR} {lost}/>'))
        (found,) = scene.ignored.that_matter
        assert not scene.actuators
    assert found.element == "actuator/dcmotor"
    assert lost.split("=")[0] in found.reason


@pytest.mark.parametrize(
    ("stated", "problem"),
    [("", "motorconst"), ('motorconst="1"', "resistance"), ('nominal="12 1"', "motorconst")],
)
def test_dcmotors_need_a_constant_and_a_resistance(tmp_path, stated, problem):
    with World() as world, pytest.raises(DescriptionError, match=problem):
        load(world, tmp_path, arm(f'<dcmotor joint="j" {stated}/>'))


TENDONS = """<tendon><fixed name="f"><joint joint="j" coef="2"/></fixed><spatial name="s"><site site="end"/>
<site site="tip"/></spatial></tendon>"""


@pytest.mark.parametrize(
    ("drives", "lost"),
    [
        ('<motor joint="j"/>', False),
        ('<motor tendon="f"/>', True),
        ('<motor tendon="s"/>', True),
        ('<motor site="tip" gear="0 0 1"/>', True),
        ('<motor site="tip" refsite="middle" gear="0 0 1"/>', False),
    ],
)
def test_bounds_of_sums_without_forces_of_tendons_and_sites_are_reported(tmp_path, drives, lost):
    text = arm(drives, bounded=True).replace("<worldbody>", '<worldbody><site name="end" pos="1 0 0"/>')
    text = text.replace('density="400"/>', 'density="400"/><site name="tip" pos=".1 0 0"/>')
    text = text.replace('<body pos=".3 0 0" name="b">', '<site name="middle"/><body pos=".3 0 0" name="b">')
    with World() as world:
        scene = load(world, tmp_path, text.replace("<actuator>", f"{TENDONS}<actuator>"))
        found = [it for it in scene.ignored.that_matter if "actuatorfrcrange" in it.attributes]
    assert len(found) == lost


def test_a_servo_does_not_take_over_the_filter_of_general_defaults():
    laws = Laws()

    def numbers(name: str, text: str, most: int) -> list[float]:
        return [float(number) for number in text.split()]

    assert laws.apply("general", {"dyntype": "filter", "dynprm": ".3"}, numbers).dynamics == FILTER
    servo = laws.apply("position", {"kp": "20"}, numbers)
    assert (servo.dynamics, servo.times[0], servo.gain[0]) == (NONE, 1.0, 20.0)
    filtered = laws.apply("position", {"timeconst": ".1"}, numbers)
    # One that is of the same kind takes everything over.
    assert laws.apply("position", {"kp": "5"}, numbers).dynamics == filtered.dynamics == FILTER_EXACT


def test_a_target_that_is_integrated_needs_no_range(tmp_path):
    # MuJoCo 4.0: actlimited is "auto", and "false" does not count.
    text = arm(
        '<intvelocity name="a" joint="j"/><intvelocity name="b" joint="j" actrange="-1 1"/>'
        '<intvelocity name="c" joint="j" actrange="-1 1" actlimited="false"/>'
    )
    with World() as world:
        found = load(world, tmp_path, text).actuators
        assert [found[name].spec.activation_range for name in "abc"] == [(-inf, inf), (-1, 1), (-1, 1)]
