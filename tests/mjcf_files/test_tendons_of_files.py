"""Tendons of MJCF files, and actuators of tendons and sites: lengths, moment arms, forces as in MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.tendon import SENSED, TENDONS, file, path

from carom import World, algorithms
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "cases" / "tendon_answers.json").read_text())
JOINTS = ("j", "k", "s")


def load(world, folder, text):
    (folder / "file.xml").write_text(text)
    return world.load(folder / "file.xml")


def start(scene, answer, velocity=None):
    body = scene["a"]
    velocity = answer["qvel"] if velocity is None else velocity
    for name, q, v in zip(JOINTS, answer["qpos"], velocity, strict=True):
        body.set_joint_state(body.joints[name].index, [q], [v])
    scene["a"].actuators.controls = answer["ctrl"]
    driven = [it for it in scene.actuators.values() if it.spec.dynamics]
    for actuator, activation in zip(driven, answer["act"], strict=True):
        actuator.activation = activation
    return body


@pytest.mark.parametrize("name", TENDONS)
def test_lengths_and_moment_arms_are_those_of_mujoco(tmp_path, name):
    with World() as world:
        scene = load(world, tmp_path, TENDONS[name])
        assert not scene.ignored.that_matter
        for answer in ANSWERS[name]:
            start(scene, answer)
            tendons = list(scene.tendons.values())
            assert_allclose([it.length for it in tendons], answer["length"], atol=1e-9)
            assert_allclose([it.velocity for it in tendons], answer["velocity"], atol=1e-9)
            drives = list(scene.actuators.values())
            assert_allclose([it.length for it in drives], answer["drive_length"], atol=1e-9)
            assert_allclose([it.velocity for it in drives], answer["drive_velocity"], atol=1e-9)
            for dof, unit in enumerate(np.eye(3)):
                start(scene, answer, unit)
                arms = [tendon[dof] for tendon in answer["arms"]]
                assert_allclose([it.velocity for it in tendons], arms, atol=1e-9)


def test_armature_adds_to_the_equations_of_motion_what_it_does_in_mujoco(tmp_path):
    with World() as world:
        scene = load(world, tmp_path, TENDONS["armature"])
        scene.apply_options()
        for answer in ANSWERS["armature"]:
            body = start(scene, answer)
            q, v = body.joints.positions, answer["qvel"]
            matrix = algorithms.mass_matrix(body, q) + algorithms.tendon_inertia(body, q)
            assert_allclose(matrix, answer["matrix"], rtol=1e-9, atol=1e-12)
            bias = algorithms.bias_forces(body, q, v) + algorithms.tendon_bias_forces(body, q, v)
            assert_allclose(bias, answer["bias"], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", TENDONS)
def test_accelerations_and_forces_are_those_of_mujoco(tmp_path, name):
    with World() as world:
        scene = load(world, tmp_path, TENDONS[name])
        scene.apply_options()
        world.parameters.time_step = 1e-8
        world.apply_parameters()
        for answer in ANSWERS[name]:
            body = start(scene, answer)
            world.step()
            after = [float(body.joints[joint].velocity) for joint in JOINTS]
            acceleration = (np.array(after) - answer["qvel"]) / 1e-8
            scale = np.abs(answer["qacc"]).max()
            assert_allclose(acceleration, answer["qacc"], atol=2e-6 * scale)
            forces = [it.force for it in scene.actuators.values()]
            assert_allclose(forces, answer["force"], rtol=1e-6, atol=2e-5)


@pytest.mark.parametrize("name", TENDONS)
def test_motion_is_that_of_mujoco(tmp_path, name):
    with World() as world:
        scene = load(world, tmp_path, TENDONS[name])
        scene.apply_options()
        for answer in ANSWERS[name]:
            body = start(scene, answer)
            world.step(50)
            ends = [float(body.joints[joint].position) for joint in JOINTS]
            assert_allclose(ends, answer["end"], atol=2e-4)
            driven = [it.activation for it in scene.actuators.values() if it.spec.dynamics]
            assert_allclose(driven, answer["end_act"], atol=1e-6)


def test_sensors_show_tendons(tmp_path):
    with World() as world:
        scene = load(world, tmp_path, SENSED)
        start(scene, ANSWERS["sphere"][1] | {"ctrl": [0.0], "act": []})
        tendon, sensors = scene.tendons["t"], scene.sensors
        assert tendon.length > 0.1
        for name in ("p", "ap"):
            assert_allclose(sensors[name].read(), [tendon.length])
        for name in ("v", "av"):
            assert_allclose(sensors[name].read(), [tendon.velocity])


def test_force_sensors_say_that_they_do_not_feel_tendons(tmp_path):
    text = SENSED.replace("<sensor>", '<sensor><force name="f" site="two"/>')
    with World() as world:
        scene = load(world, tmp_path, text)
        (lost,) = scene.ignored.that_matter
        assert (lost.element, "tendons" in lost.consequence) == ("sensor/force", True)
        assert scene.sensors["f"].read().shape == (3,)


def test_a_limit_stops_a_tendon(tmp_path):
    text = file(path("fix", "end", name="t", range=".1 .62"), '<motor tendon="t"/>')
    with World() as world:
        scene = load(world, tmp_path, text)
        scene.apply_options()
        tendon, longest = scene.tendons["t"], 0.0
        for _ in range(100):
            world.step(50)
            longest = max(longest, tendon.length)
        # MuJoCo's own longest; its inverse mass is that at the reference.
        assert_allclose(longest, 0.62252525, atol=1e-4)
        assert tendon.limit_force > 0.1
        tendon.range = (0.1, 10.0)
        world.step(2000)
        assert tendon.length > 0.63


def test_friction_holds_a_tendon_up_to_its_force(tmp_path):
    text = file(path("fix", "end", name="t", frictionloss="5"), '<motor name="m" tendon="t"/>')
    with World() as world:
        scene = load(world, tmp_path, text)
        scene.apply_options()
        world.gravity = (0.0, 0.0, 0.0)
        before = scene.tendons["t"].length
        for control, held in ((4.9, True), (-4.9, True), (5.5, False)):
            scene.actuators["m"].control = control
            world.step(200)
            assert (abs(scene.tendons["t"].length - before) < 1e-9) == held
        assert_allclose(scene.tendons["t"].force, -5.0)


def test_a_tendon_follows_another(tmp_path):
    fixed = '<fixed name="{}"><joint joint="{}" coef="2"/></fixed>'
    tendons = fixed.format("f", "j") + fixed.format("g", "s")
    stiff = 'solref=".004 1" solimp=".999 .9999"'
    after = f'<equality><tendon name="e" tendon1="g" tendon2="f" polycoef=".01 .1 .02" {stiff}/></equality>'
    with World() as world:
        scene = load(world, tmp_path, file(tendons, after=after))
        scene.apply_options()
        world.step(1000)
        x, y = scene.tendons["f"].length, scene.tendons["g"].length
        assert abs(x) > 0.1
        assert_allclose(y, 0.01 + 0.1 * x + 0.02 * x * x, atol=3e-4)
        assert abs(scene.constraints["e"].error) < 3e-4
        scene.constraints["e"].enabled = False
        world.step(500)
        assert abs(scene.constraints["e"].error) > 1e-3


def test_tendons_are_saved_and_copied(tmp_path):
    text = TENDONS["pulleys"].replace("</mujoco>", "").replace("<spatial", '<spatial stiffness="9"')
    text += '<equality><tendon name="e" tendon1="t" polycoef=".1" active="false"/></equality></mujoco>'
    with World() as world:
        scene = load(world, tmp_path, text)
        body = start(scene, ANSWERS["pulleys"][2])
        world.save(tmp_path / "saved")
        copy = world.copy()
        with World() as other:
            again = other.load(tmp_path / "saved")
            assert "e" in again.constraints
            for it in (world, other, copy):
                it.step(20)
            positions = [body.joints[joint].position for joint in JOINTS]
            for bodies in (again.bodies, list(copy.bodies.values())):
                found = next(it for it in bodies if it.name == "a")
                assert [found.joints[joint].position for joint in JOINTS] == positions
                assert found.tendons["t"].length == body.tendons["t"].length
        del copy


@pytest.mark.parametrize(
    ("tendon", "problem"),
    [
        ('<fixed name="f"><joint joint="no" coef="1"/></fixed>', "no joint 'no'"),
        ('<fixed name="f"/>', "path is empty"),
        ('<spatial><site site="no"/></spatial>', "no site 'no'"),
        ('<spatial><site site="one"/></spatial>', "needs two sites"),
        (path("one", "ball"), "a site before and one after"),
        (path("one", "two", "2"), "after a pulley its path ends"),
        (path("one", "two", name="t", limited="true"), "needs a range"),
        (path("one", "two", name="t", stiffness="-1"), "stiffness must be 0 or more"),
        (path("one", "two", name="t") + path("one", "two", name="t"), "taken already"),
        ('<rope name="f"/>', "not known as a tendon"),
    ],
)
def test_mistakes_are_named(tmp_path, tendon, problem):
    with World() as world, pytest.raises(DescriptionError, match=problem):
        load(world, tmp_path, file(tendon))


@pytest.mark.parametrize(
    ("tendon", "reason"),
    [
        (path("fix", "nail", name="t"), "it moves nothing"),
        ('<fixed name="t"><joint joint="free" coef="1"/></fixed>', "free and ball joints"),
    ],
)
def test_tendons_that_are_not_simulated_are_reported_with_their_actuators(tmp_path, tendon, reason):
    body = '<body name="l"><freejoint name="free"/><geom size=".1"/></body></worldbody>'
    text = file(tendon, '<motor tendon="t"/>').replace("</worldbody>", body)
    with World() as world:
        scene = load(world, tmp_path, text)
        lost = {it.element: it.reason for it in scene.ignored.that_matter}
        assert reason in lost["tendon/fixed" if "fixed" in tendon else "tendon/spatial"]
        assert "tendon is not simulated" in lost["actuator/motor"]


@pytest.mark.parametrize(("bounds", "force"), [("", 1.1), ("-.5 .5", 0.5), ("-5 5", 1.1)])
def test_the_force_of_its_actuators_is_measured_as_in_mujoco(tmp_path, bounds, force):
    limit = f'actuatorfrcrange="{bounds}"' if bounds else ""
    with World() as world:
        scene = load(
            world,
            tmp_path,
            '<mujoco><option gravity="0 0 0"/><worldbody><body name="a"><joint name="j"/>'
            f'<geom size=".1" pos="1 0 0"/></body></worldbody><tendon><fixed name="t" {limit}>'
            '<joint joint="j" coef="2"/></fixed></tendon><actuator><motor name="A" tendon="t" gear="3"/>'
            '<motor name="B" tendon="t" gear="-2"/><motor name="C" joint="j"/></actuator>'
            '<sensor><tendonactuatorfrc name="f" tendon="t"/></sensor></mujoco>',
        )
        assert not scene.ignored.that_matter
        scene["a"].actuators.controls = [0.7, 0.4, 0.1]
        world.step()
        assert_allclose(scene.sensors["f"].read(), force, rtol=1e-12)


@pytest.mark.parametrize("name", ["damping"])
@pytest.mark.parametrize(("numbers", "count"), [("3 0 0", 0), ("3 -4 4", 1)])
def test_powers_in_springs_and_dampers_of_tendons_are_reported(tmp_path, name, numbers, count):
    text = (
        '<mujoco><worldbody><body name="a"><joint name="j" type="slide"/><geom size=".1"/></body></worldbody>'
        f'<tendon><fixed name="t" {name}="{numbers}"><joint joint="j" coef="1"/></fixed></tendon></mujoco>'
    )
    with World() as world:
        scene = load(world, tmp_path, text)
        rows = [row for row in scene.ignored if row.consequence == "only the linear term counts"]
        assert [(row.element, row.attributes) for row in rows] == [("tendon/fixed", (name,))] * count


def test_armature_counts_for_springs_and_damping_ratios_as_in_mujoco(tmp_path):
    text = """<mujoco><worldbody><site name="w" pos=".3 .1 1"/><body name="a" pos="0 0 1"><joint name="j"
 axis="0 1 0" springdamper=".1 1"/><geom type="capsule" size=".05" fromto="0 0 0 0 0 -.5"/><body name="b"
 pos="0 0 -.5"><joint name="k" axis="0 1 0" springdamper=".2 .5"/><geom type="capsule" size=".04"
 fromto="0 0 0 .4 0 0"/><site name="t" pos=".3 0 .04"/></body></body></worldbody><tendon><spatial
 armature="2"><site site="w"/><site site="t"/></spatial><fixed armature=".3"><joint joint="j" coef="1.5"/>
 <joint joint="k" coef="-.7"/></fixed></tendon><actuator><position name="p" joint="j" kp="50" dampratio="1"/>
 </actuator></mujoco>"""
    with World() as world:
        scene = load(world, tmp_path, text)
        terms = [scene["a"].dynamics(scene["a"].joints[name].index) for name in "jk"]
        # `jnt_stiffness`, `dof_damping` and `actuator_biasprm` of MuJoCo 4.0.
        assert_allclose([it.joint_stiffness for it in terms], [194.80900483, 45.006902984], rtol=1e-8)
        assert_allclose([it.joint_damping for it in terms], [38.961800966, 4.5006902984], rtol=1e-8)
        assert_allclose(scene.actuators["p"].spec.bias[2], -19.738743872, rtol=1e-8)
