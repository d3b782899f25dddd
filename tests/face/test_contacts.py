"""Contacts as readable records: bodies, links and shapes by name, by any handle, in one world and in many."""

from __future__ import annotations

import numpy as np
import pytest

from carom import Body, World, Worlds

STOOL = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 .1"/>
    <body name="stool" pos="0 0 .2"><freejoint/>
      <geom name="seat" type="box" size=".2 .2 .02" mass="1"/>
      <geom name="left" type="sphere" size=".05" pos="-.15 0 -.15" mass=".1"/>
      <geom name="right" type="sphere" size=".05" pos=".15 0 -.15" mass=".1"/>
      <geom name="back" type="sphere" size=".05" pos="0 .15 -.15" mass=".1"/>
      <geom name="front" type="sphere" size=".05" pos="0 -.15 -.15" mass=".1"/>
    </body>
  </worldbody>
</mujoco>
"""


def standing() -> tuple[World, Body]:
    world = World()
    world.load(STOOL)
    world.step(200)
    return world, world["stool"]


def test_records_name_bodies_links_and_shapes() -> None:
    world, stool = standing()
    found = world.contacts("stool")
    assert {contact.shape_a.name for contact in found if contact.shape_a} == {
        "left",
        "right",
        "back",
        "front",
    }
    for contact in found:
        assert (contact.body_a, contact.a.name) == (stool, "stool")
        assert contact.shape_a is not None
        assert contact.shape_b is not None
        assert contact.shape_b.name == "floor"
        np.testing.assert_allclose(contact.position, 0.5 * (contact.point_on_a + contact.point_on_b))
        foot = stool.pose.apply(contact.shape_a.frame.position)
        np.testing.assert_allclose(contact.position[:2], foot[:2], atol=1e-3)
        assert "<Contact of 'stool/stool' and " in repr(contact)
    # Seen from the other side.
    (floor,) = {contact.b for contact in found}
    for contact in world.contacts(floor, stool):
        assert contact.shape_a is not None
        assert contact.shape_a.name == "floor"
    weight = stool.mass * 9.81
    assert world.force_between(stool)[2] == pytest.approx(weight, rel=1e-2)


def test_many_worlds_take_any_handle() -> None:
    world, stool = standing()
    worlds = Worlds(world, 2)
    worlds.step()
    (floor,) = {contact.b for contact in world.contacts(stool)}
    wanted = worlds.contacts("stool")
    for a, b in (
        (stool, floor.body),
        (worlds[stool], worlds[floor.body]),
        (stool.base, floor),
        (worlds[stool].base, worlds[floor.body].links[floor.index]),
        (stool.id, floor.body.id),
    ):
        found = worlds.contacts(a, b)
        assert found.number.tolist() == wanted.number.tolist() == [4, 4]
        np.testing.assert_array_equal(found.forces, wanted.forces)
        np.testing.assert_allclose(worlds.force_between(a, b), wanted.forces, rtol=1e-9)


def test_forces_are_opposite_seen_from_the_other_side() -> None:
    world = World(gravity=(0.0, 0.0, -9.81))
    floor = world.add_plane()
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=1.0)
    box.velocity = (1.0, 0.5, 0.0), (0.0, 0.0, 0.0)
    world.step(10)
    on_box, on_floor = world.force_between(box, floor), world.force_between(floor, box)
    assert on_box[0] < -1.0
    assert on_box[1] < -0.5
    np.testing.assert_allclose(on_floor, -on_box, rtol=1e-12)
    for one, other in zip(world.contacts(box), world.contacts(floor), strict=True):
        np.testing.assert_allclose(one.force, -other.force, rtol=1e-12)
    worlds = Worlds(world, 1)
    np.testing.assert_allclose(worlds.force_between(box, floor)[0], on_box, rtol=1e-9)
    np.testing.assert_allclose(worlds.force_between(floor, box)[0], on_floor, rtol=1e-9)
