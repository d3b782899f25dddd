"""Logs, compared with those of PyBullet 3.2.7 where they have its layouts."""

import json
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.pybullet.logs.log_scene import LOGS, NAMES, write_logs

import pybullet as p
import pybullet_data
from carom import World
from carom.errors import StateError

MARKER = b"\xaa\xbb"


def parts(file: Path) -> tuple[bytes, bytes, list[tuple | None]]:
    """Column names, types, and the records; None for a marker without one."""
    names, types, rest = file.read_bytes().split(b"\n", 2)
    layout = struct.Struct("<" + types.decode())
    records: list[tuple | None] = []
    while rest:
        assert rest[:2] == MARKER
        rest = rest[2:]
        if not rest or rest[:2] == MARKER:
            records.append(None)
        else:
            records.append(layout.unpack_from(rest))
            rest = rest[layout.size :]
    return names, types, records


@pytest.mark.parametrize("name", NAMES)
def test_logs_are_those_of_pybullet(name: str, tmp_path: Path) -> None:
    write_logs(p, tmp_path)
    names, types, records = parts(tmp_path / f"{name}.bin")
    expected_names, expected_types, expected = parts(LOGS / f"{name}.bin")
    assert (names, types, len(records)) == (expected_names, expected_types, len(expected))
    for record, other in zip(records, expected, strict=True):
        assert (record is None) == (other is None)
        if record is not None and other is not None:
            np.testing.assert_allclose(record, other, rtol=0.0, atol=1e-7)
            # Zeros have their signs, too.
            integers = [index for index, kind in enumerate(types.decode()) if kind in "Ii"]
            assert [record[index] for index in integers] == [other[index] for index in integers]


@pytest.fixture
def boxes() -> Iterator[tuple[int, int, int]]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    floor = p.loadURDF("plane.urdf")
    yield floor, p.loadURDF("cube_small.urdf", [0, 0, 0.025]), p.loadURDF("cube_small.urdf", [1, 0, 0.025])
    if p.isConnected():
        p.disconnect()


def test_contacts_are_logged_as_they_are_reported(boxes, tmp_path: Path) -> None:
    floor, first, second = boxes
    kind = p.STATE_LOGGING_CONTACT_POINTS
    asked = {
        "all": {},
        "first": {"bodyUniqueIdA": first},
        "other_side": {"bodyUniqueIdB": first},
        "both": {"bodyUniqueIdA": second, "bodyUniqueIdB": floor},
        "no_link": {"bodyUniqueIdA": first, "linkIndexA": 3},
    }
    logs = {
        name: p.startStateLogging(kind, str(tmp_path / name), **keywords) for name, keywords in asked.items()
    }
    p.stepSimulation()
    points = p.getContactPoints()
    for log in logs.values():
        p.stopStateLogging(log)
    pairs = {
        name: [(record[3], record[4]) for record in parts(tmp_path / name)[2] if record] for name in asked
    }
    assert len(points) == 8
    assert pairs == {
        "all": [(floor, first)] * 4 + [(floor, second)] * 4,
        "first": [(floor, first)] * 4,
        "other_side": [(floor, first)] * 4,
        "both": [(floor, second)] * 4,
        "no_link": [],
    }
    record = parts(tmp_path / "all")[2][0]
    assert record is not None
    assert record[7:] == pytest.approx(
        (*points[0][5], *points[0][6], *points[0][7], *points[0][8:10]), abs=1e-6
    )


