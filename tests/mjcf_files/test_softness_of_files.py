"""Limits, friction, contacts and equality constraints yield as in MuJoCo, and flags switch them off."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.soft import MOVED, STEPS, WEIGHED

from carom import World, Worlds
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled.reader import compile_mjcf
from carom.geometry.hull import hull_triangles

# MuJoCo's Euler has explicit springs.
SPRINGS = ("springdamper", "damper off")
# MuJoCo's contacts push apart what slides; here it comes to rest at the same place on another way.
SLIDING = ("arm on a floor", "arm on a rough floor", "arm with round cones")
ANSWERS = json.loads((Path(__file__).parent / "cases" / "soft_answers.json").read_text())


def test_inverse_masses_at_the_reference_are_those_of_mujoco(tmp_path):
    (tmp_path / "file.xml").write_text(WEIGHED)
    model = compile_mjcf(tmp_path / "file.xml", hull=hull_triangles)
    for name, weights in ANSWERS["weights"]["bodies"].items():
        assert_allclose(model.body_weights[name], weights, rtol=1e-9, atol=1e-15)
    for name, weight in ANSWERS["weights"]["joints"].items():
        assert_allclose(model.joint_weights[name], weight, rtol=1e-9)


@pytest.mark.parametrize("name", MOVED)
def test_bodies_move_as_in_mujoco(tmp_path, name):
    (tmp_path / "file.xml").write_text(MOVED[name])
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        assert not scene.ignored.that_matter
        scene.apply_options()
        # MuJoCo's solver converges.
        world.parameters.solver_residual_threshold, world.parameters.solver_iterations = 1e-16, 500
        world.apply_parameters()
        for actuator in scene.actuators.values():
            actuator.control = 2.0
        done = 0
        for steps, answer in zip(STEPS, ANSWERS[name], strict=True):
            world.step(steps - done)
            done = steps
            free = next((body for body in scene.bodies if body.name == "f"), None)
            if free is not None:
                found = np.array(free.links[-1].pose.position)
            else:
                body = scene["a"]
                found = np.concatenate([body.joints[joint].coordinates for joint in ("j", "k")])
            atol = 5e-3 if name in SPRINGS else 1e-6
            if name in SLIDING and steps > STEPS[0]:
                atol = 2e-4 if steps == STEPS[-1] else 0.03
            assert_allclose(found, answer, atol=atol, err_msg=f"after {steps} steps")


@pytest.mark.parametrize("name", ["soft limit", "soft friction", "arm on a floor", "soft tendon limit"])
def test_saved_worlds_and_copies_yield_alike(tmp_path, name):
    (tmp_path / "file.xml").write_text(MOVED[name])
    with World() as world, World() as other:
        scene = world.load(tmp_path / "file.xml")
        scene.apply_options()
        body = scene["a"]
        world.save(tmp_path / "saved")
        saved = other.load(tmp_path / "saved")["a"]
        for each in (world, other):
            each.parameters.time_step = 0.002
            each.apply_parameters()
        worlds = Worlds(world, 2)
        world.step(200)
        other.step(200)
        worlds.step(200)
        positions = body.joints.positions
        assert_allclose(saved.joints.positions, positions, rtol=0.0, atol=0.0)
        assert_allclose(worlds.bodies["a"].joints.positions, [positions, positions], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("stated", "integrator"), [("RK4", "rk4"), ("Euler", "explicit"), ("", "explicit")])
def test_damping_is_explicit_where_euler_would_have_it_implicit(tmp_path, stated, integrator):
    name = f'integrator="{stated}"' if stated else ""
    (tmp_path / "file.xml").write_text(
        f'<mujoco><option {name}><flag eulerdamp="disable"/></option></mujoco>'
    )
    with World() as world:
        assert not world.load(tmp_path / "file.xml").ignored.that_matter
        assert world.integrator == integrator


def test_unknown_integrators_are_errors(tmp_path):
    (tmp_path / "file.xml").write_text('<mujoco><option integrator="RK5"/></mujoco>')
    with World() as world, pytest.raises(DescriptionError, match="implicitfast or RK4"):
        world.load(tmp_path / "file.xml")


@pytest.mark.parametrize("count", [0, 3])
def test_passes_without_slipping_hold_in_a_world_that_was_empty(tmp_path, count):
    (tmp_path / "file.xml").write_text(f'<mujoco><option noslip_iterations="{count}"/></mujoco>')
    with World() as world:
        assert not world.load(tmp_path / "file.xml").ignored.that_matter
        assert world.parameters.noslip_iterations == count


@pytest.mark.parametrize("name", ["tendon limit", "soft tendon limit", "box", "arm on a smooth floor"])
def test_options_of_a_file_let_the_solver_go_further(tmp_path, name):
    (tmp_path / "file.xml").write_text(MOVED[name])
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        assert world.parameters.solver_residual_threshold == 1e-11
        body = next(body for body in scene.bodies if body.name in "af")
        done, errors = 0, []
        for steps, answer in zip(STEPS, ANSWERS[name], strict=True):
            world.step(steps - done)
            done = steps
            found = body.links[-1].pose.position
            if body.name == "a":
                found = np.concatenate([body.joints[joint].coordinates for joint in ("j", "k")])
            errors.append(np.abs(np.array(found) - answer).max())
        assert max(errors) < 5e-5


@pytest.mark.parametrize(("override", "lost"), [("enable", ["o_friction"]), ("disable", [])])
def test_friction_with_directions_that_overrides_is_reported(tmp_path, override, lost):
    option = f'<option o_friction="1 2"><flag override="{override}"/></option>'
    (tmp_path / "file.xml").write_text(f"<mujoco>{option}</mujoco>")
    with World() as world:
        found = world.load(tmp_path / "file.xml").ignored.that_matter
    assert [name for it in found for name in it.attributes] == lost


@pytest.mark.parametrize("name", ["soft friction", "soft limit"])
def test_limits_and_friction_that_yield_have_exact_derivatives(tmp_path, name):
    (tmp_path / "file.xml").write_text(MOVED[name])
    with World() as world:
        world.load(tmp_path / "file.xml").apply_options()
        world.step(300)
        exact, differences = world.linearize(), world.linearize(method="differences")
        assert_allclose(exact.A, differences.A, atol=1e-6 * np.abs(differences.A).max())
