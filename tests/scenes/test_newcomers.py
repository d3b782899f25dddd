"""What newcomers type first works, or fails with a sentence that says what to type."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom import Body, World, Worlds
from carom.description.pose import Pose
from carom.errors import StateError
from carom.scene.joints import JointGroup


@pytest.fixture
def world() -> World:
    world = World(gravity=(0.0, 0.0, -9.81))
    world.add_plane()
    return world


@pytest.fixture
def arm(world: World) -> Body:
    return world.load("franka_panda/panda.urdf", fixed_base=True)["panda"]


def test_a_world_is_made_with_its_gravity_and_time_step():
    world = World(0.002, gravity=(0.0, 0.0, -3.7))
    assert (world.time_step, *world.gravity) == (0.002, 0.0, 0.0, -3.7)
    world.time_step = 0.01
    world.step(2)
    assert world.time == pytest.approx(0.02)
    for wrong in (0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="time_step must be finite and > 0"):
            World(wrong)
        with pytest.raises(ValueError, match="time_step must be finite and > 0"):
            world.time_step = wrong
    assert world.time_step == 0.01


def test_bodies_are_found_by_name_number_and_handle(world: World, arm: Body):
    assert world["panda"] is world[1] is world[arm] is arm
    assert [*world] == [world["plane"], arm]
    assert "panda" in world and arm in world and 1 in world
    assert "kuka" not in world and 7 not in world and None not in world
    other = World().load("r2d2.urdf")[0]
    assert world[-1] is arm
    for key in ("kuka", 7, -3, other):
        with pytest.raises(KeyError, match=r"the world has 0 \('plane'\), 1 \('panda'\)"):
            world[key]
        with pytest.raises(KeyError):
            world.remove(key)
    world.remove("panda")
    world.remove(world["plane"])
    assert not [*world]


def test_bodies_of_worlds_are_found_in_the_same_ways(world: World, arm: Body):
    box = world.add_box((0.1, 0.1, 0.1), (1.0, 0.0, 0.1))
    worlds = Worlds(world, 2)
    worlds.step(20)
    batch = worlds["panda"]
    assert worlds[arm] is worlds[1] is worlds[batch] is batch
    wanted = worlds.contacts(box).forces
    assert wanted[0, 2] != 0.0
    for key in ("box", box.id, worlds["box"]):
        assert np.array_equal(worlds.contacts(key, "plane").forces, wanted)
    with pytest.raises(KeyError, match="there is no body 'kuka'"):
        worlds["kuka"]


def test_a_world_that_was_left_says_so():
    with World() as world:
        world.add_plane()
    for use in (world.step, world.add_plane, world.__enter__, lambda: world.load("r2d2.urdf")):
        with pytest.raises(StateError, match="end of its `with` block"):
            use()


def _names(group: object) -> list[str]:
    assert isinstance(group, JointGroup)
    return group.names


def test_joints_are_chosen_in_groups(world: World, arm: Body):
    several = arm.joints[:7]
    assert several.names == [f"panda_joint{number}" for number in range(1, 8)]
    assert (
        arm.joints[["panda_finger*"]].names
        == _names(arm.joints["panda_finger*"])
        == ["panda_finger_joint1", "panda_finger_joint2"]
    )
    pair = arm.joints[["panda_joint2", 5, "*finger_joint1"]]
    assert pair.names == ["panda_joint2", "panda_joint6", "panda_finger_joint1"]
    for wrong, kind in (("panda_leg*", KeyError), ([99], IndexError), ([0, "panda_joint1"], ValueError)):
        with pytest.raises(kind, match=r"panda_joint1|out of range"):
            arm.joints[wrong]
    with pytest.raises(
        TypeError, match=r"a link is found by its number, its name or its handle, not by 1\.5"
    ):
        arm.links[1.5]  # pyright: ignore[reportCallIssue, reportArgumentType]


def test_a_group_sets_its_joints_and_no_others(world: World, arm: Body):
    alone, grouped = world.copy(), world
    pair = grouped["panda"].joints[["panda_joint2", "panda_joint6"]]
    single = [alone["panda"].joints[name] for name in pair.names]
    pair.positions = (0.3, 1.2)
    pair.velocities = (0.1, -0.2)
    pair.set_position_targets((0.5, 1.0), gains=(0.2, 0.3), max_forces=80.0)
    for joint, place, rate, target, gain in zip(
        single, (0.3, 1.2), (0.1, -0.2), (0.5, 1.0), (0.2, 0.3), strict=True
    ):
        joint.position = place
        joint.velocity = rate
        joint.set_position_target(target, gain=gain, max_force=80.0)
    assert np.array_equal(grouped.position, alone.position)
    assert np.array_equal(grouped.velocity, alone.velocity)
    assert np.array_equal(grouped.motor, alone.motor)
    pair.set_torques((3.0, 4.0))
    for joint, torque in zip(single, (3.0, 4.0), strict=True):
        joint.set_torque(torque)
    assert np.array_equal(grouped.joint_torque, alone.joint_torque)
    grouped.step(5)
    alone.step(5)
    assert np.array_equal(grouped.position, alone.position)
    assert np.array_equal(pair.motor_torques, [joint.motor_torque for joint in single])
    pair.free()
    for joint in single:
        joint.free()
    assert np.array_equal(grouped.motor, alone.motor)
    assert np.array_equal(grouped.pd, alone.pd)
    assert np.array_equal(np.transpose(pair.limits), [joint.limits for joint in single])
    with pytest.raises(ValueError, match=r"the movable joints of 'panda' are panda_joint2, panda_joint6$"):
        pair.set_position_targets((1.0, 2.0, 3.0))


def test_all_joints_can_be_put_somewhere(arm: Body):
    wanted = np.linspace(-0.3, 0.3, 9)
    arm.joints.velocities = 0.5
    arm.joints.positions = wanted
    assert np.array_equal(arm.joints.positions, wanted)
    assert np.array_equal(arm.joints.velocities, np.full(9, 0.5))
    with pytest.raises(ValueError, match="position must be finite"):
        arm.joints[0].position = float("nan")
    with pytest.raises(ValueError, match="is fixed: it has 0 degrees of freedom"):
        arm.joints["panda_joint8"].position = 1.0


def test_poses_are_of_the_link_frame(world: World):
    # Its centre of mass is beside its link frame, and turned.
    body = world.load("kuka_iiwa/model.urdf", (0.3, 0.2, 0.1), (0.0, 0.6, 0.0, 0.8), fixed_base=True)[0]
    before = world.position.copy()
    body.pose = body.pose
    body.set_pose(body.links.base.pose)
    assert np.array_equal(world.position, before)
    body.pose = (1.0, 2.0, 3.0), (0.0, 0.0, 2.0, 0.0)
    assert body.pose.position == pytest.approx([1.0, 2.0, 3.0])
    assert body.links[-1].pose.orientation == pytest.approx([0.0, 0.0, 1.0, 0.0])
    body.pose = Pose((0.5, 0.0, 0.0))
    assert body.pose.position == pytest.approx([0.5, 0.0, 0.0])
    for wrong in (((0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), ((0.0, 0.0, 0.0), (0.0,) * 4)):
        with pytest.raises(ValueError, match=r"position must have shape|other than 0"):
            body.pose = wrong
    worlds = Worlds(world, 3)
    batch = worlds[body]
    held = batch.base_inertial_poses.copy()
    batch.pose = batch.pose
    assert np.array_equal(batch.base_inertial_poses, held)
    assert np.allclose(batch.pose.array, body.links.base.pose.array)
    batch.set_pose((0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0), where=[1])
    assert np.allclose(batch.pose.array[1], (0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0))
    assert np.array_equal(batch.base_inertial_poses[[0, 2]], held[[0, 2]])
    assert np.allclose(worlds.extract(1)[body.id].pose.position, (0.0, 1.0, 0.0))


def test_contacts_are_records(world: World):
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), mass=2.0, name="cube")
    world.step(240)
    found = world.contacts("cube", "plane")
    assert len(found) >= 2
    assert {(contact.a.body, contact.b.body.name) for contact in found} == {(box, "plane")}
    assert np.allclose(found[0].normal, (0.0, 0.0, 1.0))
    assert sum(contact.normal_force for contact in found) == pytest.approx(2.0 * 9.81, rel=1e-3)
    assert np.allclose(world.force_between(box, 0), (0.0, 0.0, 2.0 * 9.81), rtol=1e-3, atol=1e-3)
    assert np.allclose(world.force_between("plane", box.links[-1]), -world.force_between(box), atol=1e-9)
    assert len(world.contacts()) == len(world.contacts(box.links[-1])) == len(found)
    assert world.contacts(box, box) == []
    with pytest.raises(KeyError, match="there is no body 'ball'"):
        world.contacts("ball")
    with pytest.raises(AttributeError, match=r"world\.contacts\(a, b\)"):
        world.queries().contacts  # noqa: B018


def test_sliding_is_in_the_force(world: World):
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=0.5)
    world.step(60)
    box.set_base_velocity((2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step()
    force = world.force_between(box)
    assert -force[0] == pytest.approx(0.25 * force[2], rel=0.05)
    friction = sum(contact.friction for contact in world.contacts(box))
    assert np.allclose(force - friction, (0.0, 0.0, force[2]))


def test_constraints_are_named(world: World):
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 2.0))
    other = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 1.5))
    world.constrain_links("fixed", box, child_frame=Pose((0.0, 0.0, 2.0)))
    world.constrain_links("point", box, "base", other, "base", parent_frame=Pose((0.0, 0.0, -0.5)))
    world.step(240)
    assert box.pose.position == pytest.approx([0.0, 0.0, 2.0], abs=1e-3)
    assert other.pose.position == pytest.approx([0.0, 0.0, 1.5], abs=1e-2)
    for wrong in ("weld", 99, 0):
        with pytest.raises(ValueError, match="expected one of fixed, point, slide, gear"):
            world.constrain_links(wrong, box)  # pyright: ignore[reportArgumentType]
    with pytest.raises(KeyError, match="no link is called 'lid'; there are base"):
        world.constrain_links("fixed", box, "lid")
    with pytest.raises(IndexError, match="link 3 is out of range"):
        world.constrain_links("fixed", box, -1, other, 3)
    world.step()


def test_modules_are_there_after_import_carom():
    assert carom.viewer.Viewer
    assert carom.algorithms.jacobian
    assert carom.controllers.LQR
    assert {"algorithms", "controllers", "viewer", "vector"} <= {*dir(carom)}
    with pytest.raises(AttributeError, match="has no attribute 'Worlsd'; did you mean 'World'"):
        carom.Worlsd  # pyright: ignore[reportAttributeAccessIssue] # noqa: B018
