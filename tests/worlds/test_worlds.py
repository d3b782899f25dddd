"""What `Worlds` shows and takes: states, drives, forces, contacts, rays, faults."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from tests.physics.contact_scenes import (
    HALF,
    WEIGHT,
    add_ball,
    add_box,
    add_floor,
    add_plate_on_a_stand,
    earth,
)
from tests.worlds.same_bits import assert_all_same_bits, assert_same_bits

import pybullet_data
from carom import Body, World, Worlds
from carom.description import JointType, Pose
from carom.errors import SimulationWarning
from carom.layouts.codes import MOTOR_MAX_IMPULSE, MOTOR_VELOCITY_CLAMP, PD_MAX_FORCE, UserConstraintKind
from carom.model.body_spec import BodySpec, LinkSpec
from carom.worlds import memory

DATA = pybullet_data.getDataPath()
COUNT = 3


@pytest.fixture
def arm() -> tuple[World, Body]:
    world = earth()
    return world, world.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)


@pytest.fixture
def balls() -> tuple[World, Body, Body]:
    """A floor and two balls over it."""
    world = earth()
    floor = add_floor(world)
    ball = add_ball(world, (0.0, 0.0, HALF))
    add_ball(world, (5.0, 0.0, 3.0))
    return world, floor, ball


def test_views_show_and_take_the_state(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    batch = worlds[panda]
    assert (worlds.count, batch.joints.positions.shape, batch.name) == (COUNT, (COUNT, 9), "panda")
    batch.joints.positions[1, 2] = 0.25
    batch.joints.velocities = np.arange(9.0)
    assert np.shares_memory(batch.joints.positions, batch.joints.positions)
    lone = world.copy()
    lone.bodies[panda.id].joints.reset([0, 0, 0.25, 0, 0, 0, 0, 0, 0], np.arange(9.0))
    worlds.step(10)
    lone.step(10)
    assert_same_bits(worlds, 1, lone)


def test_drives_are_those_of_a_world_alone(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT, threads=2)
    batch = worlds[panda]
    random = np.random.default_rng(1)
    targets, rates, torques = random.uniform(-1, 1, (3, COUNT, 9))
    forces = np.array([[10.0], [50.0], [87.0]])
    lone = [world.copy() for _ in range(COUNT)]
    joints = [one.bodies[panda.id].joints for one in lone]

    batch.joints.set_position_targets(
        targets, gains=0.2, velocities=rates, max_forces=forces, max_velocities=2.0
    )
    for number, each in enumerate(joints):
        each.set_position_targets(
            targets[number],
            gains=0.2,
            velocities=rates[number],
            max_forces=forces[number],
            max_velocities=2.0,
        )
    _step_all(worlds, lone)
    batch.joints[["panda_joint2", 5]].set_velocity_targets(rates[:, :2], gains=0.5)
    for number, each in enumerate(joints):
        each["panda_joint2"].set_velocity_target(rates[number, 0], gain=0.5)
        each[5].set_velocity_target(rates[number, 1], gain=0.5)
    _step_all(worlds, lone)
    batch.joints.free()
    batch.joints.set_torques(torques)
    batch.joints.set_springs(targets, stiffness=20.0, damping=1.0)
    for number, each in enumerate(joints):
        each.free()
        each.set_torques(torques[number])
        for joint, target in zip(each.movable, targets[number], strict=True):
            joint.set_spring(float(target), stiffness=20.0, damping=1.0)
    _step_all(worlds, lone)
    np.testing.assert_array_equal(batch.joints.motor_torques, [each.motor_torques for each in joints])


def _step_all(worlds: Worlds, lone: list[World]) -> None:
    worlds.step(15)
    assert_all_same_bits(worlds, lone, 15)


def test_sensors_and_links(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    batch = worlds[panda]
    batch.joints[["panda_joint4", 6]].enable_sensors()
    batch.joints.positions = np.linspace(0.1, 0.4, COUNT)[:, None]
    lone = worlds.extract(2)
    body = lone.bodies[panda.id]
    body.joints["panda_joint4"].enable_sensor()
    body.joints[6].enable_sensor()
    worlds.step(5)
    lone.step(5)
    np.testing.assert_array_equal(batch.joints.reactions[2], [joint.reaction for joint in body.joints])
    body.update_link_poses()
    rows = slice(body.first_link + 1, body.first_link + 1 + body.joint_count)
    np.testing.assert_array_equal(batch.links.inertial_poses[2], lone.link_pose[rows])
    body.update_link_velocities()
    np.testing.assert_array_equal(batch.links.velocities[2], lone.link_velocity[rows])


def test_sensors_feel_what_links_touch_and_are_tied_to() -> None:
    world = earth()
    plate = add_plate_on_a_stand(world)
    add_box(world, (0.0, -HALF, 1.0 + HALF))
    hanging = add_ball(world, (0.0, 0.0, 0.5))
    frame = Pose((0.0, 0.0, 0.5 - HALF))
    world.constrain_links(UserConstraintKind.POINT_TO_POINT, plate, 0, hanging, -1, child_frame=frame)
    plate.joints[0].enable_sensor()
    worlds = Worlds(world, COUNT, threads=2)
    lone = worlds.extract(2)
    worlds.step(100)
    lone.step(100)
    assert_same_bits(worlds, 2, lone)
    assert (worlds[plate].joints.reactions[:, 0, 2] > 2.5 * WEIGHT).all()


def test_forces_push_links_where_they_act(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    forces = np.array([[0.0, 0.0, 5.0], [3.0, 0.0, 0.0], [0.0, -4.0, 1.0]])
    worlds[panda].links["panda_hand"].apply_force(forces, (0.1, 0.2, 0.9))
    worlds[panda].links[3].apply_force((0.0, 0.0, 1.0))
    worlds[panda].links[3].apply_torque((0.0, 0.2, 0.0))
    lone = [world.copy() for _ in range(COUNT)]
    for number, one in enumerate(lone):
        links = one.bodies[panda.id].links
        links["panda_hand"].apply_force(forces[number], (0.1, 0.2, 0.9))
        links[3].apply_force((0.0, 0.0, 1.0))
        links[3].apply_torque((0.0, 0.2, 0.0))
    worlds.step(3)
    for number, one in enumerate(lone):
        one.step(3)
        position = one.bodies[panda.id].joints.positions
        np.testing.assert_allclose(worlds[panda].joints.positions[number], position, rtol=0, atol=1e-13)


def test_bases_are_placed_and_thrown(balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    worlds = Worlds(world, COUNT)
    batch = worlds[ball]
    batch.set_base_inertial_poses((1.0, 2.0, 3.0), (0.0, 0.0, 2.0, 0.0), where=[0, 2])
    np.testing.assert_array_equal(batch.base_inertial_poses[0], [1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0])
    np.testing.assert_array_equal(batch.base_inertial_poses[1, :3], [0.0, 0.0, HALF])
    velocities = np.arange(6.0)
    batch.set_base_velocities(velocities, where=np.array([False, True, False]))
    np.testing.assert_array_equal(batch.base_velocities, [0 * velocities, velocities, 0 * velocities])
    batch.base_velocities = velocities
    assert (batch.base_velocities == velocities).all()


def test_contacts_are_summed_up(balls: tuple[World, Body, Body]) -> None:
    world, floor, ball = balls
    worlds = Worlds(world, COUNT)
    worlds[ball].set_base_inertial_poses((0.0, 0.0, 4.0), where=[1])
    worlds.step(10)
    found = worlds.contacts(ball, floor)
    assert found.touching.tolist() == [True, False, True]
    assert found.number.tolist() == [1, 0, 1]
    mass = ball.dynamics(-1).mass
    np.testing.assert_allclose(found.forces[0], [0.0, 0.0, 9.81 * mass], atol=0.02 * mass)
    np.testing.assert_array_equal(found.forces[1], 0.0)
    assert abs(found.distances[0]) < 1e-3
    assert found.distances[1] == np.inf
    np.testing.assert_allclose(found.deepest[0], [0.0, 0.0, 0.0], atol=2e-3)
    assert np.isnan(found.deepest[1]).all()
    # From the other side the force is the opposite one, and any partner will do.
    np.testing.assert_array_equal(worlds.contacts(floor, ball).forces, -found.forces)
    np.testing.assert_array_equal(worlds.contacts(ball).forces, found.forces)
    assert not worlds.contacts(ball, list(world.bodies)[2]).number.any()


def test_contacts_of_one_link() -> None:
    world = earth()
    floor = add_floor(world)
    robot = world.load_urdf(f"{DATA}/r2d2.urdf", position=(0.0, 0.0, 0.5))
    worlds = Worlds(world, 2)
    worlds.step(240)
    wheel = worlds.contacts(robot, floor, link="right_front_wheel")
    head = worlds.contacts(robot, floor, link="head")
    assert wheel.touching.all()
    assert not head.number.any()
    whole = worlds.contacts(robot, floor)
    assert (whole.number > wheel.number).all()


def test_contacts_are_found_without_a_step(balls: tuple[World, Body, Body]) -> None:
    world, floor, ball = balls
    worlds = Worlds(world, COUNT)
    worlds[ball].set_base_inertial_poses((0.0, 0.0, 0.5 * HALF), where=[2])
    worlds.detect_collisions()
    np.testing.assert_allclose(worlds.contacts(ball, floor).distances, [0.0, 0.0, -0.5 * HALF], atol=1e-12)


def test_rays_see_each_world_as_it_is(balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    worlds = Worlds(world, COUNT, threads=2)
    worlds[ball].set_base_inertial_poses([[0, 0, 1.0], [0, 0, 2.0], [9.0, 0, 1.0]])
    starts = np.array([[0.0, 0.0, 5.0], [3.0, 3.0, 5.0], [0.02, 0.0, 5.0], [0.0, 0.01, 5.0], [0, 0, 4.0]])
    ends = starts * [1.0, 1.0, -1.0]
    found = worlds.rays(starts, ends)
    assert found.fractions.shape == (COUNT, 5)
    for number in range(COUNT):
        lone = worlds.extract(number)
        expected = lone.queries().cast_rays(starts, ends)
        for name, place in (("bodies", 0), ("links", 1), ("fractions", 2), ("positions", 3), ("normals", 4)):
            ours = getattr(found, name)[number]
            np.testing.assert_array_equal(ours, [hit[place] for hit in expected], err_msg=name)
    own = starts + np.array([0.0, 0.0, 1.0]) * np.arange(COUNT)[:, None, None]
    moved = worlds.rays(own, own * [1.0, 1.0, -1.0])
    assert (moved.fractions[1:] != found.fractions[1:]).any()
    np.testing.assert_array_equal(moved.fractions[0], found.fractions[0])


def test_a_world_that_is_not_finite_halts_alone_and_can_be_restored(
    balls: tuple[World, Body, Body],
) -> None:
    world, _, ball = balls
    worlds = Worlds(world, COUNT, threads=2)
    start = worlds.snapshot()
    worlds.step(5)
    velocity = worlds._engine.arrays.state.numpy["dof_velocity"]
    velocity[1, ball.first_velocity + 3] = np.nan
    with pytest.warns(SimulationWarning, match=f"world 1 is halted: its body '{ball.name}' has a velocity"):
        worlds.step(4)
    assert worlds.halted.tolist() == [False, True, False]
    assert worlds.time[1] == pytest.approx(5 / 240)
    worlds.step(3)
    lone = world.copy()
    lone.step(12)
    for number in (0, 2):
        assert_same_bits(worlds, number, lone)
    worlds.restore(start, where=worlds.halted)
    assert not worlds.halted.any()
    worlds.step(12)
    assert_same_bits(worlds, 1, lone)


@pytest.mark.parametrize(
    ("field", "column"),
    [("dof_motor", MOTOR_MAX_IMPULSE), ("dof_motor", MOTOR_VELOCITY_CLAMP), ("dof_pd", PD_MAX_FORCE)],
)
def test_a_bound_that_is_no_number_does_not_hide_what_it_bounds(
    arm: tuple[World, Body], field: str, column: int
) -> None:
    world, body = arm
    body.joints[0].set_position_target(0.5, max_force=10.0)
    worlds = Worlds(world, 2)
    worlds._engine.arrays.state.numpy[field][1, body.velocity_index[0], column] = np.nan
    with pytest.warns(SimulationWarning, match="world 1 is halted"):
        worlds.step()
    assert worlds.halted.tolist() == [False, True]


def test_a_bound_of_a_spherical_motor_that_is_no_number_does_not_hide_what_it_bounds() -> None:
    bob = LinkSpec(
        "bob", mass=1.0, inertia=(0.1, 0.1, 0.1), joint_name="ball", joint_type=JointType.SPHERICAL
    )
    world = World()
    body = world.load(BodySpec("pendulum", LinkSpec("base"), [bob], fixed_base=True))
    body.joints[0].set_orientation_target((0.0, 0.0, 0.6, 0.8), max_force=10.0)
    worlds = Worlds(world, 2)
    worlds._engine.arrays.state.numpy["dof_motor"][1, body.velocity_index[0], MOTOR_MAX_IMPULSE] = np.nan
    with pytest.warns(SimulationWarning, match="world 1 is halted"):
        worlds.step()


def test_when_all_worlds_are_halted_nothing_happens(balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    worlds = Worlds(world, 10)
    worlds._engine.arrays.state.numpy["dof_velocity"][:, ball.first_velocity] = np.inf
    with pytest.warns(SimulationWarning) as warned:
        worlds.step()
    assert len(warned) == 9
    assert "10 worlds are halted" in str(warned[-1].message)
    worlds.step(100)
    assert worlds.time.tolist() == [0.0] * 10


def test_a_world_that_halts_within_several_steps_has_the_time_of_its_last_good_one(
    balls: tuple[World, Body, Body],
) -> None:
    world, _, ball = balls
    ball.change_dynamics(-1, max_joint_velocity=1e308)
    times = []
    for steps in ([500], [1] * 500):
        worlds = Worlds(world, 2)
        # Its position is no finite number after some 400 steps.
        worlds._engine.arrays.state.numpy["dof_velocity"][1, ball.first_velocity + 3] = 1e308
        with pytest.warns(SimulationWarning, match="world 1 is halted"):
            for count in steps:
                worlds.step(count)
        assert worlds.halted.tolist() == [False, True]
        times.append(worlds.time)
    assert 1.0 < times[0][1] < 500 / 240 - 0.1
    assert times[0] == pytest.approx(times[1])


def test_many_steps_at_once_are_steps_one_by_one(balls: tuple[World, Body, Body]) -> None:
    world, *_ = balls
    at_once, one_by_one = Worlds(world, 2), Worlds(world, 2)
    at_once.step(150)
    for _ in range(150):
        one_by_one.step()
    lone = one_by_one.extract(1)
    assert_same_bits(at_once, 1, lone)
    assert at_once.time.tolist() == one_by_one.time.tolist() == [lone.time] * 2


def test_a_saved_world_goes_to_many(balls: tuple[World, Body, Body]) -> None:
    world, *_ = balls
    worlds = Worlds(world, COUNT)
    worlds.step(3)
    one = worlds.snapshot(where=2)
    worlds.step(50)
    worlds.restore(one)
    lone = world.copy()
    lone.step(3)
    for number in range(COUNT):
        assert_same_bits(worlds, number, lone)
    assert (len(one), len(worlds.snapshot())) == (1, COUNT)


def test_the_world_they_are_copies_of_stays_as_it_is(balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    untouched = world.copy()
    worlds = Worlds(world, COUNT)
    worlds[ball].change_dynamics(-1, mass=7.0)
    worlds.gravity = 0.0
    worlds.step(20)
    world.step(20)
    untouched.step(20)
    np.testing.assert_array_equal(world.position, untouched.position)
    world.remove(ball.id)
    worlds.step()
    assert worlds.extract(0).bodies[ball.id].name == ball.name


def test_bad_input_is_refused_and_changes_nothing(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    batch, start = worlds[panda], worlds.snapshot()
    before = batch.joints.positions.copy()
    cases = [
        (ValueError, "count must be at least 1", lambda: Worlds(world, 0)),
        (ValueError, "threads must be at least 1", lambda: Worlds(world, 1, threads=0)),
        (ValueError, "device must be", lambda: Worlds(world, 1, device="toaster")),
        (KeyError, "there is no body 9; the world has 0", lambda: worlds[9]),
        (ValueError, r"\(3, 9\)", lambda: setattr(batch.joints, "positions", np.zeros((COUNT, 5)))),
        (ValueError, "must be finite", lambda: setattr(batch.joints, "positions", np.nan)),
        (ValueError, "target must be finite", lambda: batch.joints.set_position_targets(np.full(9, np.nan))),
        (
            ValueError,
            "max_force must be >= 0",
            lambda: batch.joints.set_position_targets(0.0, max_forces=-1.0),
        ),
        (KeyError, "no joint is called 'elbow'", lambda: batch.joints[["elbow"]].set_torques(0.0)),
        (ValueError, "0 degrees of freedom, not one", lambda: batch.joints["panda_joint8"].position),
        (
            ValueError,
            "quaternions other than 0",
            lambda: batch.set_base_inertial_poses((0, 0, 0), (0, 0, 0, 0)),
        ),
        (ValueError, r"as a mask it must have shape \(3,\)", lambda: worlds.restore(start, where=[True])),
        (IndexError, "there are worlds 0 to 2", lambda: worlds.restore(start, where=[3])),
        (ValueError, "mask, numbers of worlds or a slice", lambda: worlds.snapshot(where=[0.5])),
        (ValueError, "states of 2 worlds", lambda: worlds.restore(worlds.snapshot(where=[0, 1]), where=[2])),
        (ValueError, "worlds with other bodies", lambda: worlds.restore(Worlds(World(), 1).snapshot())),
        (IndexError, "there are worlds 0 to 2", lambda: worlds.extract(-1)),
        (ValueError, r"must be \(n, 3\) or \(3, n, 3\)", lambda: worlds.rays([0.0, 0.0, 1.0], [[0, 0, 0]])),
        (ValueError, "1 starts and 2 ends", lambda: worlds.rays([[0, 0, 1]], [[0, 0, 0]] * 2)),
        (ValueError, "other_link needs other", lambda: worlds.contacts(panda, other_link=0)),
        (IndexError, "constraint 5 is out of range", lambda: worlds.constraints[5]),
    ]
    for error, words, call in cases:
        with pytest.raises(error, match=words):
            call()
    np.testing.assert_array_equal(batch.joints.positions, before)


def test_too_many_worlds_are_refused_before_memory_runs_out(
    arm: tuple[World, Body], monkeypatch: pytest.MonkeyPatch
) -> None:
    world, _ = arm
    monkeypatch.setattr(memory, "free_memory", lambda: 1_000_000)
    with pytest.raises(
        MemoryError, match=r"5000 worlds of \d+\.\d kB need 0\.\d GB.*ask for \d+ worlds at most"
    ):
        Worlds(world, 5000)


def boxes() -> World:
    world = earth()
    add_floor(world)
    for place in range(27):
        add_box(world, (0.6 * (place % 3), 0.6 * (place // 3 % 3), 0.1 + 0.2 * (place // 9)))
    return world


@pytest.mark.parametrize("ties", [0, 1, 3])
def test_each_world_has_only_the_rows_that_it_uses(arm: tuple[World, Body], ties: int) -> None:
    world, body = arm
    for _ in range(ties):
        world.constrain_links(UserConstraintKind.POINT_TO_POINT, body, -1, None, -1)
    worlds = Worlds(world, 3)
    worlds.step()
    capacity, used = worlds._engine.arrays.state.capacity, worlds._engine.arrays.used
    # One more ties the fingers.
    assert capacity["user"] == ties + 1
    assert capacity["batch"] == used["constraint"]
    assert capacity["link"] == used["link"]


@pytest.mark.skipif(
    not Path("/proc/self/statm").is_file(), reason="only Linux says how much memory is in use"
)
def test_worlds_of_arms_and_boxes_take_little_memory(arm: tuple[World, Body]) -> None:
    assert _bytes_per_world(arm[0]) < 30_000
    # Memory in use has a granularity of pages: 50 to 67 kB were measured.
    assert _bytes_per_world(boxes()) < 75_000


def _bytes_per_world(scene: World, count: int = 500) -> float:
    # The workspace and what the first step needs once are not what counts.
    Worlds(scene, 2).step(60)
    before = _memory_in_use()
    worlds = Worlds(scene, count)
    worlds.step(60)
    return (_memory_in_use() - before) / worlds.count


def _memory_in_use() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
