"""Poses, starts, questions, vectors: what a world answers in one call, and many worlds as well."""

from __future__ import annotations

import numpy as np
import pytest
from tests.face.scene import made

import carom
from carom import Camera, Pose, World, Worlds, algorithms

TURN = np.array((0.1, -0.5, 0.3, 0.8)) / np.sqrt(0.99)


def test_texts_are_loaded_with_their_assets() -> None:
    world = World()
    text = '<mujoco><asset><mesh name="m" file="a/b.obj"/></asset><worldbody><body name="r"><freejoint/>'
    text += '<geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    scene = world.load((text, {"a/b.obj": corners}))
    assert world["r"].mass == pytest.approx(1000 / 6)
    assert list(scene.description.meshes) == ["m"]
    urdf = '<?xml version="1.0"?>\n<!-- <mujoco> -->\n<robot name="u"><link name="l"/></robot>'
    assert world.load(urdf).format == "URDF"
    with pytest.raises(ValueError, match="named relative to the text"):
        world.load((text, {"../b.obj": corners}))
    with pytest.raises(carom.errors.DescriptionError, match=r"b\.obj"):
        world.load(text)
    assert len(world.bodies) == 2


def test_poses_are_multiplied_inverted_and_applied() -> None:
    a, b = Pose((1.0, 2.0, 3.0), TURN), Pose((0.3, -0.1, 0.2), (0.0, 0.6, 0.0, 0.8))
    both = a * b
    np.testing.assert_allclose(both.matrix, a.matrix @ b.matrix, atol=1e-12)
    np.testing.assert_allclose(a.inverse().matrix, np.linalg.inv(a.matrix), atol=1e-12)
    points = np.arange(12.0).reshape(4, 3)
    np.testing.assert_allclose(both.apply(points), points @ both.rotation.T + both.position, atol=1e-12)
    np.testing.assert_allclose((a.inverse() * a).array, [0, 0, 0, 0, 0, 0, 1], atol=1e-12)
    many = Pose(np.tile(a.position, (5, 1)), np.tile(a.quaternion, (5, 1)))
    np.testing.assert_allclose((many * b).matrix, np.tile(both.matrix, (5, 1, 1)), atol=1e-12)
    assert Pose().array.tolist() == [0, 0, 0, 0, 0, 0, 1]
    with pytest.raises(ValueError, match="read-only"):
        Pose().position[0] = 1.0


def test_a_body_is_put_where_a_pose_says_in_one_world_and_in_some() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 3)
    wanted = Pose((1.0, 0.5, 2.0), TURN)
    box.pose = wanted
    worlds[box].set_pose(wanted, where=[1])
    np.testing.assert_allclose(box.pose.array, wanted.array, atol=1e-12)
    np.testing.assert_allclose(worlds[box].pose.array[1], wanted.array, atol=1e-12)
    np.testing.assert_allclose(worlds[box].pose.position[[0, 2]], [(1.0, 0.0, 0.5)] * 2)
    box.velocity = (1.0, 0.0, 0.0), (0.0, 0.0, 2.0)
    worlds[box].set_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 2.0), where=[1])
    for one, many in zip(box.velocity, worlds[box].velocity, strict=True):
        np.testing.assert_allclose(many[1], one, atol=1e-12)
        assert not many[0].any()
    assert worlds[box].mass == pytest.approx([box.mass] * 3)
    assert worlds[arm].com[0] == pytest.approx(arm.com)
    assert arm.com == pytest.approx(algorithms.center_of_mass(arm, arm.joints.positions), abs=1e-9)
    assert [shape.name for shape in arm.links["hand"].shapes] == ["lower"]
    assert [shape.name for shape in worlds[arm].links["hand"].shapes] == ["lower"]


def test_links_are_pushed_as_in_a_lone_world() -> None:
    world, _, box = made()
    worlds = Worlds(world, 2)
    box.pose = worlds[box].pose = Pose((0.0, 0.0, 3.0), TURN)
    for one, many in ((box.base, worlds[box].base),):
        for link in (one, many):
            link.apply_force((1.0, 2.0, 3.0), (0.1, 0.2, 0.0), frame="link")
            link.apply_torque((0.1, 0.0, 0.2), frame="link")
    world.step()
    worlds.step()
    assert worlds[box].pose.array[1] == pytest.approx(box.pose.array, abs=1e-12)
    with pytest.raises(ValueError, match="frame must be 'world' or 'link'"):
        worlds[box].base.apply_force((1.0, 0.0, 0.0), frame="hand")  # type: ignore[arg-type]