def test_contacts_are_logged_of_a_step_in_which_their_arrays_grow(tmp_path: Path) -> None:
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    p.setPhysicsEngineParameter(numSubSteps=3)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 1]), -1, [0, 0, -1])
    for number in range(300):
        # All but the first fall for 23 steps.
        height = 0.15 if number else 0.1
        p.createMultiBody(1, box, -1, [0.3 * (number % 20), 0.3 * (number // 20), height])
    start = p.saveState()
    logged = []
    for name in ("arrays grow", "there is room"):
        p.restoreState(start)
        log = p.startStateLogging(p.STATE_LOGGING_CONTACT_POINTS, str(tmp_path / name))
        for _ in range(26):
            p.stepSimulation()
        p.stopStateLogging(log)
        logged.append([record[2:] for record in parts(tmp_path / name)[2] if record])
    p.disconnect()
    assert logged[0] == logged[1]
    assert len(logged[0]) > 4 * 300


def test_timings_are_a_trace_with_the_zones_of_scripts(boxes, tmp_path: Path) -> None:
    log = p.startStateLogging(p.STATE_LOGGING_PROFILE_TIMINGS, str(tmp_path / "trace"))
    p.submitProfileTiming("zone")
    p.stepSimulation()
    p.submitProfileTiming()
    p.submitProfileTiming()
    p.stopStateLogging(log)
    events = json.loads((tmp_path / "trace_0.json").read_text())["traceEvents"]
    assert [(event["ph"], event["name"]) for event in events] == [
        ("B", "zone"),
        ("B", "stepSimulation"),
        ("E", "stepSimulation"),
        ("E", "zone"),
    ]
    times = [event["ts"] for event in events]
    assert times == sorted(times)


def test_ids_are_not_used_again_and_logs_end_with_the_connection(boxes, tmp_path: Path) -> None:
    start = p.startStateLogging
    assert start(p.STATE_LOGGING_GENERIC_ROBOT, str(tmp_path / "a")) == 0
    p.stopStateLogging(0)
    p.stopStateLogging(0)
    assert start(p.STATE_LOGGING_GENERIC_ROBOT, str(tmp_path / "b")) == 1
    p.stepSimulation()
    p.disconnect()
    assert len(parts(tmp_path / "b")[2]) == 3


def test_what_cannot_be_logged(boxes, tmp_path: Path) -> None:
    for kind in (p.STATE_LOGGING_MINITAUR, p.STATE_LOGGING_CUSTOM_TIMER, 99):
        assert p.startStateLogging(kind, str(tmp_path / "none")) is None
    assert [file.name for file in tmp_path.iterdir()] == []
    for name, ids in (("nowhere/x", None), ("", None), ("x", 5)):
        with pytest.raises(p.error, match=r"^startStateLogging failed\."):
            p.startStateLogging(1, str(tmp_path / name) if name else "", ids)  # type: ignore[arg-type]


def test_a_world_logs_to_arrays() -> None:
    world = World()
    body = world.load_urdf(Path(pybullet_data.getDataPath()) / "cartpole.urdf")
    world.gravity = (0.0, 0.0, -9.81)
    world.motor[:, 4] = 0.0
    world.velocity[body.velocity_index[1]] = 1.0
    with world.log("position", "velocity", every=2) as log:
        world.step(600)
    world.step()
    assert len(log) == 300
    assert log["time"] == pytest.approx(np.arange(1, 301) * 2 / 240)
    assert log["position"].shape == (300, *world.state.position.shape)
    assert not np.array_equal(log["velocity"][0], log["velocity"][-1])
    assert body.first_position == 0
    assert not world.observers


def test_a_log_ends_when_bodies_come(tmp_path: Path) -> None:
    world = World()
    file = Path(pybullet_data.getDataPath()) / "cartpole.urdf"
    world.load_urdf(file)
    log = world.log("position")
    world.step()
    world.load_urdf(file)
    with pytest.raises(StateError, match="bodies were added or removed"):
        world.step()
    world.step()
    assert len(log) == 1
    log = world.log("position")
    world.step()
    world.remove(0)
    with pytest.raises(StateError, match="bodies were added or removed"):
        world.step()
    assert len(log) == 1
    for names, every in ((("nothing",), 1), ((), 0)):
        with pytest.raises(ValueError, match=r"nothing|every"):
            world.log(*names, every=every)
