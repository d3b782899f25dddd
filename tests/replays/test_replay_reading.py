"""Replays read back: as arrays by names, the same as what was simulated."""

from __future__ import annotations

import json
import struct
from base64 import b64encode
from dataclasses import replace
from pathlib import Path
from typing import Any
from zlib import compress

import numpy as np
import pytest
from tests.each import each

import carom.replay
import pybullet as p
import pybullet_data
from carom import World
from carom.cli.command_line import main
from carom.description import Pose
from carom.errors import DescriptionError
from carom.replay import Replay
from carom.replay.poses import composed, continuous
from carom.viewer.replay.page import replay_of, replay_page
from carom.viewer.replay.recording import Recording

DATA = Path(pybullet_data.getDataPath())


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Replay, dict[str, np.ndarray]]:
    """A Panda that moves; a cube of which there are two for a while; and what they did."""
    file = tmp_path_factory.mktemp("replays") / "run.html"
    world = World()
    world.gravity = (0, 0, -9.81)
    seen: dict[str, list[Any]] = {"time": [], "pose": [], "joint": [], "inertial": []}
    with world.record(file, fps=60, title="A run"):
        world.load_urdf(DATA / "plane.urdf")
        arm = world.load_urdf(DATA / "franka_panda/panda.urdf", fixed_base=True)
        world.load_urdf(DATA / "cube_small.urdf", (0.5, 0, 0.021))
        joint, link = arm.joints["panda_joint4"], arm.links["panda_link5"]
        now = link.pose
        row = arm.first_link + arm.link_number("panda_link5") + 1
        inertial = world.link_pose[row].copy()
        for step in range(240):
            if step == 120:
                world.load_urdf(DATA / "cube_small.urdf", (1.5, 0, 0.5))
            if step == 200:
                world.remove(max(world.bodies.keys()))
            before, now = now, link.pose
            if step % 4 == 0:
                seen["time"].append(world.time)
                seen["pose"].append([*before.position, *before.orientation])
                seen["inertial"].append(inertial)
                seen["joint"].append([joint.position, joint.velocity])
            joint.set_position_target(-1.5 + np.sin(step / 60), max_force=80)
            world.step()
            inertial = world.link_pose[row].copy()
    return carom.replay.read(file), {name: np.array(rows) for name, rows in seen.items()}


def test_times_and_title_are_those_of_the_recording(run) -> None:
    replay, seen = run
    assert replay.title == "A run"
    assert replay.times[:-1] == pytest.approx(seen["time"])
    assert replay.clock == pytest.approx(replay.times)
    assert replay.camera is None


def test_what_is_printed_is_short(run) -> None:
    replay, _ = run
    length, names = f"{replay.times[-1] - replay.times[0]:.3f}", ", ".join(map(repr, replay.bodies))
    assert repr(replay) == f"<Replay 'A run': {len(replay.times)} frames, {length} s, with {names}>"
    assert repr(replace(replay, bodies={})).endswith(" s, with no body>")
    arm = replay.bodies["panda"]
    count = int(arm.present.sum())
    assert (
        repr(arm) == f"<ReplayBody 'panda': {len(arm.links)} links, {len(arm.joints)} joints, {count} frames>"
    )
    assert repr(arm.links["panda_link5"]) == f"<ReplayLink 'panda_link5': {len(replay.times)} frames>"


def test_links_and_joints_are_found_by_name(run) -> None:
    replay, seen = run
    arm = replay.bodies["panda"]
    assert arm.file == "franka_panda/panda.urdf"
    link = arm.links["panda_link5"]
    assert link.parent == "panda_link4"
    assert arm.links["panda_link0"].parent is None
    assert link.inertial_pose.dtype == np.float32
    assert np.array_equal(link.inertial_pose[:-1], seen["inertial"].astype(np.float32))
    # They are those of the step before, as in PyBullet, and positions of joints are of this one.
    assert link.pose[:-1, :3] == pytest.approx(seen["pose"][:, :3], abs=1e-6)
    turned = np.abs(np.einsum("ij,ij->i", link.pose[:-1, 3:], seen["pose"][:, 3:]))
    assert turned == pytest.approx(1.0, abs=1e-6)
    joint = arm.joints["panda_joint4"]
    assert joint.link == "panda_link4"
    assert joint.kind == "revolute"
    assert joint.position[:-1] == pytest.approx(seen["joint"][:, 0], abs=1e-6)
    assert joint.velocity[:-1] == pytest.approx(seen["joint"][:, 1], abs=1e-5)
    assert joint.position_target[1] == pytest.approx(-1.5 + np.sin(3 / 60), abs=1e-6)
    assert "panda_joint8" not in arm.joints  # it is fixed


