"""Actuators that pull a body towards all that touches it: `<adhesion>`, and `Adhesion` of any body."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.each import each
from tests.linearization.scenes import assert_exact, set_velocity

from carom import Adhesion, World, Worlds
from carom.errors import DescriptionError
from carom.world.scene import Scene

FILE = """<mujoco><option timestep=".002"/><worldbody>{}</worldbody><actuator>{}</actuator></mujoco>"""
BOX = '<body name="b" pos="{}"><freejoint/><geom type="box" size=".1 .1 .1" mass="1" friction=".5"/></body>'
CEILING = '<geom type="box" size="1 1 .1" pos="0 0 1"/>' + BOX.format("0 0 .801")
ARM = """<geom type="plane" size="5 5 .1"/><body pos="0 0 .5"><joint name="j" axis="0 1 0"/>
<geom type="capsule" size=".02" fromto="0 0 0 .4 0 0"/><body name="b" pos=".4 0 0"><geom size=".05"/></body>
</body>
<body name="o" pos=".4 0 .352"><freejoint/><geom type="sphere" size=".1" mass=".2"/></body>"""
WALL = '<geom type="box" size=".1 1 1" pos="-.1 0 0" friction=".5"/>' + BOX.format(".0995 0 0")
BALLS = """<body pos="0 0 1"><freejoint/><geom size=".1" mass="2"/></body>
<body name="b" pos="0 .05 1.189"><freejoint/><geom size=".1" mass="1" margin=".001"/></body>"""
PULL = '<adhesion name="a" body="b" gain="{}" ctrlrange="0 1"/>'
FILTER = """<general name="a" body="b" gainprm="100" ctrlrange="0 1" forcerange="0 40" dyntype="filter"
dynprm=".05"/>"""
# What MuJoCo 4.0 says: where the body is after 100 steps with control 1, and the force.
ANSWERS = {
    "on the floor": (
        FILE.format('<geom type="plane" size="5 5 .1"/>' + BOX.format("0 0 .0995"), PULL.format(30)),
        (0.0, 0.0, 0.09962894997429955), 30.0,
    ),
    "below a ceiling": (FILE.format(CEILING, PULL.format(30)), (0.0, 0.0, 0.8002129114835773), 30.0),
    "with a filter": (FILE.format(CEILING, FILTER), (0.0, 0.0, 0.8003000373248017), 40.0),
    "two balls": (
        FILE.format(BALLS, PULL.format(30)), (0.0, 0.05078144384434695, 0.9937918577316307), 30.0,
    ),
    "a pad on an arm lifts a ball": (
        FILE.format(ARM, PULL.format(10) + '<position joint="j" kp="20" kv="2"/>'),
        (0.39374550716437096, 0.0, 0.4295409651792453), 10.0,
    ),
    "along a wall": (
        FILE.format(WALL, PULL.format(15)), (0.10594451205127885, 0.0, -0.15360713661920034), 15.0,
    ),
}  # fmt: skip


def loaded(folder: Path, text: str, contact: str = "compliant") -> Scene:
    (folder / "file.xml").write_text(text)
    scene = World(contact=contact).load(folder / "file.xml")
    assert not scene.ignored.that_matter
    return scene


def place(scene: Scene) -> np.ndarray:
    links = [link for body in scene.bodies for link in body.links if link.name == "b"]
    return links[0].pose.position


@each("name", ANSWERS)
def test_it_pulls_as_in_mujoco(tmp_path: Path, name: str):
    text, position, force = ANSWERS[name]
    scene = loaded(tmp_path, text)
    scene.actuators["a"].control = 1.0
    scene.world.step(100)
    # Servos have other bits than in MuJoCo's integrator of the file.
    assert_allclose(place(scene), position, atol=1e-3 if "arm" in name else 1e-10)
    assert scene.actuators["a"].force == pytest.approx(force)
    assert scene.actuators["a"].length == 0.0


def test_what_it_holds_falls_when_the_control_is_0(tmp_path: Path):
    scene = loaded(tmp_path, ANSWERS["below a ceiling"][0])
    scene.actuators["a"].control = 1.0
    scene.world.step(100)
    scene.actuators["a"].control = 0.0
    scene.world.step(100)
    assert place(scene)[2] < 0.7


@each("contact", ["bullet", "rigid"])
def test_it_holds_with_other_laws_of_contacts_and_substeps_too(tmp_path: Path, contact: str):
    # A law that does not yield would push it off from deeper.
    scene = loaded(tmp_path, ANSWERS["below a ceiling"][0].replace(".801", ".80001"), contact)
    scene.world.parameters.substeps = 3
    scene.actuators["a"].control = 1.0
    scene.world.step(300)
    assert place(scene)[2] == pytest.approx(0.8, abs=1e-3)


@each("integrator", ["implicitfast", "rk4"])
def test_it_holds_with_other_integrators(tmp_path: Path, integrator: str):
    scene = loaded(tmp_path, ANSWERS["below a ceiling"][0])
    scene.world.parameters.integrator = integrator
    scene.actuators["a"].control = 1.0
    scene.world.step(300)
    assert place(scene)[2] == pytest.approx(0.8, abs=1e-3)


def test_forces_of_the_user_act_beside_it(tmp_path: Path):
    scene = loaded(tmp_path, ANSWERS["below a ceiling"][0])
    scene.actuators["a"].control = 1.0
    scene.world.step(100)
    body = scene["b"]
    for _ in range(100):
        body.links["b"].apply_force((0.0, 0.0, -25.0))
        scene.world.step()
    # 30 N hold 10 N of weight, and not 25 N more.
    assert place(scene)[2] < 0.7


def test_a_body_of_any_kind_has_it_in_many_worlds(tmp_path: Path):
    world = World(contact="rigid", gravity=(0.0, 0.0, -10.0))
    world.add_box((1.0, 1.0, 0.1), mass=0.0, position=(0.0, 0.0, 1.0))
    body = world.add_box((0.1, 0.1, 0.1), mass=1.0, position=(0.0, 0.0, 0.80001))
    body.add_actuator("grip", Adhesion(body.links[-1].name, gain=30.0))
    worlds = Worlds(world, 2)
    worlds[body].actuators["grip"].control = [1.0, 0.0]
    worlds.step(100)
    heights = worlds[body].links[-1].pose.position[:, 2]
    assert heights[0] == pytest.approx(0.8, abs=1e-3)
    assert heights[1] < 0.7


def test_what_has_no_meaning_is_refused(tmp_path: Path):
    scene = loaded(tmp_path, ANSWERS["below a ceiling"][0])
    body = scene["b"]
    with pytest.raises(DescriptionError, match="there is no link 'c'"):
        body.add_actuator("other", Adhesion("c"))
    with pytest.raises(DescriptionError, match="must not be negative"):
        body.add_actuator("other", Adhesion("b", control_range=(-1.0, 1.0)))
    assert [it.name for it in body.actuators] == ["a"]


@pytest.mark.parametrize("integrator", ["euler", "discrete", "rk4"])
@each("name", list(ANSWERS))
def test_forces_of_adhesion_have_exact_derivatives(tmp_path: Path, name: str, integrator: str):
    scene = loaded(tmp_path, ANSWERS[name][0])
    world = scene.world
    world.integrator = integrator
    scene.actuators["a"].control = 0.9
    world.step(5)
    for body in scene.bodies:
        if not body.fixed_base:
            set_velocity(body, 0.2, -0.1, 0.3, 0.1, 0.05, -0.02)
    step = assert_exact(world, 3e-6, controls=["actuators"])
    assert not step.at_switch
    # That of a filter acts by its activation, which changes in the step.
    by_force = step.A[:, -1:] if step.states[-1].endswith("activation") else step.B[:, :1]
    moving = ["velocity" in it for it in step.states]
    assert np.abs(by_force[moving]).max() > 1e-4


def test_rigid_contacts_with_a_gap_have_no_exact_adhesion():
    world = World(contact="rigid")
    world.load_urdf("plane.urdf")
    cube = world.load_urdf("cube.urdf", (0.0, 0.0, 0.5002))
    cube.add_actuator("a", Adhesion(cube.links[-1].name, gain=10.0, control_range=(0.0, 1.0)))
    with pytest.raises(NotImplementedError, match="rigid contact with a gap"):
        world.linearize(method="exact")


@each(
    ("actuator", "says"),
    [
        ('<adhesion body="b" ctrlrange="-1 1"/>', "must not be negative"),
        ('<adhesion body="b" gain="-3" ctrlrange="0 1"/>', "must not be negative"),
        ('<adhesion body="b"/>', "needs a ctrlrange"),
        ('<adhesion body="c" ctrlrange="0 1"/>', "there is no body 'c'"),
        ('<adhesion ctrlrange="0 1"/>', "states nothing that it acts on"),
    ],
)
def test_files_that_mujoco_refuses_are_refused(tmp_path: Path, actuator: str, says: str):
    (tmp_path / "file.xml").write_text(FILE.format(CEILING, actuator))
    with pytest.raises(DescriptionError, match=says):
        World(contact="compliant").load(tmp_path / "file.xml")
