"""Actuators that act early have the forces of MuJoCo's with `actearly`, and move as these do.

The numbers are those of `mujoco` 4.0 with controls of 0.8: forces and activations of three steps, and
positions of the joints after 20.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from carom import GeneralActuator, World, Worlds
from carom.layouts.codes import ActivationDynamics

FILE = """<mujoco><option timestep="0.01" gravity="0 0 0"/><worldbody>
<site name="w" pos=".1 0 .2"/><body name="a">
<joint name="j" axis="0 1 0" actuatorfrcrange="-4 4"/><geom size=".05" pos="0 0 -.3"/>
<site name="s" pos=".02 0 -.2"/><body pos="0 0 -.4"><joint name="k" axis="0 1 0"/>
<geom size=".05" pos="0 0 -.3"/><site name="e" pos="-.03 0 -.1"/><body pos="0 0 -.3">
<joint name="p" type="slide" axis="1 0 0"/><geom size=".04" pos=".02 .05 0"/>
<site name="f" pos="0 .1 .05"/></body></body></body></worldbody><tendon><fixed name="sum">
<joint joint="j" coef=".5"/><joint joint="k" coef="-1"/></fixed><fixed name="bounded"
 actuatorfrcrange="-1 1"><joint joint="p" coef="1"/></fixed><spatial name="path"><site site="w"/>