def test_bodies_of_the_same_name_are_told_apart_and_are_not_there_before_they_come(run) -> None:
    replay, _ = run
    first, second = (replay.bodies[name] for name in ("cube.urdf", "cube.urdf 2"))
    assert first.present.all()
    assert np.flatnonzero(second.present).tolist() == list(range(31, 51))
    pose = second.links["baseLink"].pose
    assert np.isnan(pose[:31]).all()
    assert np.isnan(pose[51:]).all()
    assert pose[31, :3] == pytest.approx([1.5, 0, 0.5], abs=1e-2)
    assert [(look.begin, look.end) for look in second.looks] == [(31, 51)]


def test_contacts_are_told_by_names(run) -> None:
    contacts = run[0].contacts
    rows = (contacts.frame == 20) & (contacts.body_b == "cube.urdf")
    assert rows.sum() == 4
    assert set(contacts.body_a[rows]) == {"plane"}
    assert set(contacts.link_a[rows]) == {"planeLink"}
    assert set(contacts.link_b[rows]) == {"baseLink"}
    assert contacts.normal_force[rows].sum() == pytest.approx(0.1 * 9.81, rel=0.02)
    assert np.abs(contacts.normal[rows]) == pytest.approx(np.tile([0, 0, 1], (4, 1)))
    assert contacts.position[rows][:, 2] == pytest.approx(0, abs=0.01)


def test_shapes_have_their_meshes_and_images(run) -> None:
    arm, plane = run[0].bodies["panda"], run[0].bodies["plane"]
    (look,) = arm.looks
    assert {shape.link for shape in look.shapes} <= set(arm.links)
    mesh = look.shapes[0].mesh
    assert mesh.triangles.max() == len(mesh.positions) - 1
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0, abs=1e-3)
    assert plane.looks[0].shapes[0].texture is not None
    assert plane.looks[0].shapes[0].texture.data[:4] == b"\x89PNG"


def test_all_that_scripts_draw_and_plot_is_there(tmp_path: Path) -> None:
    script = tmp_path / "draws.py"
    script.write_text(
        "import pybullet as p\n"
        "p.connect(p.GUI)\n"
        "p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))\n"
        "p.addUserDebugParameter('gain', 0, 2, 1)\n"
        "for step in range(48):\n"
        "    if step == 24:\n"
        "        p.resetSimulation()\n"
        "        p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))\n"
        "        p.addUserDebugText('half', [0, 0, 1])\n"
        "    p.stepSimulation()\n",
        encoding="utf-8",
    )
    assert main(["record", str(script), str(tmp_path / "draws.html")]) == 0
    p.disconnect()
    replay = carom.replay.read(str(tmp_path / "draws.html"))
    kinds = [event.kind for event in replay.events]
    assert {"slider", "text", "dynamics"} <= set(kinds)
    (text,) = (event for event in replay.events if event.kind == "text")
    assert text.facts["text"] == "half"
    assert 5 <= text.frame <= 7


def test_clock_and_values_of_frames() -> None:
    recording = Recording()
    for time, values in ((1.0, {}), (1.5, {"error": 2.0}), (1.5, {"error": 3.0}), (0.0, {"error": 3.0})):
        header = {"type": "frame", "layout": 0, "poses": 0, "time": time}
        recording.add({**header, **({"values": values} if values else {})}, np.float32(time).tobytes())
    replay = _read(recording.packed(title="x"))
    assert replay.clock == pytest.approx([0, 0.5, 0.5 + 1 / 60, 0.5 + 2 / 60])
    np.testing.assert_array_equal(replay.values["error"], [np.nan, 2, 3, 3])


def test_a_body_that_changes_its_looks_stays_the_same_and_keeps_its_frames() -> None:
    link = {"name": "base", "position": [0, 0, 1], "orientation": [0, 0, 0, 1], "moves": True}
    body = {
        "type": "body",
        "body": 3,
        "name": "ball",
        "file": None,
        "path": None,
        "links": [link],
        "shapes": [],
    }
    recording = Recording()
    recording.add({"type": "layout", "layout": 1, "bodies": [[3, 1], [4, 2]]}, b"")
    recording.add(body, b"")
    frame = {"type": "frame", "layout": 1, "poses": 3, "time": 0.0}
    pose = np.tile(np.array([0, 0, 5, 0, 0, 0, 1], np.float32), 3).tobytes()
    recording.add(frame, pose)
    recording.add({"type": "no body", "body": 3}, b"")
    recording.add({**body, "links": [{**link, "position": [0, 0, 2]}]}, b"")
    recording.add({**frame, "time": 1.0}, pose)
    # A body of the same number with other links is another one; its poses come with the next layout.
    recording.add(
        {**body, "links": [link, {**link, "name": "tip", "joint": "j", "kind": "fixed", "parent": 0}]}, b""
    )
    recording.add({**frame, "time": 2.0}, pose)
    recording.add({"type": "no layout"}, b"")
    replay = _read(recording.packed())
    assert list(replay.bodies) == ["ball", "ball 2"]
    ball = replay.bodies["ball"]
    assert ball.present.tolist() == [True, True, False]
    assert ball.links["base"].pose[:2, 2].tolist() == [6, 7]
    assert [(look.begin, look.end) for look in ball.looks] == [(0, 1), (1, 2)]
    assert not replay.bodies["ball 2"].present.any()
    assert replay.bodies["ball 2"].joints == {}