def test_a_world_goes_back_to_its_start_a_set_one_and_a_keyframe() -> None:
    world, arm, box = made()
    before = world.position.copy()
    world.reset()
    world.step(30)
    world.reset()
    assert (world.time, world.position.tolist()) == (0.0, before.tolist())
    world.step(30)
    moved = world.position.copy()
    world.set_start()
    world.step(30)
    world.reset()
    assert np.array_equal(world.position, moved)
    world.reset("up")
    assert arm.joints.positions.tolist() == [1.0, 0.5]
    assert box.pose.position[2] == 0.7
    with pytest.raises(KeyError, match="no body has a keyframe 'down'; there are 'up'"):
        world.reset("down")
    # Another body, another start.
    world.add_sphere(0.1, (0, 0, 5), mass=1.0, name="ball")
    world.step(5)
    world.reset()
    assert world["ball"].pose.position[2] == 5.0
    world.clear()
    assert not world.bodies


def test_worlds_go_back_to_their_start_those_that_are_said() -> None:
    world, arm, _ = made()
    world.step(10)
    worlds = Worlds(world, 3)
    before = worlds[arm].joints.positions.copy()
    worlds.step(20)
    worlds.reset(where=[0, 2])
    assert np.array_equal(worlds[arm].joints.positions[[0, 2]], before[[0, 2]])
    assert not np.array_equal(worlds[arm].joints.positions[1], before[1])
    assert worlds.time == pytest.approx([0.04, 0.12, 0.04])
    worlds.set_start()
    worlds.step(20)
    worlds.reset()
    assert worlds.time == pytest.approx([0.04, 0.12, 0.04])
    worlds.reset("up", where=[False, True, False])
    assert worlds[arm].joints.positions[1].tolist() == [1.0, 0.5]


def test_controls_and_sensors_of_all_bodies_are_named_vectors() -> None:
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    world.controls = (0.5, -1.0)
    assert arm.actuators["bend"].control == 0.5
    assert world.controls.names == ["bend", "turn"]
    assert (world.controls.lower.tolist(), world.controls.upper.tolist()) == ([-1.0, -5.0], [1.0, 5.0])
    worlds.controls = [(0.5, -1.0), (0.0, 0.0)]
    assert worlds.controls.tolist() == [[0.5, -1.0], [0.0, 0.0]]
    for each in (world, worlds):
        each.step(20)
        with pytest.raises(ValueError, match="read-only"):
            each.controls[..., 0] = 1.0
        with pytest.raises(ValueError, match="one number or 2 of them"):
            each.controls = (1.0, 2.0, 3.0)
    assert world.sensors.names == ["rate[0]", "rate[1]", "rate[2]", "angle"]
    assert world.sensors[world.sensors.slices["angle"]] == arm.joints["elbow"].position
    np.testing.assert_array_equal(worlds.sensors[0], world.sensors)
    world.controls = 0.25
    assert world.controls.tolist() == [0.25, 0.25]


