"""Soft bodies come, go, are saved and copied as others are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.engine.failing import everything
from tests.soft.scenes import rigid, world

from carom import World, Worlds
from carom.description import Box, Plane, Sphere
from carom.scene.soft_body import SoftBody

FIELDS = ("position", "dof_velocity", "node_position", "node_velocity")


def scene() -> World:
    """Cloth held by a box, a soft cube, and a ball on a plane."""
    where = world()
    rigid(where, Plane())
    block = rigid(where, Box((0.1, 0.1, 0.1)), 1.0, (-0.6, 0.0, 0.5))
    cloth = where.load_cloth((0.6, 0.6), (6, 6), (0, 0, 0.5), self_collision=True)
    cloth.anchor(3, block)
    cloth.anchor(48)
    where.load_soft_solid((0.2, 0.2, 0.2), (2, 2, 2), (0, 0, 0.3))
    rigid(where, Sphere(0.05), 0.2, (0.0, 0.0, 0.7))
    return where


def state(where: World) -> list[np.ndarray]:
    return [where.arrays.state.numpy[name][0].copy() for name in FIELDS]


def assert_same(first: list[np.ndarray], second: list[np.ndarray]) -> None:
    for a, b in zip(first, second, strict=True):
        count = min(len(a), len(b))
        assert np.array_equal(a[:count], b[:count])


def test_a_snapshot_is_gone_back_to_exactly() -> None:
    where = scene()
    where.step(50)
    snapshot = where.snapshot()
    where.step(50)
    after = state(where)
    where.restore(snapshot)
    where.step(50)
    assert_same(state(where), after)


def test_a_file_goes_on_exactly(tmp_path: Path) -> None:
    where = scene()
    where.step(50)
    where.save(tmp_path / "soft.carom")
    other = World()
    bodies = other.load(tmp_path / "soft.carom")
    where.step(50)
    other.step(50)
    assert_same(state(where), state(other))
    cloth = bodies[2]
    assert isinstance(cloth, SoftBody)
    assert len(cloth.anchors) == 2


def test_a_copy_goes_on_exactly() -> None:
    where = scene()
    where.step(50)
    other = where.copy()
    where.step(50)
    other.step(50)
    assert_same(state(where), state(other))
    other.step(10)
    where.step(10)
    assert_same(state(where), state(other))


@pytest.mark.parametrize("removed", [0, 1, 2, 3, 4])
def test_others_go_on_when_a_body_goes(removed: int) -> None:
    where = scene()
    where.step(20)
    where.remove(removed)
    where.step(100)
    assert np.isfinite(where.arrays.state.numpy["node_position"]).all()
    for body in where.bodies.values():
        if isinstance(body, SoftBody):
            assert where.position[body.first_position + 2] == pytest.approx(body.nodes[:, 2].mean(), abs=0.05)
    anchors = len(where.contact_arrays.soft.anchors)
    assert anchors == {1: 1, 2: 0}.get(removed, 2)
    assert len(where.contact_arrays.soft.bodies) == (1 if removed in (2, 3) else 2)


def test_it_makes_no_difference_that_a_body_was_there() -> None:
    where, other = scene(), scene()
    extra = other.load_soft_solid((0.2, 0.2, 0.2), (2, 2, 2), (5, 5, 5))
    other.remove(extra.id)
    where.step(60)
    other.step(60)
    assert_same(state(where), state(other))


def test_each_of_many_worlds_is_what_it_would_be_alone() -> None:
    where = scene()
    many = Worlds(where, 3, threads=2)
    cloth = many[2]
    cloth.node_velocities[1, :, 2] += 1.0
    many.step(60)
    alone, pushed = where.copy(), where.copy()
    body = pushed.bodies[2]
    assert isinstance(body, SoftBody)
    body.node_velocities[:, 2] += 1.0
    alone.step(60)
    pushed.step(60)
    for number, lone in ((0, alone), (1, pushed), (2, alone)):
        twin = lone.bodies[2]
        assert isinstance(twin, SoftBody)
        assert np.array_equal(cloth.nodes[number], twin.nodes)
    assert not np.array_equal(cloth.nodes[0], cloth.nodes[1])
    saved = many.snapshot()
    many.step(10)
    after = cloth.nodes.copy()
    many.restore(saved)
    many.step(10)
    assert np.array_equal(cloth.nodes, after)


def test_many_nodes_on_an_articulated_body_find_room() -> None:
    """Rows over trees grow where there are too few."""
    where = world()
    arm = where.load_urdf("kuka_iiwa/model.urdf", fixed_base=True)
    where.load_cloth((1.5, 1.5), (40, 40), (0, 0, 1.4), stiffness=50.0)
    for _ in range(120):
        where.step()
    assert np.isfinite(where.arrays.state.numpy["node_position"]).all()
    # The cloth lies over the arm, and bends it.
    assert np.abs(where.velocity).max() > 0.0
    assert np.abs(where.position[arm.first_position + 7 :][:7]).max() > 1e-5


def test_a_velocity_that_is_not_finite_stops_the_step() -> None:
    from carom.errors import SimulationError

    where = scene()
    where.step(120)
    cloth = where.bodies[2]
    assert isinstance(cloth, SoftBody)
    cloth.node_velocities[4] = np.nan
    before = everything(where)
    assert before["node_push"].any()
    with pytest.raises(SimulationError, match="body 2"):
        where.step()
    after = everything(where)
    for name, array in before.items():
        np.testing.assert_array_equal(after[name], array, err_msg=name)
    cloth.node_velocities[4] = 0.0
    where.step(5)
    assert np.isfinite(cloth.nodes).all()


def test_the_base_stands_for_the_nodes() -> None:
    where = world(0.0)
    solid = where.load_soft_solid((0.4, 0.2, 0.2), (4, 2, 2), (1, 2, 3))
    assert where.position[:7] == pytest.approx([1, 2, 3, 0, 0, 0, 1])
    half = np.sqrt(0.5)
    solid.set_inertial_pose((0, 0, 1), (0, 0, half, half))
    assert np.ptp(solid.nodes, axis=0) == pytest.approx([0.2, 0.4, 0.2])
    assert where.position[3:7] == pytest.approx([0, 0, half, half])
    solid.set_base_velocity((1, 0, 0), (0, 0, 2))
    assert where.velocity[:6] == pytest.approx([0, 0, 2, 1, 0, 0])
    where.step(60)
    assert where.position[0] == pytest.approx(0.25, abs=1e-3)
    turned = 2 * np.arctan2(where.position[5], where.position[6])
    assert turned == pytest.approx(np.pi / 2 + 0.5, abs=0.01)


def test_worlds_without_soft_bodies_launch_what_they_did() -> None:
    from carom.engine.program import MOTION, Plan, step_program

    where = World()
    rigid(where, Plane())
    rigid(where, Box((0.1, 0.1, 0.1)), 1.0, (0, 0, 1))
    where.prepare()
    program = step_program(where.engine.structs(), Plan(touching=True, sleeping=False, coupled=True))
    assert [launch.kernel for launch in program.motion] == list(MOTION)
    assert (len(program.begin), len(program.end), len(program.abandon)) == (1, 1, 1)


def test_moving_nodes_writes_no_anchors(monkeypatch: pytest.MonkeyPatch) -> None:
    where = world()
    cloth = where.load_cloth(cells=(3, 3))
    anchor = cloth.anchor(0)
    where.step()
    written: list[None] = []
    soft = where.contact_arrays.soft
    monkeypatch.setattr(soft, "write_anchors", lambda: written.append(None))
    cloth.set_nodes(cloth.nodes + 1.0)
    cloth.update()
    assert not written
    monkeypatch.undo()
    center = where.position[cloth.first_position :][:3].copy()
    cloth.release(anchor)
    # The node that was held did not count.
    assert where.position[cloth.first_position :][:3] == pytest.approx(cloth.nodes.mean(axis=0))
    assert center == pytest.approx(cloth.nodes[1:].mean(axis=0))
