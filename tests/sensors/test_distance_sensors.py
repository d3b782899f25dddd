"""Sensors of distance show what MuJoCo's show, in files and by `Body.add_sensor`.

The numbers are those of `mujoco` 4.0: distance, normal and both points, with a cutoff of 9 m.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import Distance, DistanceNormal, DistancePoints, World, Worlds
from carom.errors import DescriptionError

FILE = """<mujoco><asset><mesh name="m" vertex="0 0 0 .4 0 0 0 .5 0 0 0 .6"/></asset><worldbody>
<geom name="floor" type="plane" size="5 5 1"/><body name="a" pos="0 0 1"><freejoint/>
<geom name="ball" size=".1"/><geom name="other" size=".1" pos=".5 0 0"/><body name="arm" pos="-1 0 0">
<joint/><geom name="rod" type="capsule" size=".1 .2"/></body></body><body name="b" pos="1.3 0 1"
 euler="10 20 30"><freejoint/><geom name="box" type="box" size=".1 .2 .3"/></body><body name="c"
 pos="1.3 1 1" euler="10 20 30"><freejoint/><geom name="can" type="cylinder" size=".1 .2"/></body>
<body name="m" pos="-1 -1 1" euler="10 20 30"><freejoint/><geom name="mesh" type="mesh" mesh="m"/></body>
<body name="in" pos=".15 .02 1.03" euler="10 20 30"><freejoint/><geom name="deep" type="box"
 size=".1 .2 .3"/></body><body name="wall" pos="2 2 1"><geom type="box" size=".1 .2 .3"/></body>