<site site="s"/><site site="e"/></spatial></tendon><actuator>{}</actuator></mujoco>"""
MUSCLE = (
    'dyntype="muscle" gaintype="muscle" biastype="muscle" dynprm=".01 .04" '
    'gainprm=".75 1.05 9 200 .5 1.6 1.5 1.3 1.2" biasprm=".75 1.05 9 200 .5 1.6 1.5 1.3 1.2"'
)
ACTUATORS = {
    "integrator": '<general joint="k" dyntype="integrator" gainprm="3" {}/>',
    "within bounds": '<general joint="k" dyntype="integrator" gainprm="30" actlimited="true"'
    ' actrange="0 .02" {}/>',
    "filter": '<general joint="k" gear="-1.5" dyntype="filter" dynprm=".05" ctrlrange="0 .5"'
    ' ctrllimited="true" {}/>',
    "filterexact": '<general joint="p" dyntype="filterexact" dynprm=".03" gainprm="2" {}/>',
    "several of a joint": '<general joint="j" dyntype="filter" dynprm=".03" gainprm="2" {0}/>'
    '<general joint="j" dyntype="integrator" gainprm="70" gear="2" {0}/>',
    "muscle of a joint": '<general joint="k" lengthrange="-1 1" ' + MUSCLE + " {}/>",
    "muscle of a tendon": '<general tendon="path" lengthrange=".3 .8" ' + MUSCLE + " {}/>",
    "tendon": '<general tendon="sum" dyntype="filter" dynprm=".05" gainprm="3" {}/>',
    "several of a tendon": '<general tendon="bounded" dyntype="filter" dynprm=".03" {0}/>'
    '<general tendon="bounded" dyntype="integrator" gainprm="20" {0}/>',
    "site": '<general site="f" gear="1 0 2 0 0 0" dyntype="filterexact" dynprm=".05" {}/>',
}

ANSWERS: dict[str, tuple[list[float], list[float], list[float]]] = {
    "integrator": (
        [0.024, 0.048, 0.072],
        [0.008, 0.016, 0.024],
        [-0.160996499, 0.447460395, 0.0231730031],
    ),
    "within bounds": (
        [0.24, 0.48, 0.6],
        [0.008, 0.016, 0.02],
        [-0.376763751, 1.09093035, 0.0816454996],
    ),
    "filter": (
        [0.1, 0.18, 0.244],
        [0.1, 0.18, 0.244],
        [0.352063931, -1.01377846, -0.0664277502],
    ),
    "filterexact": (
        [0.45355, 0.778533, 1.01139],
        [0.226775, 0.389266, 0.505696],
        [0.0104687917, 0.135360751, 0.147416788],
    ),
    "several of a joint": (
        [0.533333, 0.56, 0.888889, 1.12, 1.12593, 1.68],
        [0.266667, 0.008, 0.444444, 0.016, 0.562963, 0.024],
        [0.828046201, -1.63429832, 0.0219173231],
    ),
    "muscle of a joint": (
        [-13.248, 0, 0],
        [1.6, 1.2, 1],
        [0.61714351, -1.95986371, -0.182214323],
    ),
    "muscle of a tendon": (
        [-14.3991, -10.5908, -8.68924],
        [1.6, 1.2, 1],
        [-0.299232275, 0.750218489, 0.0223729558],
    ),
    "tendon": (
        [0.48, 0.864, 1.1712],
        [0.16, 0.288, 0.3904],
        [0.759509903, -2.26948389, -0.242194873],
    ),
    "several of a tendon": (
        [0.266667, 0.16, 0.444444, 0.32, 0.539773, 0.460227],
        [0.266667, 0.008, 0.444444, 0.016, 0.562963, 0.024],
        [0.0058634355, 0.104903519, 0.108201837],
    ),
    "site": (
        [0.145015, 0.263744, 0.360951],
        [0.145015, 0.263744, 0.360951],
        [-0.0113589812, 0.0340515921, 0.0439575217],
    ),
}
EARLY = 'actearly="true"'


def load(world, folder, name, flag=EARLY, file=FILE):
    (folder / "file.xml").write_text(file.format(ACTUATORS[name].format(flag)))
    scene = world.load(folder / "file.xml")
    scene.apply_options()
    world.parameters.solver_residual_threshold = 0.0
    world.parameters.solver_iterations = 500
    world.apply_parameters()
    for actuator in scene.actuators.values():
        actuator.control = 0.8
    return scene


def of(scene, name):
    return [getattr(actuator, name) for actuator in scene.actuators.values()]


@pytest.mark.parametrize("name", ACTUATORS)
def test_forces_activations_and_motion_are_those_of_mujoco(tmp_path, name):
    with World() as world:
        scene = load(world, tmp_path, name)
        assert "actearly" not in str(scene.ignored)
        forces, activations = [], []
        for _ in range(3):
            world.step()
            forces += of(scene, "force")
            activations += of(scene, "activation")
        world.step(17)
        found = forces, activations, scene["a"].joints.positions
        # Forces of muscles are by velocities that other forces have changed in the step, whenever they act.
        motion = 1e-2 if "muscle" in name else 1e-4
        for values, wanted, tolerance in zip(found, ANSWERS[name], (1e-5, 1e-5, motion), strict=True):
            assert_allclose(values, wanted, rtol=tolerance, atol=1e-9)


@pytest.mark.parametrize("name", ACTUATORS)
def test_activations_are_those_of_actuators_that_act_late(tmp_path, name):
    found = []
    for flag in (EARLY, ""):
        with World() as world:
            scene = load(world, tmp_path, name, flag)
            world.step(5)
            found.append(of(scene, "activation"))
    assert_array_equal(*found)


@pytest.mark.parametrize("name", ACTUATORS)
def test_many_worlds_and_saved_ones_do_the_same(tmp_path, name):
    with World() as world, World() as other:
        scene = load(world, tmp_path, name)
        worlds = Worlds(world, 9)
        world.save(tmp_path / "world.carom")
        other.load(tmp_path / "world.carom")
        for it in (world, worlds, other):
            it.step(20)
        own = scene["a"].joints.positions
        assert_array_equal(worlds[scene["a"]].joints.positions, np.tile(own, (9, 1)))
        assert_array_equal(other.bodies[scene["a"].id].joints.positions, own)


@pytest.mark.parametrize("name", ["integrator", "within bounds", "filter", "filterexact"])
def test_derivatives_are_those_by_differences(tmp_path, name):
    before, _, after = FILE.replace("</tendon>", "<tendon>").split("<tendon>")
    with World() as world:
        scene = load(world, tmp_path, name, file=before + after)
        for _ in range(3):
            if name == "filter":
                for actuator in scene.actuators.values():
                    actuator.control = 0.3
            exact, close = (world.linearize("actuators", method=it) for it in ("exact", "differences"))
            assert np.abs(close.B).max() > 0.0 or name == "within bounds"
            for part in "AB":
                assert_allclose(getattr(exact, part), getattr(close, part), atol=2e-6)
            world.step()


def test_code_can_ask_for_it(tmp_path):
    with World() as world:
        body = load(world, tmp_path, "integrator")["a"]
        for early in (True, False):
            body.add_actuator(
                f"early {early}",
                GeneralActuator("p", dynamics=ActivationDynamics.INTEGRATOR, acts_early=early),
            )
            body.actuators[f"early {early}"].control = 1.0
        world.step()
        assert [body.actuators[f"early {early}"].force for early in (True, False)] == [0.01, 0.0]
