"""States to go back to, and worlds as files."""

import json
import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

import pybullet_data
from carom import World
from carom.description import Box, Collision, Pose, TriangleMesh, Visual
from carom.errors import DescriptionError, StateError
from carom.layouts.codes import UserConstraintKind
from carom.model.body_spec import BodySpec, LinkSpec
from carom.render.appearance import appearance_of
from carom.scene.snapshot import Snapshot
from carom.world_files.container import Blocks, packed, unpacked
from carom.world_files.saved_state import split_impulses

DATA = Path(pybullet_data.getDataPath())


def box(half: float = 0.1, mass: float = 1.0) -> BodySpec:
    shape = Box((half, half, half))
    inertia = mass * (2 * half) ** 2 / 6
    return BodySpec(
        "box",
        LinkSpec("box", mass=mass, inertia=(inertia, inertia, inertia), collisions=(Collision(shape),)),
        fixed_base=mass == 0.0,
    )


def cube_of_boxes(side: int) -> World:
    """Boxes on a floor, each a little beside the one below, so that they fall over."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load(box(5.0, 0.0), (0.0, 0.0, -5.0))
    spec = box()
    for layer in range(side):
        for row in range(side):
            for place in range(side):
                world.load(spec, (place * 0.21 + layer * 0.045, row * 0.205, 0.1 + layer * 0.2))
    return world


def machines() -> World:
    """An arm under motors, boxes, ties, a filter and a text."""
    world = cube_of_boxes(2)
    arm = world.load_urdf(DATA / "kuka_iiwa" / "model.urdf", (1.5, 0.0, 0.0), fixed_base=True)
    for joint in range(7):
        world.motor[arm.velocity_index[joint], :5] = (0.5, 0.0, 0.1, 1.0, 5.0)
    arm.change_dynamics(2, mass=3.0, lateral_friction=0.9, joint_damping=0.2)
    arm.change_dynamics(3, joint_lower_limit=-0.2, joint_upper_limit=0.3)
    arm.change_dynamics(-1, linear_damping=0.3)
    arm.set_sensor(6, True)
    first, second, third = (world.bodies[number] for number in (1, 2, 3))
    world.constrain_links(
        UserConstraintKind.POINT_TO_POINT, first, -1, second, -1, child_frame=Pose((-0.2, 0.0, 0.0))
    )
    world.remove_constraint(world.constrain_links(UserConstraintKind.FIXED, first, -1, None, -1))
    world.constrain_links(UserConstraintKind.FIXED, third, -1, None, -1, child_frame=Pose((0.3, 0.4, 0.5)))
    world.constrain_links(UserConstraintKind.FIXED, second, -1, third, -1).enabled = False
    world.remove(4)
    world.contact_arrays.shapes.filters.set(second.first_link, third.first_link, enabled=False)
    world.user_data.add(1, -1, -1, "owner", "nobody")
    return world


def assert_same(a: Snapshot, b: Snapshot) -> None:
    for one, other in ((a.state, b.state), (a.contacts, b.contacts)):
        for name in one:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)
    np.testing.assert_array_equal(a.user_impulses, b.user_impulses)
    assert (a.time, a.unspent_time) == (b.time, b.unspent_time)


def test_blocks_begin_at_multiples_of_eight_bytes() -> None:
    blocks = Blocks()
    offsets = [blocks.add(bytes([size]) * size) for size in (1, 8, 3, 0, 13, 2)]
    assert offsets == [0, 8, 16, 24, 24, 40]
    assert all(blocks.joined()[at] == size for at, size in zip(offsets[1:3], (8, 3), strict=True))


def test_impulses_of_older_files_are_split_from_the_counter_of_warm_starting() -> None:
    impulses = np.arange(8.0).reshape(2, 4)
    contacts = {"contact_impulse": impulses}
    split_impulses(contacts)
    np.testing.assert_array_equal(contacts["contact_impulse"], impulses[:, :3])
    np.testing.assert_array_equal(contacts["contact_warm_start"], impulses[:, 3])
    again = dict(contacts)
    split_impulses(again)
    assert all(again[name] is contacts[name] for name in contacts)


@pytest.mark.parametrize("make", [machines, lambda: cube_of_boxes(5)], ids=["machines", "125 boxes"])
def test_what_follows_a_restored_state_is_the_same_to_the_last_bit(make: Callable[[], World]) -> None:
    world = make()
    world.step(20)
    start = world.snapshot()
    world.step(60)
    end = world.snapshot()
    world.restore(start)
    assert_same(world.snapshot(), start)
    world.step(60)
    assert_same(world.snapshot(), end)


def test_substeps_that_do_not_divide_evenly_are_part_of_the_state() -> None:
    world = cube_of_boxes(2)
    world.parameters.substeps = 3
    world.apply_parameters()
    world.step(7)
    start = world.snapshot()
    world.step(11)
    end = world.snapshot()
    world.restore(start)
    world.step(11)
    assert_same(world.snapshot(), end)


def test_motors_and_forces_go_back_too() -> None:
    world = machines()
    arm = world.bodies[9]
    motor, force = world.motor.copy(), world.link_force.copy()
    state = world.snapshot()
    world.motor[arm.velocity_index[0], 0] = -1.0
    world.link_force[0] = 1.0
    world.restore(state)
    joints = [row for body in world.bodies.values() for row in body.velocity_index if row >= 0]
    np.testing.assert_array_equal(world.motor[joints], motor[joints])
    np.testing.assert_array_equal(world.link_force, force)


def test_a_state_does_not_fit_other_bodies() -> None:
    world = cube_of_boxes(1)
    state = world.snapshot()
    world.load(box())
    before = world.position.copy()
    with pytest.raises(StateError, match="body 2 was not there"):
        world.restore(state)
    np.testing.assert_array_equal(world.position, before)
    world.remove(2)
    world.restore(state)
    world.remove(1)
    with pytest.raises(StateError, match="body 1 has been removed"):
        world.restore(state)
    world.load_urdf(DATA / "cartpole.urdf")
    with pytest.raises(StateError, match="body 1 has 2 joints"):
        world.restore(state)


def test_bodies_loaded_again_in_another_order_get_their_own_state_back() -> None:
    world = cube_of_boxes(1)
    arm = world.load_urdf(DATA / "cartpole.urdf")
    world.position[arm.first_position + 7] = 0.25
    state = world.snapshot()
    world.remove(1)
    world.load(box(), (9.0, 9.0, 9.0))
    assert list(world.bodies.keys()) == [0, 2, 1]
    world.restore(state)
    np.testing.assert_array_equal(world.position[world.bodies[1].first_position :][:3], (0.0, 0.0, 0.1))
    assert world.position[arm.first_position + 7] == 0.25
    world.step()


def test_a_saved_world_goes_on_in_another_one(tmp_path: Path) -> None:
    world = machines()
    appearance_of(world).change(world.bodies[1], -1, rgba=(1.0, 0.0, 0.0, 1.0))
    world.step(20)
    world.save(tmp_path / "world")
    world.step(40)
    other = World()
    bodies = other.load(tmp_path / "world")
    assert [body.id for body in bodies] == list(world.bodies.keys()) == [0, 1, 2, 3, 5, 6, 7, 8, 9]
    assert other.gravity.tolist() == [0.0, 0.0, -9.81]
    assert [body.name for body in bodies] == [body.name for body in world.bodies.values()]
    assert bodies[-1].dynamics(2) == world.bodies[9].dynamics(2)
    assert bodies[-1].has_sensor(6)
    assert appearance_of(other).shapes(bodies[1], -1)[0].rgba == (1.0, 0.0, 0.0, 1.0)
    datum = other.user_data.find(1, -1, -1, "owner")
    assert datum is not None
    assert datum.value == "nobody"
    other.step(40)
    assert_same(other.snapshot(), world.snapshot())
    assert other.load(box()).id == world.load(box()).id == 4


def test_a_world_goes_on_from_a_file_of_a_version_with_impulses_of_four_columns(tmp_path: Path) -> None:
    world = cube_of_boxes(2)
    world.step(20)
    file = tmp_path / "new"
    world.save(file)
    document, rest = unpacked(file.read_bytes(), file)
    contacts = document["state"]["contacts"]

    def values(name: str) -> np.ndarray:
        shape = contacts[name]["shape"]
        count, start = int(np.prod(shape)), contacts[name]["at"]
        return np.frombuffer(rest, contacts[name]["array"], count, start).reshape(shape)

    impulses = np.column_stack([values("contact_impulse"), values("contact_warm_start")])
    assert len(impulses) > 0
    blocks = Blocks()
    blocks.add(bytes(rest))
    start = blocks.add(impulses.tobytes())
    contacts["contact_impulse"] = {"array": impulses.dtype.str, "shape": [*impulses.shape], "at": start}
    del contacts["contact_warm_start"]
    (tmp_path / "old").write_bytes(packed(document, blocks))
    old = World()
    old.load(tmp_path / "old")
    for it in (world, old):
        it.step(20)
    assert_same(old.snapshot(), world.snapshot())


def test_a_world_goes_on_from_a_file_of_a_version_that_kept_less(tmp_path: Path) -> None:
    world = cube_of_boxes(2)
    arm = world.load_urdf(DATA / "kuka_iiwa" / "model.urdf", (1.5, 0.0, 0.0), fixed_base=True)
    arm.set_sensor(6, True)
    world.constrain_links(UserConstraintKind.FIXED, world.bodies[2], -1, world.bodies[3], -1)
    world.step(20)
    world.save(tmp_path / "new")
    document, rest = unpacked((tmp_path / "new").read_bytes(), tmp_path / "new")
    blocks = Blocks()
    blocks.add(bytes(rest))
    for name in ("node_position", "node_velocity", "node_force", "node_push", "sensor_memory", "link_load"):
        del document["state"]["state"][name]
    ties = [dict(tie) for tie in document["world"]["ties"]]
    for tie in document["world"]["ties"]:
        for name in ("spring", "range", "reference", "impedance", "polynomial", "armature", "enabled"):
            del tie[name]
    (tmp_path / "old").write_bytes(packed(document, blocks))
    old = World()
    old.load(tmp_path / "old")
    assert not old.snapshot().state["link_load"].any()
    old.save(tmp_path / "again")
    again, _ = unpacked((tmp_path / "again").read_bytes(), tmp_path / "again")
    assert again["world"]["ties"] == ties
    for it in (world, old):
        it.step(20)
    assert_same(old.snapshot(), world.snapshot())


def _of_five_columns(document: dict[str, Any]) -> None:
    twist = document["state"]["state"]["link_twist"]
    twist["shape"] = [twist["shape"][0], 5]


def _flat(document: dict[str, Any]) -> None:
    impulses = document["state"]["user_impulses"]
    impulses["shape"] = [int(np.prod(impulses["shape"]))]


def _narrow(document: dict[str, Any]) -> None:
    rows, width = document["state"]["user_impulses"]["shape"]
    document["state"]["user_impulses"]["shape"] = [rows * width // 2, 2]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (_of_five_columns, "array 'link_twist' has the wrong shape"),
        (_flat, r"shape \[\d+\], which does not fit"),
        (_narrow, "2], which does not fit"),
    ],
)
def test_arrays_of_other_shapes_are_refused(
    change: Callable[[dict[str, Any]], None], reason: str, tmp_path: Path
) -> None:
    world = machines()
    world.step(3)
    world.save(tmp_path / "sound")
    document, rest = unpacked((tmp_path / "sound").read_bytes(), tmp_path / "sound")
    blocks = Blocks()
    blocks.add(bytes(rest))
    change(document)
    (tmp_path / "bad").write_bytes(packed(document, blocks))
    before = world.snapshot()
    for use in (World().load, world.restore):
        with pytest.raises(DescriptionError, match=reason):
            use(tmp_path / "bad")
    assert_same(world.snapshot(), before)


def test_triangles_with_other_than_three_corners_are_refused(tmp_path: Path) -> None:
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2], [0, 2, 1]], np.int32))
    world = World()
    world.load(BodySpec("body", LinkSpec("body", visuals=(Visual(mesh),)), fixed_base=True))
    world.save(tmp_path / "sound")
    data = (tmp_path / "sound").read_bytes()
    document, rest = unpacked(data, tmp_path / "sound")
    text = json.dumps(document)
    assert text.count('"shape": [2, 3]') == 1
    blocks = Blocks()
    blocks.add(bytes(rest))
    (tmp_path / "bad").write_bytes(packed(json.loads(text.replace("[2, 3]", "[3, 2]")), blocks))
    with pytest.raises(DescriptionError, match=r"wrong shape \(3, 2\)"):
        World().load(tmp_path / "bad")


def test_limits_of_a_saved_world_yield_as_much_as_before(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(
        '<mujoco><worldbody><body><joint type="slide" axis="0 0 1" limited="true" range="-.1 .1" '
        'solreflimit=".1 1"/><geom size=".1"/></body></worldbody></mujoco>'
    )
    world = World()
    world.load(tmp_path / "a.xml")
    world.gravity = (0.0, 0.0, -9.81)
    world.save(tmp_path / "w.carom")
    copy = World()
    copy.load(tmp_path / "w.carom")
    for it in (world, copy):
        it.step(80)
    (height,) = world.bodies[0].joints[0].coordinates
    assert height < -0.11
    assert copy.bodies[0].joints[0].coordinates == (height,)


def test_a_file_restores_the_state_of_the_same_world(tmp_path: Path) -> None:
    world = machines()
    world.step(10)
    start = world.snapshot()
    world.save(tmp_path / "world")
    world.step(10)
    world.restore(tmp_path / "world")
    assert_same(world.snapshot(), start)
    world.remove(1)
    with pytest.raises(StateError, match="body 1 has been removed"):
        world.restore(tmp_path / "world")


def test_bodies_of_a_file_are_added_to_a_world_that_has_some(tmp_path: Path) -> None:
    world = machines()
    world.step(10)
    world.save(tmp_path / "world")
    other = World()
    other.load(box(), (0.0, 0.0, 50.0))
    bodies = other.load(tmp_path / "world")
    assert [body.id for body in bodies] == list(range(1, 10))
    assert other.gravity.tolist() == [0.0, 0.0, 0.0]
    for old, new in zip(world.bodies.values(), bodies, strict=True):
        for view, first in (("position", "first_position"), ("velocity", "first_velocity")):
            count = old.rows.count["position" if view == "position" else "dof"]
            np.testing.assert_array_equal(
                getattr(world, view)[getattr(old, first) :][:count],
                getattr(other, view)[getattr(new, first) :][:count],
            )
    assert [tie.parent.id for tie in other.user_constraints.all] == [2, 4, 3]
    other.step(5)


def test_meshes_travel_with_the_file(tmp_path: Path) -> None:
    folder = tmp_path / "meshes"
    folder.mkdir()
    for name in ("duck.obj", "duck.mtl", "duck.png", "duck_vhacd.urdf"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    world = World()
    world.load_urdf(folder / "duck_vhacd.urdf")
    world.save(tmp_path / "world")
    there = World().load(tmp_path / "world")[0].spec.base.visuals[0].geometry
    assert there == world.bodies[0].spec.base.visuals[0].geometry
    for file in folder.iterdir():
        file.unlink()
    body = World().load(tmp_path / "world")[0]
    unpacked = body.spec.base.visuals[0].geometry.path  # type: ignore[union-attr]
    assert unpacked.read_bytes() == (DATA / "duck.obj").read_bytes()
    assert (unpacked.parent / "duck.png").read_bytes() == (DATA / "duck.png").read_bytes()
    assert appearance_of(body.world).shapes(body, -1)[0].texture >= 0


def test_arrays_of_meshes_are_kept(tmp_path: Path) -> None:
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2]], dtype=np.int32))
    spec = BodySpec(
        "mesh", LinkSpec("mesh", collisions=(Collision(mesh),), visuals=(Visual(mesh),)), fixed_base=True
    )
    world = World()
    world.load(spec)
    world.save(tmp_path / "world")
    link = World().load(tmp_path / "world")[0].spec.base
    for shape in (*link.collisions, *link.visuals):
        assert isinstance(shape.geometry, TriangleMesh)
        np.testing.assert_array_equal(shape.geometry.vertices, np.eye(3))
        assert shape.geometry.triangles.dtype == np.int32


def saved_bytes(tmp_path: Path) -> bytes:
    world = machines()
    world.step(3)
    world.save(tmp_path / "sound")
    return (tmp_path / "sound").read_bytes()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda data: b"", "not a world saved"),
        (lambda data: b"hello" * 100, "not a world saved"),
        (lambda data: data[:40], "not a world saved"),
        (lambda data: data[:-1], "damaged"),
        (lambda data: data + b"x", "damaged"),
        (lambda data: data[:500] + bytes([data[500] ^ 1]) + data[501:], "checksum"),
        (lambda data: data[:8] + struct.pack("<I", 7) + data[12:], "version 7"),
        (lambda data: packed({}, Blocks()), "list of files is invalid"),
        (lambda data: packed({"files": [], "world": {}, "state": {}}, Blocks()), "is not of type SavedWorld"),
    ],
)
def test_rubbish_is_refused(change: Callable[[bytes], bytes], reason: str, tmp_path: Path) -> None:
    (tmp_path / "bad").write_bytes(change(saved_bytes(tmp_path)))
    world = cube_of_boxes(1)
    before = world.snapshot()
    for use in (world.load, world.restore):
        with pytest.raises(DescriptionError, match=reason):
            use(tmp_path / "bad")
    assert_same(world.snapshot(), before)


def test_a_failed_save_leaves_the_old_file_alone(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="nowhere"):
        World().save(tmp_path / "nowhere" / "world")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("count", [-1, 2**31])
def test_a_count_of_late_links_that_is_damaged_is_refused(tmp_path: Path, count: int) -> None:
    sound = saved_bytes(tmp_path)
    (length,) = struct.unpack_from("<Q", sound, 56)
    document, blocks = json.loads(sound[64 : 64 + length]), Blocks()
    document["state"]["bodies"][-1]["late"] = count
    blocks.add(sound[64 + length :])
    (tmp_path / "bad").write_bytes(packed(document, blocks))
    world = World()
    with pytest.raises(DescriptionError, match="late_velocity"):
        world.load(tmp_path / "bad")
    assert not world.bodies


# What a file could say in the place of something else.
RUBBISH = st.sampled_from(
    [
        None,
        True,
        -1,
        0,
        1,
        7,
        2**31,
        2**70,
        1e308,
        float("inf"),
        float("nan"),
        "",
        "../x",
        [],
        [1],
        {},
        {"is": "Box"},
    ]
)


@settings(max_examples=cases(50), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_document_with_one_thing_wrong_loads_or_is_refused(data: st.DataObject, tmp_path: Path) -> None:
    """Even where the checksum is right: nothing but `DescriptionError`, and nothing half loaded."""
    import json

    if not (tmp_path / "sound").exists():
        saved_bytes(tmp_path)
    sound = (tmp_path / "sound").read_bytes()
    (length,) = struct.unpack_from("<Q", sound, 56)
    document, rest = json.loads(sound[64 : 64 + length]), sound[64 + length :]
    part = document
    while True:
        keys = list(part) if isinstance(part, dict) else list(range(len(part)))
        key = data.draw(st.sampled_from(keys))
        if not isinstance(part[key], (dict, list)) or not part[key] or data.draw(st.integers(0, 9)) == 0:
            break
        part = part[key]
    part[key] = data.draw(RUBBISH)
    blocks = Blocks()
    blocks.add(rest)
    (tmp_path / "bad").write_bytes(packed(document, blocks))
    world = World()
    try:
        world.load(tmp_path / "bad")
    except DescriptionError:
        assert not world.bodies
        assert not world.user_constraints.all
        assert world.arrays.used["tree"] == 0
    else:
        world.snapshot()


def test_a_snapshot_is_of_the_present_arrays() -> None:
    world = World()
    world.load_urdf("cube_small.urdf", (0.0, 0.0, 1.0))
    world.snapshot()
    state = world.arrays.state
    state.reserve({axis: count + 1 for axis, count in state.capacity.items()})
    state.numpy["position"][0, 2] = 5.0
    world.scene_changed()
    high = world.snapshot()
    state.reserve({axis: count + 1 for axis, count in state.capacity.items()})
    state.numpy["position"][0, 2] = 7.0
    assert world.snapshot().state["position"][2] == 7.0
    world.restore(high)
    assert state.numpy["position"][0, 2] == 5.0


def test_a_world_whose_solver_had_nothing_to_move_is_loaded_as_it_was_saved(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(
        '<mujoco><worldbody><body name="m" mocap="true" pos="0 5 1"/><body name="h" pos="0 5.5 1">'
        '<freejoint/><geom size="1e-30"/></body></worldbody><equality><weld body1="m" body2="h" '
        'relpose=".05 .5 .1 1 .1 .05 0"/></equality></mujoco>'
    )
    world = World(contact="bullet")
    world.load(tmp_path / "a.xml")
    world.step(3)
    assert np.isnan(world.snapshot().state["tree_residual"]).any()
    world.save(tmp_path / "w.carom")
    copy = World()
    copy.load(tmp_path / "w.carom")
    world.step(2)
    copy.step(2)
    for name, rows in world.snapshot().state.items():
        assert np.array_equal(rows, copy.snapshot().state[name], equal_nan=rows.dtype.kind == "f"), name


def test_a_world_that_could_not_be_loaded_is_not_saved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World()
    body = world.load("cube_small.urdf").bodies[0]
    file = tmp_path / "w.carom"
    world.save(file)
    before = file.read_bytes()
    spec = replace(body.spec, base=replace(body.spec.base, mass=1e31))
    with monkeypatch.context() as patch:
        patch.setattr(body, "spec", spec)
        with pytest.raises(StateError, match=r"body 'cube.urdf'.*mass.*1e\+31"):
            world.save(file)
    world.velocity[0] = 1e200
    with pytest.raises(StateError, match="'dof_velocity' contains a number"):
        world.save(file)
    assert file.read_bytes() == before