def test_rays_nearest_points_overlaps_and_images_name_links() -> None:
    world, arm, box = made()
    hit = world.ray((1.0, 0.0, 3.0), (1.0, 0.0, -1.0))
    assert hit is not None
    assert hit.body is box
    assert (hit.link.name, hit.distance) == ("box", pytest.approx(2.4))
    assert hit.normal == pytest.approx([0, 0, 1])
    assert world.ray((5.0, 5.0, 3.0), (5.0, 5.0, 1.0)) is None
    found = world.rays([(1.0, 0.0, 3.0), (0.15, 0.0, 3.0), (3.0, 3.0, 3.0)], (0.0, 0.0, -3.0))
    assert found.positions.shape == (3, 3)
    # Straight down they hit what each ray alone does.
    starts = np.array([(1.0, 0.0, 3.0), (0.15, 0.0, 3.0), (3.0, 3.0, 3.0)])
    below = world.rays(starts, starts - (0.0, 0.0, 4.0))
    alone = [world.ray(start, start - (0.0, 0.0, 4.0)) for start in starts]
    assert [world.bodies[body].name for body in below.bodies] == [each and each.body.name for each in alone]
    assert [world.bodies[body] for body in below.bodies[:2]] == [box, arm]
    with pytest.raises(ValueError, match=r"must be \(n, 3\)"):
        world.rays([1.0, 2.0], [3.0, 4.0])
    nearness = world.nearest(arm, box)
    assert nearness[0].distance == min(each.distance for each in nearness)
    assert {nearness[0].a.body, nearness[0].b.body} == {arm, box}
    assert world.nearest(arm.links["hand"], "box", max_distance=0.01) == []
    assert world.nearest(arm.links["hand"], box)[0].a.name == "hand"
    assert [link.name for link in world.overlapping((0.8, -0.1, 0.3), (1.2, 0.1, 0.7))][1:] == ["box"]
    camera = Camera.with_field_of_view(32, 24, 60.0).look_at((2.0, 0.0, 1.0), (1.0, 0.0, 0.5))
    assert np.array_equal(world.image(camera).colour, camera.capture(world).colour)


def test_algorithms_are_methods_of_a_body_for_its_present_state() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 2)
    arm.joints.positions = worlds[arm].joints.positions = (0.3, -0.4)
    arm.joints.velocities = worlds[arm].joints.velocities = (0.5, 0.1)
    box.pose = worlds[box].pose = Pose((1.0, 0.0, 2.0), TURN)
    box.velocity = worlds[box].velocity = (0.3, 0.2, 0.1), (1.0, -2.0, 0.5)
    for body in (arm, box):
        many = worlds[body]
        for name in ("mass_matrix", "inverse_dynamics", "forward_dynamics"):
            np.testing.assert_allclose(
                getattr(many, name)()[1], getattr(body, name)(), atol=1e-9, err_msg=name
            )
        np.testing.assert_allclose(body.forward_dynamics(body.inverse_dynamics(0.5)), 0.5, atol=1e-9) if (
            body is arm
        ) else None
    # Forces and accelerations that are not stated are none.
    for name in ("inverse_dynamics_derivatives", "forward_dynamics", "forward_dynamics_derivatives"):
        ask = getattr(worlds[arm].algorithms, name)
        for stated, left_out in zip(ask(0.0), ask(), strict=True):
            np.testing.assert_array_equal(left_out, stated, err_msg=name)
    for one, other in zip(worlds[arm].jacobian("hand"), arm.jacobian(arm.links["hand"]), strict=True):
        np.testing.assert_allclose(one[0], other, atol=1e-12)
    np.testing.assert_allclose(
        arm.forward_kinematics((0.3, -0.4)), arm.links.poses[: arm.joint_count], atol=1e-9
    )
    np.testing.assert_allclose(worlds[arm].links.poses[0], arm.links.poses, atol=1e-12)


def test_inverse_kinematics_takes_a_pose_and_keeps_the_limits() -> None:
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    arm.joints.positions = (0.4, 0.6)
    wanted = arm.links["hand"].pose
    arm.joints.positions = (0.0, 0.1)
    for target in (wanted, (wanted.position, wanted.quaternion), wanted.array):
        found = arm.inverse_kinematics("hand", target)
        assert found.success
        assert found.positions == pytest.approx((0.4, 0.6), abs=1e-3)
    worlds[arm].joints.positions = (0.0, 0.1)
    many = worlds[arm].inverse_kinematics("hand", wanted)
    assert many.success.all()
    assert many.positions[1] == pytest.approx((0.4, 0.6), abs=1e-3)
    # The shoulder turns by 2 rad at most.
    behind = (-0.3 * np.cos(0.3), 0.0, wanted.position[2] + 0.9)
    for found in (
        arm.inverse_kinematics("hand", behind).positions,
        worlds[arm].inverse_kinematics("hand", behind).positions[0],
    ):
        assert abs(found[0]) <= 2.0 + 1e-9
    assert isinstance(carom.algorithms.inverse_kinematics(arm, ["hand"], [wanted.position]).positions, tuple)


