"""Linearised steps with contacts whose motion is measured, beside central differences."""

import numpy as np
import pytest
from tests.linearization.scenes import ASSETS, assert_exact, new_world, set_velocity
from tests.linearization.test_yielding_contacts import SOFT, of_file

from carom import Worlds

TIP = '<mesh name="tip" vertex="0 0 -.1 .1 .02 .1 -.1 .03 .1 .01 -.1 .1"/>'
HILLS = (
    '<hfield name="hills" nrow="4" ncol="4" size="1 1 .2 .1" '
    'elevation="0 .4 .1 .6 .3 .9 .2 .5 .1 .7 .4 .2 .6 .1 .8 .3"/>'
)
# Two bodies: the geometry of a lower one, and that of one that falls on it from a height.
PAIRS = {
    "capsule and capsule": ("capsule", ".05 .3", "90 0 0", "capsule", ".04 .2", "0 80 10", 0.15),
    "sphere and capsule": ("capsule", ".05 .3", "80 10 0", "sphere", ".06", "0 0 0", 0.15),
    "capsule and box": ("box", ".2 .1 .1", "40 10 0", "capsule", ".04 .3", "0 85 20", 0.22),
    "sphere and cylinder": ("cylinder", ".1 .3", "80 10 0", "sphere", ".06", "0 0 0", 0.2),
    "cylinder and box": ("box", ".3 .3 .1", "0 0 0", "cylinder", ".05 .2", "30 20 0", 0.4),
    "box and box": ("box", ".3 .1 .1", "40 10 0", "box", ".1 .3 .1", "20 47 0", 0.34),
    "hull and hull": ("mesh", "1", "90 5 10", "mesh", "1", "80 100 70", 0.2),
}


def two_bodies(name: str) -> str:
    """The bodies of a pair, of which the second one falls on the first."""
    *parts, height = PAIRS[name]
    bodies = ""
    for number, (kind, size, euler) in enumerate((parts[:3], parts[3:])):
        geometry = 'mesh="tip"' if kind == "mesh" else f'size="{size}"'
        friction = 1.0 - 0.3 * number
        bodies += (
            f'<body pos="{0.02 * number} {0.03 * number} {1.0 + number * height}"><freejoint/>'
            f'<geom type="{kind}" {geometry} euler="{euler}" friction="{friction}" {SOFT}/></body>'
        )
    return bodies


def fall(world, steps=400):
    """Steps until there is a contact, and on until it is deep enough for central differences."""
    for _ in range(steps):
        if any(name.startswith("contact") for name, _ in world.linearize().rows):
            world.step(3)
            return
        world.step()
    raise AssertionError("nothing touches")


@pytest.mark.parametrize("name", PAIRS)
def test_contacts_without_a_closed_form_are_measured(tmp_path, name):
    rest = f"<asset>{TIP}</asset>"
    world = of_file(tmp_path, two_bodies(name), rest=rest, option='gravity="0 0 0"')
    set_velocity(world.bodies[1], 0.2, -0.1, 0.3, 0.0, 0.1, 0.2)
    set_velocity(world.bodies[2], 0.1, 0.2, -0.1, 0.2, 0.1, -0.6)
    fall(world)
    step = assert_exact(world, parameters=["masses", "friction"])
    assert step.method == "exact"
    assert step.measured
    assert set(step.measured) <= {row for row, _ in step.rows if row.startswith("contact")}


@pytest.mark.parametrize("kind", ["cylinder", "hills"])
def test_a_cylinder_on_a_plane_and_a_ball_on_hills_are_exact(tmp_path, kind):
    geometry = {
        "cylinder": ('type="cylinder" size=".05 .2" euler="30 20 0"', "", 0.25),
        "hills": ('type="sphere" size=".1"', f"<asset>{HILLS}</asset>", 0.45),
    }[kind]
    ground = '<geom type="hfield" hfield="hills" pos="0 0 .1"/>' if kind == "hills" else ""
    body = f'<body name="one" pos=".1 .05 {geometry[2]}"><freejoint/><geom {geometry[0]} {SOFT}/></body>'
    world = of_file(tmp_path, ground + body, rest=geometry[1])
    set_velocity(world.bodies[1], 0.2, -0.1, 0.3, 0.3, 0.1, -0.6)
    fall(world)
    assert_exact(world, parameters=["masses"], steps=2)


def test_worlds_measure_the_contacts_of_each(tmp_path):
    world = of_file(tmp_path, two_bodies("capsule and capsule"), option='gravity="0 0 0"')
    set_velocity(world.bodies[2], 0.1, 0.2, -0.1, 0.2, 0.1, -0.6)
    fall(world)
    worlds = Worlds(world, 3)
    state = worlds._engine.arrays.state.numpy
    state["dof_velocity"][1, 9:12] += 0.01
    state["position"][2, 9] -= 1e-4
    found = worlds.linearize()
    for number in range(3):
        lone = worlds.extract(number).linearize()
        assert np.array_equal(found.A[number], lone.A)
        assert found.measured[number] == lone.measured != ()


def test_edges_of_rigid_boxes_are_measured():
    world = new_world()
    world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.0), fixed_base=True)
    box = world.load_urdf(f"{ASSETS}/cube.urdf", (0.6, 0.0, 1.1), (0.3, 0.2, 0.15, 1.0))
    set_velocity(box, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0)
    measured = 0
    for _ in range(100):
        step = world.linearize()
        if step.measured and not step.at_switch:
            measured += 1
            assert_exact(world)
        world.step()
    assert measured


def test_contacts_that_jump_are_named(tmp_path):
    # The nearest points of parallel capsules are anywhere along both.
    capsule = f'<freejoint/><geom type="capsule" size=".05 .3" euler="0 90 0" {SOFT}/>'
    bodies = f'<body pos="0 0 1">{capsule}</body><body pos="0 0 1.099">{capsule}</body>'
    world = of_file(tmp_path, bodies, option='gravity="0 0 0"')
    with pytest.raises(NotImplementedError, match="contact 0 of capsule and capsule jumps"):
        world.linearize(method="exact")
    assert world.linearize().method == "differences"