<body name="none" pos="0 0 5"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
</worldbody><sensor>{}</sensor></mujoco>"""
CASES = {
    "balls": (
        'geom1="ball" geom2="other"',
        [0.3, 1, 0, 0, 0.1, 0, 1, 0.4, 0, 1],
    ),
    "a box": (
        'geom1="box" geom2="other"',
        [0.47843, -0.91813, -0.26779, 0.29211, 1.03107, 0.1549, 0.83104, 0.59181, 0.02678, 0.97079],
    ),
    "bodies": (
        'body1="a" body2="b"',
        [0.47843, 0.91813, 0.26779, -0.29211, 0.59181, 0.02678, 0.97079, 1.03107, 0.1549, 0.83104],
    ),
    "turned round": (
        'body1="b" body2="a"',
        [0.47843, -0.91813, -0.26779, 0.29211, 1.03107, 0.1549, 0.83104, 0.59181, 0.02678, 0.97079],
    ),
    "a body in another": (
        'body1="arm" body2="a"',
        [0.8, 1, 0, 0, -0.9, 0, 1, -0.1, 0, 1],
    ),
    "a floor": (
        'geom1="can" geom2="floor"',
        [0.77702, 0, 0, -1, 1.31512, 0.99279, 0.77702, 1.31512, 0.99279, 0],
    ),
    "the world": (
        'body1="world" body2="b"',
        [0.63813, 0, 0, 1, 1.37274, -0.0613, 0, 1.37274, -0.0613, 0.63813],
    ),
    "a wall": (
        'body1="wall" geom2="box"',
        [1.69074, -0.42301, -0.90613, 0, 1.9, 1.8, 0.76565, 1.1848, 0.26797, 0.76565],
    ),
    "a mesh": (
        'geom1="mesh" geom2="can"',
        [2.53458, 0.72468, 0.68817, -0.03551, -0.67448, -0.78246, 0.91805, 1.16227, 0.96177, 0.82804],
    ),
    "a capsule": (
        'geom1="rod" geom2="mesh"',
        [0.53289, -0.32719, -0.94496, 0, -1.03272, -0.0945, 1.14741, -1.20707, -0.59806, 1.14741],
    ),
    "a can and a box": (
        'geom1="can" geom2="box"',
        [0.66507, -0.0894, -0.98599, -0.14082, 1.31338, 0.89075, 1.04632, 1.25392, 0.23499, 0.95267],
    ),
    "a mesh and the floor": (
        'geom1="mesh" geom2="floor"',
        [0.91805, 0, 0, -1, -0.67448, -0.78246, 0.91805, -0.67448, -0.78246, 0],
    ),
    "within": (
        'geom1="deep" geom2="ball"',
        [-0.0732, 0.8138, 0.54384, -0.20487, 0.02181, 0.01457, 0.99451, 0.08138, 0.05438, 0.97951],
    ),
    "within, turned round": (
        'body1="a" geom2="deep"',
        [-0.0732, -0.8138, -0.54384, 0.20487, 0.08138, 0.05438, 0.97951, 0.02181, 0.01457, 0.99451],
    ),
    "without shapes": (
        'body1="none" geom2="box"',
        [9, 0, 0, 0, 0, 0, 0, 0, 0, 0],
    ),
}  # fmt: skip
TAGS = ("distance", "normal", "fromto")
KINDS = (Distance, DistanceNormal, DistancePoints)


def load(world, folder, sensors=""):
    (folder / "file.xml").write_text(FILE.format(sensors))
    return world.load(folder / "file.xml")


def shown(scene):
    return np.concatenate([sensor.read() for sensor in scene.sensors.values()])


@pytest.mark.parametrize("name", CASES)
def test_sensors_of_distance_show_what_those_of_mujoco_show(tmp_path, name):
    sides, expected = CASES[name]
    with World() as world:
        scene = load(world, tmp_path, "".join(f'<{tag} {sides} cutoff="9"/>' for tag in TAGS))
        assert not scene.ignored.that_matter
        assert_allclose(shown(scene), expected, atol=2e-5)


@pytest.mark.parametrize("name", CASES)
def test_a_cutoff_is_how_far_they_see(tmp_path, name):
    sides, (distance, *expected) = CASES[name]
    for cutoff in ("", 'cutoff=".01"'):
        with World() as world:
            scene = load(world, tmp_path, "".join(f"<{tag} {sides} {cutoff}/>" for tag in TAGS))
            first, *others = shown(scene)
        if distance >= 0.0:
            assert [first, *others] == [0.01 if cutoff else 0.0] + [0.0] * 9
        else:
            assert first == pytest.approx(-0.01 if cutoff else distance, abs=2e-5)
            assert_allclose(others, expected, atol=2e-5)


def test_all_are_read_together_in_many_worlds_and_with_a_clock(tmp_path):
    sensors = "".join(
        f'<{tag} {sides} cutoff="9" {clock}/>'
        for sides, _ in CASES.values()
        for tag, clock in zip(TAGS, ("", "", 'interval=".1"'), strict=True)
    )
    with World() as world:
        scene = load(world, tmp_path, sensors)
        worlds = Worlds(world, 3)
        found, before = 0, shown(scene)
        for step in range(3):
            if step:
                world.step()
                worlds.step()
            for body in scene.bodies:
                for name, values in body.sensors.read().items():
                    assert_allclose(body.sensors[name].read(), values)
                    assert_allclose(worlds[body].sensors[name].read(), [values] * 3, atol=1e-9)
                    found += 1
        assert found == 9 * len(CASES)
        assert np.abs(shown(scene) - before).max() > 1e-6


def test_worlds_that_differ_have_distances_of_their_own(tmp_path):
    with World() as world:
        load(world, tmp_path, '<distance name="d" geom1="ball" geom2="floor" cutoff="9"/>')
        worlds = Worlds(world, 3)
        heights = np.array([1.0, 2.0, 0.05])
        poses = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (3, 1))
        poses[:, 2] = heights
        worlds["a"].set_pose(poses)
        assert_allclose(worlds["a"].sensors["d"].read()[:, 0], heights - 0.1, atol=1e-12)


def test_bodies_are_given_sensors_of_distance(tmp_path):
    with World() as world:
        scene = load(world, tmp_path)
        a, box = scene["a"], scene["b"]
        for kind in KINDS:
            name = kind.__name__
            a.add_sensor(name, kind(link="a", other_link="b", other_body="b"))
            a.add_sensor(f"own {name}", kind(shape="ball", other_shape="other"))
            box.add_sensor(name, kind(shape="box", other_subtree="a", other_body="a"))
            box.add_sensor(f"near {name}", kind(shape="box", other_link="a", other_body="a", reach=0.3))
        assert "shape 'box' from subtree 'a'" in repr(KINDS[0](shape="box", other_subtree="a"))
        box.add_sensor(
            "biased", Distance(shape="box", other_shape="ball", other_body="a", bias=1.0, cutoff=0.2)
        )

        def numbers(body, before=""):
            return np.concatenate([body.sensors[before + kind.__name__].read() for kind in KINDS])

        assert_allclose(numbers(a), CASES["bodies"][1], atol=2e-5)
        assert_allclose(numbers(a, "own "), CASES["balls"][1], atol=2e-5)
        assert_allclose(numbers(box), CASES["turned round"][1], atol=2e-5)
        assert numbers(box, "near ").tolist() == [0.3] + [0.0] * 9
        assert box.sensors["biased"].read() == [0.2]
        world.save(tmp_path / "saved.carom")
        with World() as other:
            other.load(tmp_path / "saved.carom")
            assert_allclose(numbers(other.bodies[a.id]), numbers(a))


@pytest.mark.parametrize(
    ("sides", "reason"),
    [
        ('geom1="ghost" geom2="ball"', "does not collide"),
        ('body1="b" body2="shade"', "no geom of its body collides"),
        ('body1="a" geom2="ball"', "one side is part of the other"),
    ],
)
def test_what_has_no_distance_is_reported(tmp_path, sides, reason):
    ghost = '<geom name="ghost" size=".1" contype="0" conaffinity="0"/>'
    text = FILE.replace("</worldbody>", f'<body name="shade">{ghost}</body></worldbody>')
    (tmp_path / "file.xml").write_text(text.format(f"<distance {sides}/>"))
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        (lost,) = scene.ignored.that_matter
        assert (lost.element, lost.consequence) == ("sensor/distance", "there is no such sensor")
        assert reason in lost.reason
        assert not scene.sensors


def test_a_world_without_geoms_has_no_distance(tmp_path):
    body, sensor = '<body name="b"><geom size=".1"/></body>', '<distance body1="b" body2="world"/>'
    text = f"<mujoco><worldbody>{body}</worldbody><sensor>{sensor}</sensor></mujoco>"
    (tmp_path / "file.xml").write_text(text)
    with World() as world:
        (lost,) = world.load(tmp_path / "file.xml").ignored.that_matter
    assert "the world has no geoms" in lost.reason


def test_geoms_that_do_not_collide_do_not_count(tmp_path):
    ghost = '<geom size=".9" contype="0" conaffinity="0"/><geom name="box"'
    text = FILE.replace('<geom name="box"', ghost)
    (tmp_path / "file.xml").write_text(text.format('<distance body1="a" body2="b" cutoff="9"/>'))
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        (lost,) = scene.ignored.that_matter
        assert lost.consequence == "geoms of a body that do not collide do not count"
        assert_allclose(shown(scene), CASES["bodies"][1][:1], atol=2e-5)


@pytest.mark.parametrize(
    ("sensor", "problem"),
    [
        ('<distance geom1="ball"/>', "it needs geom2 or body2"),
        ('<normal body2="a"/>', "it needs geom1 or body1"),
        ('<fromto geom1="ball" geom2="ball"/>', "both sides are 'ball'"),
        ('<distance geom1="ball" body1="a" geom2="box"/>', "only one of geom1, body1"),
        ('<distance geom1="no" geom2="box"/>', "no such geom, body or site 'no'"),
        ('<distance geom1="ball" geom2="box" cutoff="-1"/>', "cutoff of 0 or more"),
    ],
)
def test_mistakes_in_sensors_of_distance_are_named(tmp_path, sensor, problem):
    with World() as world, pytest.raises(DescriptionError, match=f"file.xml:.*{problem}"):
        load(world, tmp_path, sensor)


def test_mistakes_in_given_sensors_of_distance_are_named(tmp_path):
    with pytest.raises(TypeError, match="Distance needs a shape, a link or a subtree, and"):
        Distance(shape="box")
    with pytest.raises(TypeError, match="only one of shape, link, subtree"):
        DistanceNormal(shape="box", link="b", other_link="a")
    with World() as world:
        scene = load(world, tmp_path)
        for sensor, problem in (
            (Distance(shape="no", other_link="a"), "no collision shape 'no'"),
            (Distance(link="a", other_link="no", other_body="b"), "no link 'no'"),
            (Distance(link="a", other_shape="ball"), "a shape in common"),
            (Distance(shape="ball", other_subtree="a"), "a shape in common"),
            (Distance(shape="ball", other_shape="ball"), "a shape in common"),
            (Distance(shape="ball", other_link="b", other_body="b", reach=-1.0), "reach of 0 or more"),
        ):
            with pytest.raises(DescriptionError, match=problem):
                scene["a"].add_sensor("s", sensor)
