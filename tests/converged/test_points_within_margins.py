"""Contacts of MuJoCo's law are points within margins of shapes; rigid ones are found before they touch."""

from __future__ import annotations

import pytest

from carom import World

_SCENE = """<mujoco><worldbody>
  <geom type="plane" size="1 1 .1"/>
  <body pos="0 0 {height}"><freejoint/><geom {shape} margin="{margin}"/></body>
</worldbody></mujoco>"""
_SHAPES = {
    "box": ('type="box" size=".1 .1 .1"', 0.1),
    "ball": ('type="sphere" size=".1"', 0.1),
    "capsule": ('type="capsule" size=".05 .1" euler="0 90 0"', 0.05),
    "cylinder": ('type="cylinder" size=".1 .1"', 0.1),
}


@pytest.mark.parametrize("law", ["compliant", "bullet"])
@pytest.mark.parametrize("name", _SHAPES)
def test_shapes_apart_have_contacts_within_their_margin_only(name: str, law: str) -> None:
    shape, half = _SHAPES[name]
    for margin, there in ((0.0, False), (0.002, False), (0.006, True)):
        world = World(contact=law)
        world.load(_SCENE.format(height=half + 0.004, shape=shape, margin=margin))
        world.gravity = (0.0, 0.0, 0.0)
        world.step()
        assert bool(world.contacts()) == there


def test_rigid_contacts_are_found_before_they_touch() -> None:
    world = World()
    world.add_plane()
    box = world.add_box((0.1, 0.1, 0.1), mass=1.0, position=(0.0, 0.0, 0.1005))
    world.gravity = (0.0, 0.0, 0.0)
    world.step()
    assert [contact.distance for contact in world.contacts(box)] == pytest.approx([0.0005] * 4)
