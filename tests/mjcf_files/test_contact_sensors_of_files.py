"""Sensors of contacts in MJCF files show what MuJoCo's show, and those of `Body.add_sensor` the same.

The numbers are those of `mujoco` 4.0 after one step, of sensors of all geoms without friction.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import carom
from carom import ContactSensor, World, Worlds
from carom.errors import DescriptionError

FILE = """<mujoco><option timestep="0.002"/><default><geom condim="1"/></default><worldbody>
<geom name="floor" type="plane" size="5 5 1"/>
<body name="b" pos="0 0 .099"><freejoint/><geom name="ball" size=".1" mass="1"/>
<site name="bottom" pos="0 0 -.1" size=".02"/><site name="over" pos="0 0 .1" size=".05"/></body>
<body name="x" pos="1 0 .0985" euler="0 1 0"><freejoint/><geom name="box" type="box" size=".1 .2 .1"
 mass="2"/><body name="arm" pos=".3 0 0"><joint axis="0 1 0"/><geom name="foot" size=".05" pos="0 0 -.047"
 mass=".5"/></body></body>
<body name="y" pos="1 0 .297"><freejoint/><geom name="top" size=".1" mass="1"/></body></worldbody>
<sensor>{}</sensor></mujoco>"""
ALL = 'data="found force torque dist pos normal"'
CASES = {
    "a geom": (
        f'<contact geom1="ball" {ALL}/>',
        [1, 11.8195, 0, 0, 0, 0, 0, -0.001, 0, 0, -0.0005, 0, 0, -1],
    ),
    "two geoms": (
        f'<contact geom1="floor" geom2="ball" {ALL}/>',
        [1, 11.8195, 0, 0, 0, 0, 0, -0.001, 0, 0, -0.0005, 0, 0, 1],
    ),
    "slots": (
        '<contact geom1="box" geom2="floor" num="4" reduce="mindist" data="found dist normal"/>',
        [2, -0.00323001, 0, 0, -1, 2, -0.00323001, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
    ),
    "deepest": (
        '<contact geom2="floor" subtree1="x" num="2" reduce="mindist" data="dist pos"/>',
        [-0.00372856, 1.29913, 0, -0.00186428, -0.00323001, 1.09824, -0.2, -0.00161501],
    ),
    "strongest": (
        '<contact subtree1="x" num="2" reduce="maxforce" data="found force dist"/>',
        [4, 26.4734, 0, 0, -0.00323001, 4, 26.4734, 0, 0, -0.00323001],
    ),
    "net force": (
        f'<contact body1="x" {ALL} reduce="netforce"/>',
        [3, 0.253025, 0, -38.451, 0, 2.31508, 0, 0, 1.07675, 0, 0.0412472, 1, 0, 0],
    ),
    "net force of a subtree": (
        f'<contact subtree1="x" body2="world" {ALL} reduce="netforce"/>',
        [3, 0, 0, -52.9468, 0, 0, 0, 0, 1.09824, 0, -0.00161501, 1, 0, 0],
    ),
    "net force of the world": (
        f'<contact body1="world" {ALL} reduce="netforce"/>',
        [4, 0, 0, 64.7663, 0, 0, 0, 0, 0.897817, 0, -0.00141152, 1, 0, 0],
    ),
    "anything on a geom": (
        f'<contact geom2="ball" {ALL}/>',
        [1, 11.8195, 0, 0, 0, 0, 0, -0.001, 0, 0, -0.0005, 0, 0, 1],
    ),
    "the world as a subtree": (
        f'<contact subtree1="world" geom2="top" {ALL}/>',
        [1, 14.498, 0, 0, 0, 0, 0, -0.00153023, 0.998268, 0, 0.19778, 0.0174524, 0, 0.999848],
    ),
    "at a site": (
        '<contact site="bottom"/>',
        [1],
    ),
    "not at a site": (
        '<contact site="over"/>',
        [0] * 1,
    ),
    "a geom at a site": (
        '<contact site="bottom" geom2="floor" data="found normal"/>',
        [1, 0, 0, -1],
    ),
    "apart": (
        f'<contact geom1="top" geom2="ball" num="2" {ALL}/>',
        [0] * 28,
    ),
    "within": (
        '<contact subtree1="x" subtree2="x"/>',
        [0] * 1,
    ),
}  # fmt: skip
FIELDS = ("found", "force", "torque", "dist", "pos", "normal")


def load(world, folder, sensors=""):
    (folder / "file.xml").write_text(FILE.format(sensors))
    scene = world.load(folder / "file.xml")
    scene.apply_options()
    world.parameters.solver_iterations = 1000
    return scene


@pytest.mark.parametrize("name", CASES)
def test_sensors_of_contacts_show_what_those_of_mujoco_show(tmp_path, name):
    sensor, expected = CASES[name]
    with World() as world:
        scene = load(world, tmp_path, sensor)
        assert not scene.ignored.that_matter
        world.step()
        (sensor,) = scene.sensors.values()
        assert_allclose(sensor.read(), expected, atol=1e-3)


def test_all_sensors_of_a_file_are_read_together_and_in_many_worlds(tmp_path):
    with World() as world:
        scene = load(world, tmp_path, "".join(sensor for sensor, _ in CASES.values()))
        worlds = Worlds(world, 3)
        world.step()
        worlds.step()
        place = 0
        for body in scene.bodies:
            for name, shown in body.sensors.read().items():
                assert_allclose(body.sensors[name].read(), shown)
                assert_allclose(worlds[body].sensors[name].read(), [shown] * 3, atol=1e-6)
                place += 1
        assert place == len(CASES)


def test_descriptions_keep_sensors_of_contacts(tmp_path):
    names = '<contact name="c" subtree1="x" geom2="floor"/><contact name="d" body1="y" body2="x"/>'
    (tmp_path / "file.xml").write_text(FILE.format(names))
    description = carom.read(tmp_path / "file.xml")
    for kind, old in (("bodies", "x"), ("geoms", "floor"), ("bodies", "y")):
        getattr(description, kind)[old].rename(f"new {old}")
    with World() as world:
        scene = world.load(description)
        world.step()
        assert [scene.sensors[name].read() for name in "cd"] == [[3.0], [1.0]]


def test_bodies_are_given_sensors_of_contacts(tmp_path):
    with World() as world:
        scene = load(world, tmp_path)
        ball, box, top = (scene[name] for name in "bxy")
        ball.add_sensor("a", ContactSensor(shape="ball", fields=FIELDS))
        ball.add_sensor("site", ContactSensor(site="bottom", other_link="world", other_body="world"))
        box.add_sensor(
            "net", ContactSensor(link="x", fields=FIELDS, reduction="netforce", period=0.002, bias=1.0)
        )
        box.add_sensor("arm", ContactSensor(subtree="arm", other_shape="floor", other_body="world"))
        top.add_sensor("top", ContactSensor(subtree="y", other_subtree="x", other_body="x"))
        assert "shape 'ball'" in repr(ball.sensors["a"])
        world.step()
        assert_allclose(ball.sensors["a"].read(), CASES["a geom"][1], atol=1e-3)
        assert_allclose(box.sensors["net"].read(), np.add(CASES["net force"][1], 1.0), atol=1e-3)
        for body, name in ((ball, "site"), (box, "arm"), (top, "top")):
            assert body.sensors[name].read() == [1.0]
        world.save(tmp_path / "saved.carom")
        with World() as other:
            other.load(tmp_path / "saved.carom")
            world.step()
            other.step()
            for body in (ball, box, top):
                shown = other.bodies[body.id].sensors.read()
                assert shown.keys() == {sensor.name for sensor in body.sensors}
                for name, values in body.sensors.read().items():
                    assert_allclose(shown[name], values)


def test_volumes_of_sites_hold_points_of_contacts(tmp_path):
    with World() as world:
        ball = load(world, tmp_path)["b"]
        expected = {}
        for shape, size in {
            "sphere": (0.02,), "box": (0.01, 0.01, 0.02), "ellipsoid": (0.01, 0.01, 0.02),
            "cylinder": (0.01, 0.02), "capsule": (0.01, 0.01),
        }.items():  # fmt: skip
            for number, (x, z, inside) in enumerate(
                ((0.0, -0.08, True), (0.008, -0.0995, True), (0.0, -0.06, False), (0.03, -0.0995, False))
            ):
                name = f"{shape} {number}"
                ball.add_site(name, -1, carom.description.Pose((x, 0.0, z)), shape=shape, size=size)
                ball.add_sensor(name, ContactSensor(site=name))
                expected[name] = float(inside)
        world.step()
        assert {name: float(shown[0]) for name, shown in ball.sensors.read().items()} == expected


@pytest.mark.parametrize(
    ("sensor", "reason"),
    [
        ("<contact/>", "a sensor is one of a body"),
        ('<contact subtree1="world"/>', "world has no sensors"),
        ('<contact geom1="ball" data="linvel"/>', "velocities of contacts"),
        ('<contact geom1="ghost"/>', "does not collide"),
    ],
)
def test_what_has_no_sensor_of_contacts_is_reported(tmp_path, sensor, reason):
    text = FILE.replace('<geom name="top"', '<geom name="ghost" size=".1" contype="0" conaffinity="0"/>'
                        '<geom name="top"').format(sensor)  # fmt: skip
    (tmp_path / "file.xml").write_text(text)
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        (lost,) = scene.ignored.that_matter
        assert (lost.element, lost.consequence) == ("sensor/contact", "there is no such sensor")
        assert reason in lost.reason


@pytest.mark.parametrize(
    ("sensor", "problem"),
    [
        ('<contact geom1="no"/>', "no such geom, body or site 'no'"),
        ('<contact geom1="ball" body1="b"/>', "only one of geom1, body1"),
        ('<contact body1="b" site="over"/>', "only one of body1, site"),
        ('<contact geom1="ball" data="force found"/>', "in this order"),
        ('<contact geom1="ball" data="heat"/>', "must be some of found, force"),
        ('<contact geom1="ball" num="0"/>', "must be from 1"),
        ('<contact geom1="ball" num="1.5"/>', "must be from 1"),
        ('<contact geom1="ball" reduce="all"/>', "is none of none, mindist"),
    ],
)
def test_mistakes_in_sensors_of_contacts_are_named(tmp_path, sensor, problem):
    with World() as world, pytest.raises(DescriptionError, match=f"file.xml:.*{problem}"):
        load(world, tmp_path, sensor)


def test_mistakes_in_given_sensors_of_contacts_are_named(tmp_path):
    with pytest.raises(TypeError, match="needs a site, a shape, a link or a subtree"):
        ContactSensor()
    with pytest.raises(TypeError, match="only one of shape, link, subtree"):
        ContactSensor(link="x", other_shape="a", other_link="b")
    with pytest.raises(ValueError, match="all"):
        ContactSensor(link="x", reduction="all")
    with World() as world:
        ball = load(world, tmp_path)["b"]
        for sensor, problem in (
            (ContactSensor(shape="no"), "no collision shape 'no'"),
            (ContactSensor(link="no"), "no link 'no'"),
            (ContactSensor(link="b", fields=("pos", "found")), "in this order"),
            (ContactSensor(link="b", fields=()), "shows some of"),
            (ContactSensor(link="b", slots=0), "from 1 to"),
            (ContactSensor(link="b", other_link="b", other_body="no"), "0 bodies have the name"),
        ):
            with pytest.raises(DescriptionError, match=problem):
                ball.add_sensor("s", sensor)