def test_parameters_of_joints_and_actuators_differ_between_worlds() -> None:
    world, arm, _ = made()
    worlds = Worlds(world, 3)
    elbow = worlds[arm].joints["elbow"]
    elbow.damping, elbow.armature = 0.5, (0.1, 0.2, 0.3)
    assert elbow.damping.tolist() == [0.5] * 3
    assert elbow.armature.tolist() == [0.1, 0.2, 0.3]
    bend = worlds[arm].actuators["bend"]
    bend.kp = (10.0, 20.0, 40.0)
    bend.kv = 1.0
    bend.force_range = -1.0, (1.0, 2.0, 3.0)
    worlds.controls = (0.8, 0.0)
    lone = [worlds.extract(number) for number in range(3)]
    worlds.step(40)
    for number, one in enumerate(lone):
        assert one["arm"].actuators["bend"].kp == bend.kp[number]
        one.step(40)
        assert np.array_equal(one["arm"].joints.positions, worlds[arm].joints.positions[number])
    assert bend.force_range[1].tolist() == [1.0, 2.0, 3.0]
    assert World().time_step == pytest.approx(1 / 240)


def test_contacts_of_the_present_coordinates_are_found_without_a_step() -> None:
    world = World()
    floor, ball = world.add_plane(), world.add_sphere(0.1, (0.0, 0.0, 1.0), mass=1.0)
    world.step()
    worlds = Worlds(world, 2)
    ball.pose = (0.0, 0.0, 0.0995), (0.0, 0.0, 0.0, 1.0)
    assert not world.contacts(ball, floor)
    assert [contact.b.body for contact in world.contacts(ball, floor, now=True)] == [floor]
    assert len(world.contacts(ball)) == 1
    worlds[ball].set_pose(ball.pose, where=[1])
    assert worlds.contacts(ball, floor).number.tolist() == [0, 0]
    assert worlds.contacts(ball, floor, now=True).number.tolist() == [0, 1]
    assert world.time == worlds.time[0] == world.time_step


def test_the_state_is_shown_as_flat_arrays() -> None:
    world = World(gravity=(0.0, 0.0, -9.81))
    ball = world.add_sphere(0.1, (1.0, 2.0, 3.0), mass=1.0)
    ball.set_velocity((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))
    state = world.state
    assert state.position.tolist() == [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]
    assert state.velocity.tolist() == [0.4, 0.5, 0.6, 0.1, 0.2, 0.3]
    state.link_force[0, 2] = 9.81
    state.position[2] = 5.0
    world.step()
    assert ball.velocity.linear[2] == pytest.approx(0.3)
    assert state.link_pose.shape == (1, 7)
    np.testing.assert_allclose(ball.pose.position[2], 5.0 + 0.3 * world.time_step)
    world.add_sphere(0.1)
    assert (len(state.position), len(state.velocity), len(state.link_force)) == (14, 12, 2)
    # What they are like is what derivatives and inverse dynamics take.
    assert world.linearize(positions=state.position, velocities=state.velocity).A.shape == (24, 24)
    needed = world.inverse_dynamics(0.0 * state.velocity, positions=state.position).forces
    np.testing.assert_allclose(needed[5], 9.81)


def test_many_worlds_take_links_of_one_world() -> None:
    world, arm, _ = made()
    many, hand = Worlds(world, 2)[arm], arm.links["hand"]
    linear, angular = many.jacobian("hand")
    for link in (hand, many.links["hand"], hand.index):
        np.testing.assert_array_equal(many.jacobian(link), (linear, angular))
        assert many.dynamics(link)["mass"].tolist() == [hand.mass, hand.mass]
    found = many.inverse_kinematics(hand, hand.pose).positions
    np.testing.assert_allclose(found, arm.joints.positions[np.newaxis].repeat(2, axis=0), atol=1e-6)