def test_readings_of_links_actuators_sensors_and_tendons() -> None:
    link = {"name": "base", "position": [0, 0, 0], "orientation": [0, 0, 0, 1], "moves": True}
    tip = {**link, "joint": "slide", "kind": "prismatic", "parent": 0}
    body = {"type": "body", "body": 0, "name": "crane", "file": None, "path": None, "links": [link, tip]}
    body |= {
        "shapes": [],
        "actuators": [{"name": "winch", "range": [0, 1]}, {"name": "idle", "range": [0, 1]}],
    }
    body |= {"sensors": [{"name": "gyro", "kind": "gyro", "size": 3}]}
    blocks = {
        "links": [[0, -1, *range(12)]],
        "actuators": [[0, 0, 0.5, 7, np.nan]],
        "sensors": [[0, 0, 2, 9.0]],
        "tendons": [[0, 1, 2, 3, 4, 5, 6, 8, 1], [5, 1, 2, 3, 4, 5, 6, 8, 0]],
    }
    recording = Recording()
    recording.add({"type": "layout", "layout": 1, "bodies": [[0, 2]]}, b"")
    recording.add(body, b"")
    frame = {"type": "frame", "layout": 1, "poses": 2, "time": 0.0}
    poses = np.tile(np.array([0, 0, 0, 0, 0, 0, 1], np.float32), 2)
    recording.add(frame, poses.tobytes())
    numbers = np.concatenate([poses, *(np.ravel(rows) for rows in blocks.values())]).astype("<f4")
    told = [[name, len(rows)] for name, rows in blocks.items()]
    recording.add({**frame, "time": 1.0, "blocks": told}, numbers.tobytes())
    replay = _read(recording.packed())
    crane = replay.bodies["crane"]
    # Both links have the same name: each is found by one.
    assert list(crane.links) == ["base", "base 2"]
    base = crane.links["base"]
    np.testing.assert_array_equal(base.velocity, [[np.nan] * 6, range(6)])
    np.testing.assert_array_equal(base.joint_load, [[np.nan] * 6, range(6, 12)])
    assert crane.links["base 2"].velocity is None
    np.testing.assert_array_equal(crane.joints["slide"].position, [np.nan, np.nan])
    np.testing.assert_array_equal(crane.actuators["winch"].force, [np.nan, 7])
    np.testing.assert_array_equal(crane.actuators["idle"].force, [np.nan, np.nan])
    np.testing.assert_array_equal(crane.sensors["gyro"], [[np.nan] * 3, [np.nan, np.nan, 9]])
    assert replay.tendons.body.tolist() == ["crane", ""]
    assert replay.tendons.force.tolist() == [8, 8]
    assert replay.tendons.at_limit.tolist() == [True, False]
    assert replay.tendons.frame.tolist() == [1, 1]


def test_poses_are_composed_as_quaternions_are() -> None:
    quarter = [0, 0, 0.5**0.5, 0.5**0.5]
    rows = np.array([[1, 2, 3, *quarter]])
    expected = [1 - 20, 2 + 10, 3 + 30, 0, 0, 1, 0]
    assert composed(rows, Pose((10, 20, 30), tuple(quarter)))[0] == pytest.approx(expected)
    turns = np.array([[0, 0, 0, 1.0], [0, 0, 0, -1], [0, 0, 0.1, -1], [0, 0, 0, 1]])
    assert continuous(turns).tolist() == [[0, 0, 0, 1], [0, 0, 0, 1], [0, 0, -0.1, 1], [0, 0, 0, 1]]


FRAME = {"frames": 1, "floats": 7, "header": {"type": "frame", "layout": 1, "poses": 1}, "times": [0.0]}
LINK = {"name": "base", "position": [0, 0, 0], "orientation": [0, 0, 0, 1], "moves": True}
SHAPE = {"link": 0, "meshes": [[7, None]], "texture": -1, "rgba": [1, 1, 1, 1], "specular": [0, 0, 0]}
SHAPE |= {"twoSided": False, "position": [0, 0, 0], "orientation": [0, 0, 0, 1], "scale": [1, 1, 1]}
BALL = {"type": "body", "body": 0, "name": "ball", "links": [LINK], "shapes": [SHAPE]}
MESH = {"type": "mesh", "mesh": 7, "vertices": 3, "triangles": 1}


