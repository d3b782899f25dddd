"""Fluids act on links as in MuJoCo, and on nothing else."""

import json
from pathlib import Path

import numpy as np
import pytest
from fluid_cases import FLUIDS, STEPS
from numpy.testing import assert_allclose, assert_array_equal

from carom import World, Worlds
from carom.description.fluid import FluidEllipsoid, carlson_rd
from carom.description.transform import rotation_matrix
from carom.errors import DescriptionError

ANSWERS = json.loads(Path(__file__).with_name("fluid_answers.json").read_text())
STEP = 1e-8


@pytest.fixture
def load(tmp_path):
    with World() as world:

        def load(text):
            (tmp_path / "file.xml").write_text(text)
            scene = world.load(tmp_path / "file.xml")
            assert not scene.ignored.that_matter
            scene.apply_options()
            return scene

        yield load


def moving(scene):
    return next(body for body in scene.bodies if body.name != "world")


def velocities(body):
    """Velocities as in `qvel`."""
    rates = np.ravel(body.joints.velocities).tolist()
    if body.fixed_base:
        return np.array(rates)
    base = body.links[-1]
    turn = np.array(rotation_matrix(tuple(base.pose.orientation)))
    omega = np.array(base.velocity.angular)
    lever = np.array(base.pose.position) - np.array(base.inertial_pose.position)
    linear = np.array(base.velocity.linear) + np.cross(omega, lever)
    return np.concatenate([linear, turn.T @ omega, rates])


def acceleration(scene):
    """Change of velocity per time in steps that tend to 0."""
    body, found = moving(scene), []
    for step in (STEP, 0.5 * STEP):
        scene.reset("0")
        before = velocities(body)
        scene.world.parameters.time_step = step
        scene.world.apply_parameters()
        scene.world.step()
        found.append((velocities(body) - before) / step)
    scene.apply_options()
    return 2.0 * found[1] - found[0]


@pytest.mark.parametrize("name", FLUIDS)
def test_accelerations_are_those_of_mujoco(load, name):
    wanted = np.array(ANSWERS[name]["acceleration"])
    found = acceleration(load(FLUIDS[name]))
    assert_allclose(found, wanted, rtol=0.0, atol=1e-6 * np.abs(wanted).max())


@pytest.mark.parametrize("name", [name for name in FLUIDS if name.startswith("arm")])
def test_arms_move_as_in_mujoco(load, name):
    scene = load(FLUIDS[name])
    scene.reset("0")
    scene.world.step(STEPS)
    assert_allclose(moving(scene).joints.positions, ANSWERS[name]["positions"], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("name", ["box in wind", "arm", "ellipsoids"])
def test_saved_worlds_and_copies_move_alike(load, tmp_path, name):
    scene = load(FLUIDS[name])
    scene.reset("0")
    scene.world.save(tmp_path / "saved")
    with World() as other:
        other.load(tmp_path / "saved")
        worlds = Worlds(scene.world, 8, threads=2)
        for each in (scene.world, other, worlds):
            each.step(50)
        body = moving(scene)
        saved = next(each for each in other.bodies.values() if each.name == body.name)
        assert_array_equal(saved.joints.positions, body.joints.positions)
        assert_array_equal(saved.links[-1].pose.position, body.links[-1].pose.position)
        assert_array_equal(worlds.bodies[body.name].joints.positions, [body.joints.positions] * 8)
        alone = worlds.extract(3)
        assert alone.parameters.fluid_density == scene.world.parameters.fluid_density
        assert alone.parameters.wind == scene.world.parameters.wind


@pytest.mark.parametrize("name", ["box in wind", "ellipsoids"])
def test_worlds_have_fluids_of_their_own(load, name):
    scene = load(FLUIDS[name])
    scene.reset("0")
    worlds = Worlds(scene.world, 8)
    density = np.array([0.0, 100.0, 0.0, 50.0, 0.0, 0.0, 300.0, 10.0])
    viscosity = np.array([0.0, 0.0, 0.5, 0.1, 0.0, 0.0, 1.0, 0.0])
    wind = np.arange(24.0).reshape(8, 3) / 10.0
    worlds.change_parameters(fluid_density=density, fluid_viscosity=viscosity, wind=wind)
    worlds.step(20)
    body, world = moving(scene), scene.world
    for number in range(8):
        scene.reset("0")
        world.parameters.fluid_density, world.parameters.fluid_viscosity = density[number], viscosity[number]
        world.parameters.wind = tuple(wind[number].tolist())
        world.apply_parameters()
        world.step(20)
        assert_array_equal(worlds.bodies[body.name].joints.positions[number], body.joints.positions)
        assert_array_equal(worlds.bodies[body.name].joints.velocities[number], body.joints.velocities)
    with pytest.raises(ValueError, match="density must not be negative"):
        worlds.change_parameters(fluid_density=-1.0)
    with pytest.raises(ValueError, match="viscosity must not be negative"):
        worlds.change_parameters(fluid_viscosity=-1.0)


@pytest.mark.parametrize("name", FLUIDS)
def test_steps_in_a_fluid_have_exact_derivatives(load, name):
    scene = load(FLUIDS[name])
    scene.reset("0")
    world = scene.world
    exact, near = world.linearize(tight=True), world.linearize(tight=True, method="differences")
    bound = 1e-6 * max(1.0, float(np.abs(near.A).max()))
    assert_allclose(exact.A, near.A, rtol=0.0, atol=bound)
    if world.arrays.model.numpy["fluid_density"].any():
        with pytest.raises(NotImplementedError, match="where forces of a fluid act"):
            world.linearize(parameters=["masses"], method="exact")


def test_a_file_without_a_fluid_switches_it_off(load):
    load(FLUIDS["arm"])
    scene = load("<mujoco/>")
    assert scene.world.parameters.fluid_density == scene.world.parameters.fluid_viscosity == 0.0


@pytest.mark.parametrize("attributes", ['density="-1"', 'viscosity="-.1"'])
def test_fluids_are_not_negative(load, attributes):
    with pytest.raises(DescriptionError, match="must not be negative"):
        load(f"<mujoco><option {attributes}/></mujoco>")


def test_shapes_in_fluids_have_to_be_known(load):
    with pytest.raises(DescriptionError, match="must be none or ellipsoid"):
        load('<mujoco><worldbody><body><geom size=".1" fluidshape="box"/></body></worldbody></mujoco>')


def test_added_mass_of_known_shapes():
    # A sphere moves half its volume of fluid; a flat disc 8/3 r³, and 16/45 r⁵ when it turns.
    mass, inertia = FluidEllipsoid((0.3, 0.3, 0.3)).added()
    assert_allclose(mass, 3 * [2.0 / 3.0 * np.pi * 0.3**3], rtol=1e-6)
    assert inertia == (0.0, 0.0, 0.0)
    mass, inertia = FluidEllipsoid((1.0, 1.0, 1e-6)).added()
    assert_allclose(mass, (0.0, 0.0, 8.0 / 3.0), rtol=1e-5, atol=1e-5)
    assert_allclose(inertia, (16.0 / 45.0, 16.0 / 45.0, 0.0), rtol=1e-5)


def test_carlsons_integral():
    # Values of Carlson's paper.
    assert_allclose(carlson_rd(0.0, 2.0, 1.0), 1.7972103521033883, rtol=1e-13)
    assert_allclose(carlson_rd(2.0, 3.0, 4.0), 0.16510527294261053, rtol=1e-13)
