"""Contact points of MJCF files: MuJoCo 4.0's, by its `mj_forward` on the same files."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom.errors import DescriptionError

FLOOR = '<geom type="plane" size="1 1 1"/>'
TERRAIN = '<asset><hfield name="h" nrow="3" ncol="3" size="1 1 .5 .1" elevation="0 0 0 0 1 0 0 0 0"/></asset>'
# A file, and of each point its place, the distance there, and the size of the first shape's normal along z.
POINTS: dict[str, tuple[str, list[tuple[float, ...]]]] = {
    "crossed edges of boxes": (
        '<mujoco><worldbody><geom type="box" size=".1 .1 .1" euler="0 45 0"/>'
        '<body pos="0 0 .281" euler="45 0 0"><freejoint/><geom type="box" size=".1 .1 .1"/></body>'
        "</worldbody></mujoco>",
        [(0.0, 0.0, 0.1405, -0.0018427, 1.0)],
    ),
    "ellipsoid on a plane": (
        f'<mujoco><worldbody>{FLOOR}<body pos="0 0 .0995" euler="0 0 20"><freejoint/>'
        '<geom type="ellipsoid" size=".3 .2 .1"/></body></worldbody></mujoco>',
        [(0.0, 0.0, -0.00025, -0.0005, 1.0)],
    ),
    "ball on terrain": (
        f'<mujoco>{TERRAIN}<worldbody><geom type="hfield" hfield="h"/><body pos=".3 .2 .45"><freejoint/>'
        '<geom type="sphere" size=".1"/></body></worldbody></mujoco>',
        [(0.257639, 0.2, 0.365279, -0.0105573, 0.894427)],
    ),
    "capsule on a cylinder": (
        '<mujoco><worldbody><geom type="cylinder" size=".5 .1" pos="0 0 -.1"/>'
        '<body pos="0 0 .0495" euler="90 0 20"><freejoint/><geom type="capsule" size=".05 .1"/></body>'
        "</worldbody></mujoco>",
        [(0.0, -0.1, -0.00025, -0.0005, 1.0), (0.0, 0.1, -0.00025, -0.0005, 1.0)],
    ),
}


@pytest.mark.parametrize("name", POINTS)
def test_points_are_those_of_mujoco(name: str) -> None:
    text, expected = POINTS[name]
    world = carom.World()
    world.load(text)
    world.step()
    found = [
        (*np.round(contact.position, 9), contact.distance, abs(contact.normal[2]))
        for contact in world.contacts()
        if contact.distance < 0.0
    ]
    np.testing.assert_allclose(sorted(found), sorted(expected), atol=2e-6)


def test_wide_margins_push_small_shapes_from_afar() -> None:
    geom = '<geom size=".02" margin=".3"/>'
    bodies = "".join(f'<body pos="0 0 {0.25 * i}"><freejoint/>{geom}</body>' for i in range(2))
    world = carom.World()
    world.load(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    world.step()
    assert [contact.distance for contact in world.contacts()] == pytest.approx([0.21])
    assert world.bodies[0].velocity.linear[2] == pytest.approx(-0.99462)


def test_margins_of_one_of_several_shapes_of_a_body_push() -> None:
    def pair(margin: float) -> str:
        return (
            f'<freejoint/><geom size=".02" pos=".05 0 0" margin="{margin}"/><geom size=".02" pos="-.05 0 0"/>'
        )

    world = carom.World()
    bodies = f'<body>{pair(0.1)}</body><body pos="0 0 .12">{pair(0.02)}</body>'
    world.load(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    world.step()
    assert [contact.distance for contact in world.contacts()] == pytest.approx([0.08])
    speeds = [(body.velocity.linear[2], body.velocity.angular[1]) for body in world.bodies]
    expected = [(-0.07245018867924524, 0.9930486593843103), (0.03321018867924538, -0.9930486593843103)]
    np.testing.assert_allclose(speeds, expected, rtol=1e-9)


def test_what_is_fixed_in_the_world_has_no_contacts() -> None:
    fixed = '<body name="a"><geom type="box" size=".1 .1 .1"/><body name="b"><geom size=".2"/></body></body>'
    lever = '<body name="lever" pos="0 0 .1"><joint type="hinge"/><geom size=".2"/></body>'
    world = carom.World()
    world.load(f"<mujoco><worldbody>{FLOOR}{fixed}{lever}</worldbody></mujoco>")
    world.step()
    names = {frozenset((contact.a.name, contact.b.name)) for contact in world.contacts()}
    assert names
    assert all("lever" in pair for pair in names)


def test_blank_attributes_state_nothing() -> None:
    world = carom.World()
    scene = world.load(
        '<mujoco><default><geom rgba="1 0 0 1"/></default><worldbody><body name="a"><joint range=""/>'
        '<geom size=".1" rgba="" friction="" pos=""/></body></worldbody></mujoco>'
    )
    assert not scene.ignored
    assert world["a"].shapes[0].colour.tolist() == [1.0, 0.0, 0.0, 1.0]
    with pytest.raises(DescriptionError):
        world.load('<mujoco><worldbody><body><geom size=".1" type=""/></body></worldbody></mujoco>')
