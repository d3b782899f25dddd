"""Terms of free joints, limits of ball joints and armature of tendons act as in MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.term import MOVED, STEPS

from carom import World, Worlds
from carom.description.transform import rotation_matrix

# MuJoCo's Euler has explicit springs, and moves frames of free bodies where Carom moves centres of mass.
SPRINGS = ("free with a spring", "free with a spring and a damper", "free with a spring off")
ROUGHLY = {
    "tendon with armature, spring and damper": 5e-3,
    "free without terms": 5e-3,
    **dict.fromkeys(SPRINGS, 1e-2),
}
ANSWERS = json.loads((Path(__file__).parent / "cases" / "term_answers.json").read_text())


@pytest.fixture
def load(tmp_path):
    with World() as world:

        def load(text):
            (tmp_path / "file.xml").write_text(text)
            scene = world.load(tmp_path / "file.xml")
            scene.apply_options()
            # MuJoCo's solver converges.
            world.parameters.solver_residual_threshold, world.parameters.solver_iterations = 1e-16, 500
            world.apply_parameters()
            return scene

        yield load


@pytest.mark.parametrize("name", MOVED)
def test_bodies_move_as_in_mujoco(load, name):
    scene = load(MOVED[name])
    assert not scene.ignored.that_matter
    scene.reset("0")
    links = {link.name: link for body in scene.bodies for link in body.links}
    atol = ROUGHLY.get(name, 1e-6)
    done, answers = 0, ANSWERS[name]
    if "sensors" in answers[0]:
        found = [scene.sensors[sensor].read() for sensor in ("l", "r")]
        assert_allclose(np.concatenate(found), answers[0]["sensors"], rtol=1e-9, atol=1e-9)
        answers = answers[1:]
    for steps, answer in zip(STEPS, answers, strict=True):
        scene.world.step(steps - done)
        done = steps
        for one, numbers in answer.items():
            pose = links[one].pose
            assert_allclose(pose.position, numbers[:3], atol=atol, err_msg=f"{one} after {steps} steps")
            turn = np.reshape(rotation_matrix(tuple(pose.orientation)), 9)
            assert_allclose(turn, numbers[3:], atol=atol, err_msg=f"{one} after {steps} steps")


def test_limits_of_balls_are_tendons_that_tell_their_angle_and_force(load):
    scene = load(MOVED["ball with a limit"])
    scene.reset("0")
    limit = scene.tendons["b@limit"]
    w = np.array([0.9, 0.4, 0.2, -0.1])
    assert_allclose(limit.length, 2.0 * np.arccos(0.9 / np.linalg.norm(w)), atol=1e-12)
    assert_allclose(limit.range[1], np.pi / 4.0)
    before = limit.length
    rate = limit.velocity
    scene.world.parameters.time_step = 1e-7
    scene.world.apply_parameters()
    scene.world.step()
    assert_allclose((limit.length - before) / 1e-7, rate, rtol=1e-3)
    scene.apply_options()
    forces = []
    for _ in range(300):
        scene.world.step()
        forces.append(limit.limit_force)
    assert max(forces) > 0.0


KEPT = (
    "free with both by a default",
    "free with a spring",
    "ball with a limit",
    "tendon with armature",
    "free with friction",
)


@pytest.mark.parametrize("name", [*KEPT, "ball with friction"])
def test_saved_worlds_and_copies_move_alike(load, tmp_path, name):
    scene = load(MOVED[name])
    scene.reset("0")
    scene.world.save(tmp_path / "saved")
    with World() as other:
        other.load(tmp_path / "saved")
        worlds = Worlds(scene.world, 2)
        scene.world.step(200)
        other.step(200)
        worlds.step(200)
        body = scene.bodies[0]
        saved = next(each for each in other.bodies.values() if each.name == body.name)
        assert_allclose(saved.joints.positions, body.joints.positions, rtol=0.0, atol=0.0)
        found = worlds.bodies[body.name].joints.positions
        assert_allclose(found, [body.joints.positions] * 2, rtol=0.0, atol=1e-9)


def test_the_armature_of_a_tendon_can_be_set(load):
    scene = load(MOVED["tendon with armature"])
    tendon = scene.tendons["t"]
    assert tendon.armature == 0.4
    tendon.armature = 0.0
    with pytest.raises(ValueError, match="armature must be 0 or more"):
        tendon.armature = -1.0
    scene.reset("0")
    scene.world.step(100)
    without = scene.bodies[0].joints.positions
    assert np.abs(np.array(without)).max() > 0.0
    other = load(MOVED["tendon with armature"])
    other.reset("0")
    other.world.step(100)
    assert np.abs(np.array(other.bodies[0].joints.positions) - without).max() > 1e-2


def test_a_weld_that_yields_does_so_after_loading_a_saved_world(tmp_path):
    weld = '<weld body1="m" body2="h" solref=".2 1" solimp=".3 .4 .1"/>'
    (tmp_path / "file.xml").write_text(
        '<mujoco><worldbody><body name="m" mocap="true"/><body name="h" pos=".5 0 0"><freejoint/>'
        f'<geom size=".1" pos=".3 0 0"/></body></worldbody><equality>{weld}</equality></mujoco>'
    )
    with World() as world, World() as other:
        body = world.load(tmp_path / "file.xml")["h"]
        world.save(tmp_path / "saved")
        saved = other.load(tmp_path / "saved")["h"]
        world.step(100)
        other.step(100)
        assert_allclose(saved.links[-1].pose.position, body.links[-1].pose.position, rtol=0.0, atol=0.0)


def test_friction_of_a_ball_joint_can_be_set(load):
    scene = load(MOVED["ball with friction"])
    joint = scene["a"].joints["b"]
    assert joint.friction_loss == 0.3
    joint.friction_loss = 90.0
    scene.reset("0")
    scene.world.step(STEPS[1])
    expected = ANSWERS["ball with friction that holds"][1]["c"][:3]
    assert_allclose(scene["a"].links["c"].pose.position, expected, atol=1e-6)


def test_springs_of_free_joints_have_no_exact_derivatives(load):
    scene = load(MOVED["free with a spring"])
    with pytest.raises(NotImplementedError, match="spring at the base of f"):
        scene.world.linearize(method="exact")
