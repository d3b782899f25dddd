"""Each shape has a surface of its own: friction, bounce and softness of contacts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from carom import Body, World, Worlds
from carom.scene.shapes import BodyShape

G = 9.81
# A sledge that stands on the floor with one runner at a time: turned over, on the other one.
SLEDGE = """<mujoco><option timestep="0.002" gravity="0 0 -9.81" cone="elliptic"/>
<default><geom friction="0.05 0 0"/></default><worldbody>
<geom name="floor" type="plane" size="9 9 1"/>
<body name="sledge" pos="0 0 {height}" euler="{turn} 0 0"><freejoint/>
<geom name="block" type="box" size=".2 .2 .05" mass="2" contype="0" conaffinity="0"/>
<geom name="smooth" type="box" pos="0 0 -.06" size=".2 .2 .01" mass="0.1" friction="0.1 0 0"/>
<geom name="rough" type="box" pos="0 0 .06" size=".2 .2 .01" mass="0.1" friction="0.6 0 0" {more}/>
</body></worldbody></mujoco>"""
SDF = """<sdf version="1.9"><model name="m"><link name="l"><pose>0 0 {height} {roll} 0 0</pose>
<inertial><mass>2</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>
<collision name="smooth"><pose>0 0 -.06 0 0 0</pose><geometry><box><size>.4 .4 .02</size></box></geometry>
<surface><friction><ode><mu>0.1</mu></ode></friction></surface></collision>
<collision name="rough"><pose>0 0 .06 0 0 0</pose><geometry><box><size>.4 .4 .02</size></box></geometry>
<surface><friction><ode><mu>0.6</mu></ode></friction></surface></collision></link></model></sdf>"""


def sledge(folder: Path, turn: float = 0.0, more: str = "") -> tuple[World, Body]:
    path = folder / f"sledge{turn:g}.xml"
    path.write_text(SLEDGE.format(height=0.0699, turn=turn, more=more))
    world = World()
    return world, world.load(path)["sledge"]


def deceleration(world: World, body: Body, steps: int = 150) -> float:
    """How a sledge that slides at 2 m/s slows down [m/s²]."""
    world.step(50)
    before = world.velocity.copy()
    before[body.first_velocity : body.first_velocity + 6] = (0.0, 0.0, 0.0, 2.0, 0.0, 0.0)
    world.velocity[:] = before
    world.step(steps)
    return (2.0 - world.velocity[body.first_velocity + 3]) / (steps * world.time_step)


@pytest.mark.parametrize(("turn", "friction"), [(0.0, 0.1), (180.0, 0.6)])
def test_a_body_slides_by_the_friction_of_the_shape_it_stands_on(
    tmp_path: Path, turn: float, friction: float
):
    world, body = sledge(tmp_path, turn)
    assert deceleration(world, body) == pytest.approx(friction * G, rel=0.02)


@pytest.mark.parametrize(("roll", "friction"), [(0.0, 0.1), (np.pi, 0.6)])
def test_sdf_files_state_it_for_each_collision(tmp_path: Path, roll: float, friction: float):
    (tmp_path / "m.sdf").write_text(SDF.format(height=0.0699, roll=roll))
    world = World(0.002, gravity=(0.0, 0.0, -G))
    world.add_plane(friction=1.0)
    body = next(iter(world.load(tmp_path / "m.sdf")))
    assert deceleration(world, body) == pytest.approx(friction * G, rel=0.02)


def again_by_file(world: World, folder: Path) -> World:
    world.save(folder / "saved")
    other = World()
    other.load(folder / "saved")
    return other


@pytest.mark.parametrize(
    "again",
    [
        lambda world, _: world,
        lambda world, _: world.copy(),
        again_by_file,
        lambda world, _: Worlds(world, 2).extract(1),
    ],
    ids=["itself", "copy", "file", "worlds"],
)
def test_shapes_are_read_and_set_by_name(tmp_path: Path, again: Callable[[World, Path], World]):
    world, body = sledge(tmp_path, 180.0)
    assert [shape.name for shape in body.shapes] == ["smooth", "rough"]
    assert [shape.friction for shape in body.shapes] == [0.1, 0.6]
    body.shapes["rough"].friction = 0.3
    body.shapes["rough"].restitution = 0.25
    body.shapes[0].rolling_friction, body.shapes[0].spinning_friction = 0.02, 0.01
    other = again(world, tmp_path)
    found = other["sledge"].shapes
    assert [shape.friction for shape in found] == [0.1, 0.3]
    assert [shape.restitution for shape in found] == [0.0, 0.25]
    assert (found["smooth"].rolling_friction, found["smooth"].spinning_friction) == (0.02, 0.01)
    assert found["rough"].rolling_friction == 0.0
    found["rough"].restitution = 0.0
    assert deceleration(other, other["sledge"]) == pytest.approx(0.3 * G, rel=0.02)


def test_what_is_set_for_a_link_holds_for_all_of_its_shapes(tmp_path: Path):
    for turn in (0.0, 180.0):
        world, body = sledge(tmp_path, turn)
        body.change_dynamics(-1, lateral_friction=0.2)
        assert [shape.friction for shape in body.shapes] == [0.2, 0.2]
        assert deceleration(again_by_file(world, tmp_path), body) == pytest.approx(0.2 * G, rel=0.02)


def test_many_worlds_set_it_for_all_shapes_of_a_link(tmp_path: Path):
    world, body = sledge(tmp_path, 180.0)
    worlds = Worlds(world, 3)
    assert worlds[body].dynamics(-1)["lateral_friction"].tolist() == [0.1] * 3
    worlds[body].change_dynamics(-1, lateral_friction=[0.2, 0.4], where=[0, 2])
    for number, friction in enumerate((0.2, 0.6, 0.4)):
        lone = worlds.extract(number)
        assert lone["sledge"].shapes["rough"].friction == friction
        assert deceleration(lone, lone["sledge"]) == pytest.approx(friction * G, rel=0.02)


@pytest.mark.parametrize(("more", "height"), [("", 0.06989224457976), ('solref="0.1 1"', 0.06939844473017)])
def test_each_shape_yields_as_its_file_says(tmp_path: Path, more: str, height: float):
    # The heights are those of MuJoCo 4.0.
    world, body = sledge(tmp_path, 180.0, more)
    world.step(1000)
    assert body.pose.position[2] == pytest.approx(height, abs=1e-12)


def test_a_shape_refuses_what_is_no_coefficient(tmp_path: Path):
    _, body = sledge(tmp_path)
    shape: BodyShape = body.shapes["rough"]
    for value in (-0.1, np.nan, np.inf):
        with pytest.raises(ValueError, match="friction"):
            shape.friction = value
    assert shape.friction == 0.6
    with pytest.raises(KeyError, match="no shape is called 'foot'; there are smooth, rough"):
        body.shapes["foot"]
    assert repr(shape) == "<Shape 1 'rough' of 'sledge': link 'sledge'>"
    assert (shape.link.name, shape.frame.position) == ("sledge", (0.0, 0.0, 0.06))