def _packed(*records: dict[str, Any], payload: bytes = b"", **facts: Any) -> bytes:
    index = json.dumps({"format": 1, **facts, "records": records}).encode()
    return compress(struct.pack("<I", len(index)) + index + payload)


def _read(recording: bytes, folder: Path | None = None) -> Replay:
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as name:
        file = (folder or Path(name)) / "it.html"
        file.write_text(replay_of(recording, "it"), encoding="utf-8")
        return carom.replay.read(file)


@each(
    ("recording", "reason"),
    [
        (b"", "the recording is damaged"),
        (compress(b"ab"), "the recording is damaged"),
        (compress(struct.pack("<I", 2) + b"no"), "the recording is damaged"),
        (
            compress(struct.pack("<I", 2) + b"{}"),
            "the index of the recording is damaged (KeyError('format'))",
        ),
        (_packed(format=9), "the recording has format 9; only 1 is known"),
        (_packed(FRAME, payload=bytes(27)), "within what its index lists"),
        (_packed({**FRAME, "times": []}, payload=bytes(28)), "has 1 frames and 0 times"),
        (_packed({"bytes": 3}), "the index of the recording is damaged"),
        (
            _packed({**FRAME, "header": {**FRAME["header"], "poses": 2}}, payload=bytes(28)),
            "frame 0 has 7 numbers, too few for 2 poses",
        ),
        (
            _packed({**FRAME, "header": {**FRAME["header"], "blocks": [["joints", 1]]}}, payload=bytes(28)),
            "frame 0 has 7 numbers, too few for its joints",
        ),
        (
            _packed({**FRAME, "header": {**FRAME["header"], "blocks": [["smells", 1]]}}, payload=bytes(28)),
            "frame 0 has readings 'smells'; this version of Carom knows contacts, joints",
        ),
        (
            _packed({"message": MESH, "bytes": 4}, payload=bytes(4)),
            "mesh 7 has 4 bytes, not those of 3 vertices",
        ),
        (
            _packed(
                {"message": {"type": "texture", "texture": 2, "width": 2, "height": 3}, "bytes": 1},
                payload=b".",
            ),
            "image 2 has 1 bytes, not those of 2 x 3 pixels",
        ),
        (
            _packed({"message": BALL, "bytes": 0}, FRAME, payload=bytes(28)),
            "there is no mesh 7, which a shape of 'ball' has",
        ),
        (
            _packed(
                {"message": {**BALL, "shapes": [{**SHAPE, "texture": 5}]}, "bytes": 0},
                {"message": MESH, "bytes": 108},
                FRAME,
                payload=bytes(108 + 28),
            ),
            "there is no image 5, which a shape of 'ball' has",
        ),
        (_packed({"message": {"type": "body"}, "bytes": 0}), "its recording is damaged (KeyError('body'))"),
    ],
)
def test_damaged_recordings_say_what_is_wrong(recording: bytes, reason: str, tmp_path: Path) -> None:
    with pytest.raises(DescriptionError) as problem:
        _read(recording, tmp_path)
    assert str(tmp_path / "it.html") in str(problem.value)
    assert reason in str(problem.value)


@each(
    ("text", "reason"),
    [
        ("", "it is empty; a page of"),
        ("<html>hello</html>", "there is no recording in it; a page of `World.record`, of `carom record`"),
        (replay_page(), "it is the player without a recording"),
        (
            replay_of(b"1234567", "cut").partition('id="recording">')[0] + 'id="recording">abc',
            "was not copied to",
        ),
        ('<script id="recording">?</script>', "it.html:1: its recording is no base 64"),
    ],
)
def test_files_that_are_no_replays_are_refused(text: str, reason: str, tmp_path: Path) -> None:
    file = tmp_path / "it.html"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DescriptionError) as problem:
        carom.replay.read(file)
    assert reason in str(problem.value)


def test_a_missing_file_is_missing(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        carom.replay.read(tmp_path / "none.html")


def test_the_smallest_page_that_can_be_read(tmp_path: Path) -> None:
    file = tmp_path / "it.html"
    packed = b64encode(_packed(title="none")).decode()
    file.write_text(f'<script id="recording">\n{packed}\n</script>', encoding="utf-8")
    replay = carom.replay.read(file)
    assert (replay.title, len(replay.times), dict(replay.bodies)) == ("none", 0, {})
    assert len(replay.clock) == 0
    assert len(replay.contacts.frame) == 0
