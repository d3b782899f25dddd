"""Surfaces of single shapes that differ from world to world: each world is the one that has them alone."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.worlds.same_bits import assert_same_bits

from carom import World, Worlds

SLEDGE = """<mujoco><worldbody><geom type="plane" size="5 5 .1" friction=".05 .01 .001"/>
<body name="sledge" pos="0 0 .1"><freejoint/>
<geom name="left" type="sphere" size=".1" pos="0 .3 0" condim="6"/>
<geom name="right" type="sphere" size=".1" pos="0 -.3 0" condim="6"/>
<geom name="back" type="sphere" size=".1" pos="-.3 0 0"/></body></worldbody></mujoco>"""
VALUES = [0.1, 0.4, 0.9]


@pytest.fixture
def scene(tmp_path) -> World:
    """A sledge on three balls that turns and slides, between surfaces whose friction is the product."""
    (tmp_path / "sledge.xml").write_text(SLEDGE)
    world = World()
    world.load(tmp_path / "sledge.xml").apply_options()
    world["sledge"].set_base_velocity((1.0, 0.4, 0.0), (0.0, 0.0, 2.0))
    return world


@pytest.mark.parametrize("name", ["friction", "rolling_friction", "spinning_friction", "restitution"])
def test_each_world_is_the_one_that_has_the_surface_alone(scene: World, name: str) -> None:
    worlds = Worlds(scene, len(VALUES))
    shape = worlds["sledge"].shapes["left"]
    before = {it.name: getattr(it, name).tolist() for it in worlds["sledge"].shapes}
    setattr(shape, name, VALUES)
    assert_allclose(getattr(shape, name), VALUES, rtol=0.0)
    others = {it.name: getattr(it, name).tolist() for it in worlds["sledge"].shapes if it.name != "left"}
    assert others == {it: before[it] for it in others}
    worlds.step(80)
    ends = []
    for number, value in enumerate(VALUES):
        lone = scene.copy()
        setattr(lone["sledge"].shapes["left"], name, value)
        lone.step(80)
        assert_same_bits(worlds, number, lone)
        ends.append(tuple(lone["sledge"].links[-1].pose.position))
    if name == "friction":
        assert len(set(ends)) == len(VALUES)


def test_some_worlds_keep_theirs(scene: World) -> None:
    worlds = Worlds(scene, 3)
    shapes = worlds["sledge"].shapes
    assert [it.name for it in shapes] == ["left", "right", "back"]
    assert (shapes[1].index, shapes[1].link.index) == (1, -1)
    shapes["right"].change(where=[True, False, True], friction=[0.1, 0.3], restitution=0.2)
    assert_allclose(shapes["right"].friction, [0.1, 1.0, 0.3])
    assert_allclose(shapes["right"].restitution, [0.2, 0.0, 0.2])
    shapes["right"].friction = 0.7
    assert_allclose(worlds.extract(1)["sledge"].shapes["right"].friction, 0.7)
    with pytest.raises(ValueError, match="friction must not be negative"):
        shapes["right"].change(restitution=0.5, friction=-1.0)
    with pytest.raises(ValueError, match="friction"):
        shapes["right"].friction = [0.1, 0.2]
    with pytest.raises(ValueError, match="friction"):
        shapes["right"].friction = np.nan
    with pytest.raises(TypeError, match="no parameter 'stickiness'; they have friction"):
        shapes["right"].change(stickiness=1.0)
    assert_allclose(shapes["right"].restitution, [0.2, 0.0, 0.2])
    with pytest.raises(KeyError, match="no shape is called 'middle'"):
        shapes["middle"]
