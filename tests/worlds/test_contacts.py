"""Forces, lists and times of contacts of all worlds at once."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet_data
from carom import World, Worlds
from carom.worlds.contact_times import ContactTimes

ASSETS = pybullet_data.getDataPath()
FEET = ["left_front_wheel", "right_front_wheel", "left_back_wheel", "right_back_wheel"]


def scene() -> tuple[Worlds, int, int]:
    """A robot on the ground, one in the air, and one that falls over."""
    world = World()
    world.gravity = (0, 0, -9.81)
    floor = world.load_urdf(f"{ASSETS}/plane.urdf")
    robot = world.load_urdf(f"{ASSETS}/r2d2.urdf", (0, 0, 0.5))
    worlds = Worlds(world, 3, threads=2)
    worlds[robot].base_inertial_poses[:, 2] = [0.5, 9.0, 0.5]
    worlds[robot].set_base_velocities([0, 0, 0, 4.0, 0, 0], where=[2])
    worlds.step(120)
    return worlds, floor.id, robot.id


def test_forces_on_links_are_those_of_each_link_asked_by_itself():
    worlds, floor, robot = scene()
    links = range(-1, len(worlds[robot].links.names[1:]))
    forces = worlds.contact_forces(robot, [*links], floor)
    for place, link in enumerate(links):
        assert (forces[:, place] == worlds.contacts(robot, floor, link=link).forces).all()
    assert (worlds.contact_forces(robot) == worlds.contact_forces(robot, [*links][1:])).all()
    # Nothing but the ground is there.
    assert (worlds.contact_forces(robot, FEET) == worlds.contact_forces(robot, FEET, floor)).all()
    assert forces[0, :, 2].sum() > 100.0
    assert not forces[1].any()
    back = worlds.contact_forces(floor, [-1], robot)
    assert np.allclose(back[:, 0], -forces.sum(axis=1))


def test_links_that_push_each_other_get_opposite_forces():
    world = World()
    boxes = [world.load_urdf(f"{ASSETS}/cube_small.urdf", (x, 0, 0)) for x in (0.0, 0.051)]
    worlds = Worlds(world, 2)
    worlds[boxes[1]].set_base_velocities([-3.0, 0, 0, 0, 0, 0])
    worlds.step(2)
    first, second = (worlds.contact_forces(box, [-1])[:, 0] for box in boxes)
    assert (np.abs(first[:, 0]) > 0.0).all()
    assert (first == -second).all()


def test_lists_of_contacts_are_those_of_each_world_alone():
    worlds, floor, robot = scene()
    found = worlds.contact_list(robot)
    assert (np.diff(found.worlds) >= 0).all()
    assert set(found.worlds.tolist()) == {0, 2}
    sums = np.zeros((3, 3))
    np.add.at(sums, found.worlds, found.forces)
    assert np.allclose(sums, worlds.contacts(robot).forces)
    for world in range(3):
        lone = worlds.extract(world)
        columns = lone.queries().contact_columns(robot, -2, -1, -2, lone.parameters.substep_time)
        alone = sorted(zip(*(list(column)[: columns.found] for column in columns.columns), strict=True))
        rows = np.flatnonzero(found.worlds == world)
        assert len(rows) == len(alone)
        own = sorted(
            (
                robot,
                int(found.other_bodies[row]),
                int(found.links[row]),
                int(found.other_links[row]),
                tuple(found.points[row]),
                tuple(found.other_points[row]),
                tuple(found.normals[row]),
                float(found.distances[row]),
                float(found.normal_forces[row]),
            )
            for row in rows
        )
        assert own == [contact[:9] for contact in alone]
    same = worlds.contact_list(floor, robot)
    assert sorted(same.distances) == sorted(found.distances)
    # The same from the other side.
    pairs = [
        sorted(zip(it.worlds, *ends, strict=True))
        for it, ends in ((found, (found.links, found.other_links)), (same, (same.other_links, same.links)))
    ]
    assert pairs[0] == pairs[1]
    assert (same.other_bodies == robot).all()
    assert (same.normals[:, 2] < 0.0).all()


def test_without_contacts_a_list_is_empty():
    world = World()
    box = world.load_urdf(f"{ASSETS}/cube_no_rotation.urdf")
    found = Worlds(world, 2).contact_list(box)
    assert len(found.worlds) == 0
    assert found.points.shape == (0, 3)


def test_times_of_contact_and_in_the_air():
    world = World()
    world.gravity = (0, 0, -10.0)
    world.load_urdf(f"{ASSETS}/plane.urdf")
    ball = world.load_urdf(f"{ASSETS}/sphere_small.urdf", (0, 0, 1.0))
    worlds = Worlds(world, 2)
    worlds[ball].base_inertial_poses[:, 2] = [0.3, 50.0]
    times = ContactTimes(worlds, ball, [-1])
    landings, flight = [], 0.0
    for _ in range(120):
        worlds.step()
        times.update()
        if times.landed[0, 0]:
            landings.append(float(worlds.time[0]))
            flight = float(times.last_air_times[0, 0])
    assert landings[0] == flight
    assert 0.20 < flight < 0.25  # falls 0.27 m
    assert times.touching[:, 0].tolist() == [True, False]
    assert times.air_times[:, 0].tolist() == [0.0, worlds.time[1]]
    assert 0.0 < times.contact_times[0, 0] < worlds.time[0] - flight + 1.5 * worlds.time_step
    assert times.contact_times[1, 0] == 0.0
    # It is lifted.
    worlds[ball].base_inertial_poses[0, 2] = 50.0
    held = times.contact_times[0, 0]
    worlds.step()
    times.update()
    assert times.last_contact_times[0, 0] == pytest.approx(held + worlds.time_step)
    saved = times.checkpoint()
    worlds.step(5)
    times.update()
    assert times.air_times[0, 0] == pytest.approx(6 * worlds.time_step)
    twin = ContactTimes(worlds, ball, [-1])
    twin.resume(saved)
    twin.update()
    assert (twin.air_times == times.air_times).all()
    times.forget([0])
    assert times.air_times[:, 0].tolist() == [0.0, worlds.time[1]]
    assert times.last_air_times[0, 0] == 0.0


def test_a_contact_that_is_there_at_the_start_has_not_landed():
    worlds, _, robot = scene()
    times = ContactTimes(worlds, robot, FEET, least_force=1.0)
    times.update()
    assert times.touching[0].all()
    assert not times.landed.any()
    strict = ContactTimes(worlds, robot, FEET, least_force=1e6)
    strict.update()
    assert not strict.touching.any()