def test_links_are_found_in_groups_like_joints() -> None:
    world = World()
    arm = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
    arm.joints.movable.positions = np.linspace(-0.3, 0.5, 9)
    many = Worlds(world, 2)[arm]
    for key, names in (
        (slice(2), ["panda_link1", "panda_link2"]),
        (slice(-1, None), ["panda_grasptarget"]),
        ("panda_link[01]", ["panda_link0", "panda_link1"]),
        (["panda_hand", 0, "*left*"], ["panda_hand", "panda_link1", "panda_leftfinger"]),
        ([-1, 2], ["panda_link0", "panda_link3"]),
        (np.array([1, 2]), ["panda_link2", "panda_link3"]),
        ([], []),
    ):  # fmt: skip
        group, groups = arm.links[key], many.links[key]  # type: ignore[call-overload]
        assert group.names == groups.names == names
        wanted = np.array([arm.links[name].pose.array for name in names]).reshape(-1, 7)
        np.testing.assert_array_equal(group.poses, wanted)
        np.testing.assert_allclose(groups.poses, np.tile(wanted, (2, 1, 1)), atol=1e-12)
        assert groups.inertial_poses.shape == (2, *group.inertial_poses.shape)
        assert groups.velocities.shape == (2, len(names), 6) == (2, *group.velocities.shape)
    assert len(arm.links) == 1 + len(arm.links.poses) == 1 + many.links.poses.shape[1]
    for wrong, problem, words in (
        ("nothing*", KeyError, "no link has a name like 'nothing"),
        ([0, "panda_link1"], ValueError, "links are named twice: panda_link1, panda_link1"),
        ([40], IndexError, "link 40 is out of range"),
        (1.5, TypeError, "by its number, its name or its handle, not by 1.5"),
    ):
        for links in (arm.links, many.links):
            with pytest.raises(problem, match=words):
                links[wrong]  # type: ignore[index]


def test_bodies_are_found_by_any_handle_among_all() -> None:
    world, arm, _ = made()
    assert world.bodies["arm"] is world.bodies[arm.id] is world.bodies[arm] is arm
    for wrong in ("leg", 40, World().add_sphere(0.1)):
        with pytest.raises(KeyError, match="there is no body"):
            world.bodies[wrong]


def test_a_keyframe_before_the_first_step_does_not_become_the_start() -> None:
    world, arm, _ = made()
    world.reset("up")
    assert arm.joints.positions.tolist() == [1.0, 0.5]
    world.reset()
    assert arm.joints.positions.tolist() == [0.0, 0.0]


def test_substeps_are_an_argument_and_at_least_one() -> None:
    world = World(substeps=4)
    assert world.substeps == Worlds(world, 2).substeps == world.parameters.substeps == 4
    world.substeps = 1
    with pytest.raises(ValueError, match="substeps must be at least 1, not 0"):
        World(substeps=0)
    assert World().substeps == 1


def test_nearest_points_are_found_in_each_of_many_worlds() -> None:
    world = World()
    arm = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
    box = world.add_box((0.1, 0.1, 0.1), (0.8, 0.0, 0.5), mass=1.0)
    worlds = Worlds(world, 4)
    worlds[box].set_pose(
        np.array([(0.8, 0, 0.5, 0, 0, 0, 1), (1.2, 0.1, 0.9, 0, 0.6, 0, 0.8), (9, 0, 0, 0, 0, 0, 1)]),
        where=[0, 1, 2],
    )
    worlds[box].set_present(False, where=[3])
    found = worlds.nearest(arm, box, 3.0)
    assert found.found.tolist() == [True, True, False, False]
    assert found.distance[2:].tolist() == [np.inf, np.inf]
    assert np.isnan(found.normal[2:]).all()
    for number in (0, 1):
        lone = worlds.extract(number)
        wanted = lone.nearest("panda", box.id)[0]
        # That of one world has edges that are rounded by Bullet's margin.
        np.testing.assert_allclose(found.distance[number], wanted.distance, atol=1e-3)
        np.testing.assert_allclose(found.normal[number], wanted.normal, atol=5e-3)
    apart = found.point_on_a[:2] - found.point_on_b[:2]
    np.testing.assert_allclose(apart, found.distance[:2, np.newaxis] * found.normal[:2], atol=1e-9)
    hand = worlds.nearest(arm.links["panda_hand"], worlds[box].base).distance
    assert (hand[:2] >= found.distance[:2]).all()
