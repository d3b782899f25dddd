"""What rays, contacts and overlaps see of soft bodies."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Thread

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, rigid, world

import pybullet as p
import pybullet_data
from carom import World
from carom.description import Box, Plane
from carom.scene.soft_body import SoftBody
from pybullet._clients.clients import clients


@pytest.fixture
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    yield
    p.disconnect()


def cloth_over_a_plane() -> tuple[World, SoftBody]:
    where = world()
    rigid(where, Plane())
    return where, where.load_cloth((1, 1), (4, 4), (0, 0, 0.3))


def test_rays_hit_cloth_from_both_sides() -> None:
    where, cloth = cloth_over_a_plane()
    for start, end, fraction, normal in (
        ((0.1, 0.07, 1.3), (0.1, 0.07, -0.7), 0.5, 1.0),
        ((0.1, 0.07, 0.1), (0.1, 0.07, 1.1), 0.2, -1.0),
    ):
        hit = where.queries().cast_ray(start, end)
        assert hit[:2] == (cloth.id, -1)
        assert hit[2:] == (
            pytest.approx(fraction),
            pytest.approx((0.1, 0.07, 0.3)),
            pytest.approx((0, 0, normal)),
        )
    assert where.queries().cast_ray((0.6, 0, 1), (0.6, 0, -1))[0] == 0
    assert where.queries().cast_ray((0.6, 0, 1), (0.6, 0, 0.1))[0] == -1


def test_rays_hit_cloth_at_its_rim_and_where_they_begin_and_end() -> None:
    where = world()
    # All these numbers have few bits.
    cloth = where.load_cloth((1, 1), (4, 4), (0, 0, 0.25))
    for x in (-0.5, -0.125):
        # The last is the middle of a square, where its two triangles meet.
        for y in (-0.5, 0.0625, -0.125):
            for start, end, fraction in ((1.25, -0.75, 0.5), (1.25, 0.25, 1.0), (0.25, -0.75, 0.0)):
                hit = where.queries().cast_ray((x, y, start), (x, y, end))
                assert (hit.body, hit.fraction) == (cloth.id, fraction)


def test_rays_hit_one_body_after_the_other() -> None:
    where, cloth = cloth_over_a_plane()
    starts, ends = [(0.1, 0.07, 1), (0.7, 0, 1)], [(0.1, 0.07, -1), (0.7, 0, -1)]
    bodies = [
        [hit[0] for hit in where.queries().cast_rays(starts, ends, hit_number=number)] for number in range(3)
    ]
    assert bodies == [[cloth.id, 0], [0, -1], [-1, -1]]


def test_rays_leave_a_solid_that_they_start_in() -> None:
    where = world()
    solid = where.load_soft_solid((1.0, 1.0, 1.0), (2, 2, 2))
    assert where.queries().cast_ray((0, 0, 0), (2, 0, 0))[0] == -1
    hit = where.queries().cast_ray((2, 0.1, 0.2), (0, 0.1, 0.2))
    assert (hit[0], hit[2], hit[4]) == (solid.id, pytest.approx(0.75), pytest.approx((1, 0, 0)))


def test_rays_agree_with_a_search_over_all_faces() -> None:
    where = world()
    cloth = where.load_cloth((1, 1), (6, 6))
    random = np.random.default_rng(3)
    cloth.set_nodes(cloth.nodes + random.normal(0, 0.05, cloth.nodes.shape))
    starts, ends = random.normal(0, 0.5, (300, 3)), random.normal(0, 0.5, (300, 3))
    hits = where.queries().cast_rays(starts, ends)
    for start, end, hit in zip(starts, ends, hits, strict=True):
        fractions = [1.0]
        for a, b, c in cloth.nodes[cloth.faces]:
            # start + t (end - start) = a + u (b - a) + v (c - a)
            t, u, v = np.linalg.solve(np.stack([start - end, b - a, c - a], axis=1), start - a)
            if 0 <= t <= 1 and u >= 0 and v >= 0 and u + v <= 1:
                fractions.append(t)
        assert hit[2] == pytest.approx(min(fractions), abs=1e-9)


def test_masks_hold_for_rays() -> None:
    where, cloth = cloth_over_a_plane()
    assert where.queries().cast_ray((0.1, 0.07, 1), (0.1, 0.07, 0.1), mask=2)[0] == -1
    shapes = where.contact_arrays.shapes.table.numpy
    shapes["link_group"][cloth.first_link] = 2
    assert where.queries().cast_ray((0.1, 0.07, 1), (0.1, 0.07, 0.1), mask=2)[0] == cloth.id


@pytest.mark.usefixtures("connection")
def test_contacts_are_nodes_that_touch() -> None:
    """As in PyBullet: the soft body first, unless the other one was asked for; the forces bear its weight."""
    p.setGravity(0, 0, -GRAVITY)
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1]), -1, [0, 0, -1])
    cloth = p.loadSoftBody(
        "cloth_z_up.obj",
        [0, 0, 0.1],
        scale=0.5,
        mass=1,
        collisionMargin=0.02,
        useMassSpring=1,
        frictionCoeff=0.5,
    )
    assert p.getContactPoints() == ()
    for _ in range(240):
        p.stepSimulation()
    found = p.getContactPoints()
    assert len(found) == 25
    assert {contact[:5] for contact in found} == {(0, cloth, floor, -1, -1)}
    assert all(contact[7] == (0.0, 0.0, 1.0) for contact in found)
    assert [contact[8] for contact in found] == pytest.approx([0.0] * 25, abs=1e-3)
    # PyBullet 3.2.7 says 13 contacts of 0.8 N.
    assert sum(contact[9] for contact in found) == pytest.approx(GRAVITY, rel=1e-6)
    nodes = p.getMeshData(cloth, flags=p.MESH_DATA_SIMULATION_MESH)[1]
    assert sorted(contact[5] for contact in found) == sorted(nodes)
    assert {round(contact[6][2], 9) for contact in found} == {0.0}
    turned = p.getContactPoints(floor, cloth)
    assert {contact[:5] for contact in turned} == {(0, floor, cloth, -1, -1)}
    assert {contact[7][2] for contact in turned} == {-1.0}
    assert sorted(contact[6] for contact in turned) == sorted(nodes)
    assert p.getContactPoints(cloth, 77) == p.getContactPoints(77) == ()
    assert len(p.getContactPoints(cloth, linkIndexB=-1)) == 25
    assert p.getContactPoints(cloth, linkIndexB=0) == ()
    # As in PyBullet.
    assert p.getClosestPoints(cloth, floor, 1.0) == ()


def test_friction_is_what_holds_it() -> None:
    where = world()
    where.gravity = (2.0, 0.0, -GRAVITY)
    rigid(where, Plane(), friction=1.0)
    where.load_cloth((0.4, 0.4), (2, 2), (0, 0, 0.01), margin=0.01, friction=1.0, mass=0.9)
    where.step(120)
    found, columns = where.queries().contact_columns(-1, -2, -1, -2, where.parameters.time_step)
    rows = list(zip(*columns, strict=False))[:found]
    assert found == 9
    pull = sum(np.array(row[10]) * row[9] for row in rows)
    assert pull == pytest.approx([-1.8, 0.0, 0.0], abs=1e-3)


def test_rigid_contacts_are_there_as_well() -> None:
    where = world()
    rigid(where, Plane())
    rigid(where, Box((0.1, 0.1, 0.1)), 1.0, (1, 0, 0.1))
    where.load_cloth((0.4, 0.4), (2, 2), (0, 0, 0.011))
    where.step(24)
    found, columns = where.queries().contact_columns(-1, -2, -1, -2, where.parameters.time_step)
    rows = list(zip(*columns, strict=False))
    assert len(rows) == found > 9
    assert {row[:2] for row in rows[:-9]} <= {(0, 1), (1, 0)}
    assert {row[:2] for row in rows[-9:]} == {(2, 0)}


def test_bounds_meet_boxes_where_the_nodes_are() -> None:
    where, cloth = cloth_over_a_plane()
    row = cloth.first_link
    assert row in where.queries().overlapping((0.4, 0.4, 0.2), (0.5, 0.5, 0.4))
    assert row not in where.queries().overlapping((0.6, 0.6, 0.2), (0.7, 0.7, 0.4))


def test_contacts_wait_until_another_thread_has_stepped(connection: None) -> None:
    p.loadSoftBody("cloth_z_up.obj", scale=0.5, useMassSpring=1)
    question = Thread(target=p.getContactPoints)
    with clients[0].lock:
        question.start()
        question.join(0.3)
        assert question.is_alive()
    question.join()
