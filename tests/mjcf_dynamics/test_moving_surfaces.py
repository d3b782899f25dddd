"""Surfaces that move, tendons that stiffen, frames at centres of mass and sharp edges are as in MuJoCo.

The numbers are of `mujoco` 4.0, see `record_surfaces.py`.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, set_velocity, tighten
from tests.mjcf_dynamics.surface_cases import ALIGNED, MOVING, STEPS, TENDONS

from carom import World, Worlds
from carom.world.scene import Scene

ANSWERS = json.loads(Path(__file__).with_name("surface_answers.json").read_text())
BELT = """<mujoco><worldbody><geom name="belt" type="box" size="5 1 .1"/>
<geom name="rail" size=".1" pos="0 3 0"/>
<body name="box" pos="0 0 .2"><freejoint/><geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>"""


def loaded(folder: Path, text: str, contact: str = "compliant") -> Scene:
    (folder / "file.xml").write_text(text)
    scene = World(contact=contact).load(folder / "file.xml")
    scene.apply_options()
    assert not scene.ignored.that_matter
    return scene


def _pose(scene: Scene, name: str):
    found = [
        part.pose
        for body in scene.bodies
        for parts in (body.links, body.sites)
        for part in parts
        if part.name == name
    ]
    (pose,) = found
    return pose


def check_poses(scene: Scene, name: str, bound: float):
    for body, expected in ANSWERS[name].items():
        pose = _pose(scene, body)
        np.testing.assert_allclose(pose.position, expected[:3], atol=bound, err_msg=body)
        w, x, y, z = expected[3:]
        turn = abs(np.dot(pose.orientation, (x, y, z, w)))
        assert turn == pytest.approx(1.0, abs=bound), body


@pytest.mark.parametrize(("name", "bound"), [("belts", 1e-6), ("tendons", 1e-12), ("edges", 1e-9)])
def test_files_move_as_in_mujoco(tmp_path: Path, name: str, bound: float):
    scene = loaded(tmp_path, MOVING[name])
    scene.world.step(STEPS)
    check_poses(scene, name, bound)


def test_frames_of_free_bodies_move_to_centres_where_files_want_it(tmp_path: Path):
    scene = loaded(tmp_path, ALIGNED)
    check_poses(scene, "aligned", 1e-12)


@pytest.mark.parametrize("contact", ["compliant", "rigid", "bullet"])
def test_belts_carry_what_lies_on_them_at_their_speed(tmp_path: Path, contact: str):
    scene = loaded(tmp_path, BELT, contact)
    world, box = scene.world, scene["box"]
    belt = scene["world"].shapes["belt"]
    assert not belt.surface_velocity.any()
    belt.surface_velocity = (0.5, 0.0, 2.0)
    world.step(500)
    assert box.velocity.linear == pytest.approx((0.5, 0.0, 0.0), abs=2e-2)
    assert scene["world"].pose.position == pytest.approx((0.0, 0.0, 0.0))
    # That of its other shape is another one.
    assert not scene["world"].shapes["rail"].surface_velocity.any()
    belt.surface_velocity, belt.surface_spin = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    world.step(200)
    x, y, _ = box.pose.position
    assert box.velocity.linear[:2] == pytest.approx((-y, x), abs=2e-2)


def test_surfaces_that_cannot_move_so_are_refused_and_stay(tmp_path: Path):
    belt = loaded(tmp_path, BELT)["world"].shapes["belt"]
    belt.surface_velocity = (0.5, 0.0, 0.0)
    with pytest.raises(ValueError, match="surface_velocity must have shape"):
        belt.surface_velocity = (1.0, 2.0)
    with pytest.raises(ValueError, match="surface_spin"):
        belt.surface_spin = (np.nan, 0.0, 0.0)
    assert belt.surface_velocity == pytest.approx((0.5, 0.0, 0.0))
    assert not belt.surface_spin.any()


ROLLS = """<mujoco><option timestep=".002"/><default><geom {options}/></default><worldbody>
<body pos="0 0 .1"><joint axis="1 2 0" damping="1" stiffness="300"/><geom name="belt" type="box" size="5 1 .1"
mass="3"/></body><body name="box" pos=".1 .05 .298"><freejoint/><geom size=".1" mass="1"/></body></worldbody>
</mujoco>"""


@pytest.mark.parametrize("contact", ["compliant", "rigid", "bullet"])
@pytest.mark.parametrize(
    ("options", "slip"),
    [("", 0.05), ("", 3.0), ('condim="4"', 0.3), ('condim="6" friction=".5 .1 .05"', 0.3)],
)
def test_steps_on_a_belt_that_itself_moves_have_exact_derivatives(
    tmp_path: Path, contact: str, options: str, slip: float
):
    scene = loaded(tmp_path, ROLLS.format(options=options), contact)
    belt = next(shape for body in scene.bodies for shape in body.shapes if shape.name == "belt")
    world = scene.world
    tighten(world)
    world.integrator = "discrete"
    belt.surface_velocity, belt.surface_spin = (slip, 0.3 * slip, 1.0), (0.3, 0.2, 0.7)
    world.step()
    # Not at rest, where a rigid contact is at a switch.
    set_velocity(scene["box"], 0.1, 0.2, 0.3, 0.1, -0.1, -0.5)
    step = assert_exact(world, 3e-6)
    assert any(name.startswith("friction of contact") for name, _ in step.rows)
    still = world.copy()
    shapes = [shape for body in still.bodies.values() for shape in body.shapes if shape.name == "belt"]
    shapes[0].surface_velocity, shapes[0].surface_spin = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    assert np.abs(still.linearize(method="exact").A - step.A).max() > 1e-4


@pytest.mark.parametrize("integrator", ["euler", "discrete"])
def test_tendons_that_stiffen_have_exact_derivatives(tmp_path: Path, integrator: str):
    scene = loaded(tmp_path, TENDONS)
    world = scene.world
    world.integrator = integrator
    world.step(300)
    exact = world.linearize(method="exact")
    near = world.linearize(method="differences")
    np.testing.assert_allclose(exact.A, near.A, atol=1e-6)


def test_surfaces_of_meshes_that_move_are_reported(tmp_path: Path):
    (tmp_path / "file.xml").write_text(
        '<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>'
        '<worldbody><geom type="mesh" mesh="m" surfacevel="1 0 0"/></worldbody></mujoco>'
    )
    scene = World().load(tmp_path / "file.xml")
    (ignored,) = scene.ignored.that_matter
    assert ignored.attributes == ("surfacevel",)
    assert not scene["world"].shapes[0].surface_velocity.any()


def test_belts_have_a_speed_of_their_own_in_each_of_many_worlds(tmp_path: Path):
    scene = loaded(tmp_path, BELT)
    worlds = Worlds(scene.world, 3)
    belt = worlds[scene["world"]].shapes["belt"]
    assert belt.surface_velocity.shape == belt.surface_spin.shape == (3, 3)
    belt.surface_velocity = [(0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, -0.3, 0.0)]
    belt.change(surface_spin=(0.0, 0.0, 1.0), where=[1])
    assert belt.surface_spin[:, 2].tolist() == [0.0, 1.0, 0.0]
    assert belt.link.name == "world"
    # That of its other shape is another one.
    assert not worlds[scene["world"]].shapes["rail"].surface_velocity.any()
    lone = [worlds.extract(number) for number in range(3)]
    assert lone[2]["world"].shapes["belt"].surface_velocity.tolist() == [0.0, -0.3, 0.0]
    assert lone[1]["world"].shapes["belt"].surface_spin.tolist() == [0.0, 0.0, 1.0]
    worlds.step(400)
    speeds = worlds[scene["box"]].velocity.linear
    np.testing.assert_allclose(speeds[[0, 2], :2], [(0.5, 0.0), (0.0, -0.3)], atol=2e-2)
    for number, world in enumerate(lone):
        world.step(400)
        np.testing.assert_array_equal(world.state.velocity, worlds.extract(number).state.velocity)
    resumed = Worlds(scene.world, 3)
    resumed.resume(worlds.checkpoint())
    assert resumed[scene["world"]].shapes["belt"].surface_velocity[2].tolist() == [0.0, -0.3, 0.0]
    for wrong in ((1.0, 0.0), (np.nan, 0.0, 0.0), np.zeros((2, 3))):
        with pytest.raises(ValueError, match="surface_velocity"):
            belt.surface_velocity = wrong
    with pytest.raises(TypeError, match="no parameter 'speed'"):
        belt.change(speed=1.0)


def test_parameters_of_a_shape_change_together_or_not_at_all(tmp_path: Path):
    scene = loaded(tmp_path, BELT)
    belt = scene["world"].shapes["belt"]
    belt.change(friction=0.7, restitution=0.1, surface_velocity=(1.0, 0.0, 0.0), colour=(1.0, 0.0, 0.0))
    assert (belt.friction, belt.restitution, belt.colour.tolist()) == (0.7, 0.1, [1.0, 0.0, 0.0, 1.0])
    with pytest.raises(ValueError, match="restitution"):
        belt.change(friction=0.2, restitution=-1.0)
    assert belt.friction == 0.7
    with pytest.raises(TypeError, match="no parameter 'speed'; they have friction"):
        belt.change(speed=1.0)
