"""Replays for other programs: each file is opened by the library of its format."""

from __future__ import annotations

import builtins
import io
import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from tests.each import each

import carom.replay
import pybullet_data
from carom import World
from carom.cli.command_line import main
from carom.replay import Replay
from carom.replay.glb import Glb
from carom.replay.rerun_file import _Writer

DATA = Path(pybullet_data.getDataPath())
# Turns y up, as in glTF, back to z up.
BACK = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pendulum that swings; a ball that comes after half a second and goes after a whole one; a floor."""
    file = tmp_path_factory.mktemp("exports") / "swing.html"
    world = World()
    world.gravity = (0, 0, -9.81)
    with world.record(file, fps=30):
        world.load_urdf(DATA / "plane.urdf")
        arm = world.load_urdf(DATA / "cartpole.urdf", (0, 0, 1), fixed_base=True)
        arm.joints["cart_to_pole"].reset(0.5)
        world.step(120)
        ball = world.add_sphere(0.25, position=(1, 2, 0.25), mass=1.0)
        world.step(120)
        world.remove(ball.id)
        world.step(60)
    return file


@pytest.fixture(scope="module")
def replay(page: Path) -> Replay:
    return carom.replay.read(page)


def _accessor(document: dict[str, Any], buffer: bytes, number: int) -> NDArray[Any]:
    accessor = document["accessors"][number]
    view = document["bufferViews"][accessor["bufferView"]]
    columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
    count = accessor["count"] * columns
    return np.frombuffer(buffer, kind, count, view["byteOffset"]).reshape(-1, columns)


def _chunks(file: Path) -> tuple[dict[str, Any], bytes]:
    data = file.read_bytes()
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    size, kind = struct.unpack_from("<I4s", data, 20 + length)
    assert kind == b"BIN\0"
    assert length % 4 == size % 4 == 0
    return json.loads(data[20 : 20 + length]), data[28 + length : 28 + length + size]


def test_gltf_moves_links_as_the_replay_does(replay: Replay, tmp_path: Path) -> None:
    lost = carom.replay.export(replay, tmp_path / "swing.glb")
    assert "contacts" in lost
    assert "positions, velocities and torques of joints" in lost
    document, buffer = _chunks(tmp_path / "swing.glb")
    (animation,) = document["animations"]
    nodes = document["nodes"]
    (pole,) = (number for number, node in enumerate(nodes) if node.get("name") == "pole")
    samplers = animation["samplers"]
    moves = {
        channel["target"]["path"]: samplers[channel["sampler"]]
        for channel in animation["channels"]
        if channel["target"]["node"] == pole
    }
    assert set(moves) == {"translation", "rotation"}
    link = replay.bodies["physics"].links["pole"].pose
    times, where, turns = (
        _accessor(document, buffer, number)
        for number in (
            moves["rotation"]["input"],
            moves["translation"]["output"],
            moves["rotation"]["output"],
        )
    )
    assert times[:, 0] == pytest.approx(replay.clock, abs=1e-6)
    assert document["accessors"][moves["rotation"]["input"]]["max"] == pytest.approx([replay.clock[-1]])
    assert where == pytest.approx(link[:, :3], abs=1e-6)
    assert np.abs(np.einsum("ij,ij->i", turns, link[:, 3:])) == pytest.approx(1.0, abs=1e-6)
    assert np.all(np.einsum("ij,ij->i", turns[1:], turns[:-1]) > 0.0)
    # What never moves is not animated.
    (plane,) = (number for number, node in enumerate(nodes) if node.get("name") == "planeLink")
    assert not any(channel["target"]["node"] == plane for channel in animation["channels"])


def test_gltf_shows_a_body_only_while_it_is_there(replay: Replay, tmp_path: Path) -> None:
    carom.replay.export(replay, tmp_path / "swing.glb")
    document, buffer = _chunks(tmp_path / "swing.glb")
    (ball,) = set(replay.bodies) - {"plane", "physics"}
    assert [(look.begin, look.end) for look in replay.bodies[ball].looks] == [(16, 31)]
    (animation,) = document["animations"]
    (scale,) = (it for it in animation["channels"] if it["target"]["path"] == "scale")
    sampler = animation["samplers"][scale["sampler"]]
    assert sampler["interpolation"] == "STEP"
    times = _accessor(document, buffer, sampler["input"])[:, 0]
    assert times == pytest.approx([0, replay.clock[16], replay.clock[31]], abs=1e-6)
    sizes = _accessor(document, buffer, sampler["output"])
    assert sizes == pytest.approx(np.array([[0] * 3, [0.25] * 3, [0] * 3]))


def test_gltf_has_colours_as_light_and_images(replay: Replay, tmp_path: Path) -> None:
    carom.replay.export(replay, tmp_path / "swing.glb")
    document, buffer = _chunks(tmp_path / "swing.glb")
    surfaces = [material["pbrMetallicRoughness"] for material in document["materials"]]
    # Coordinates of images only where there is one.
    coordinates = ["TEXCOORD_0" in mesh["primitives"][0]["attributes"] for mesh in document["meshes"]]
    assert sum(coordinates) == 1 < len(coordinates)
    (image,) = document["images"]
    view = document["bufferViews"][image["bufferView"]]
    file = buffer[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    assert Image.open(io.BytesIO(file)).size[0] > 1
    assert sum("baseColorTexture" in surface for surface in surfaces) == 1
    colours = {shape.rgba for look in replay.bodies["physics"].looks for shape in look.shapes}
    expected = {
        tuple(
            np.round(
                [*(((c + 0.055) / 1.055) ** 2.4 if c > 0.04045 else c / 12.92 for c in rgba[:3]), rgba[3]], 6
            )
        )
        for rgba in colours
    }
    assert expected <= {tuple(np.round(surface["baseColorFactor"], 6)) for surface in surfaces}


def test_gltf_opens_in_pygltflib(replay: Replay, tmp_path: Path) -> None:
    pygltflib = pytest.importorskip("pygltflib", reason="reads glTF; `make test-all` installs it")
    carom.replay.export(replay, tmp_path / "swing.glb")
    document = pygltflib.GLTF2().load(str(tmp_path / "swing.glb"))
    assert len(document.animations) == 1
    names = {node.name for node in document.nodes}
    assert {"physics", "cart", "pole", "plane"} <= names
    root = document.nodes[document.scenes[0].nodes[0]]
    assert len(root.children) == len(replay.bodies)
    assert all(mesh.primitives[0].attributes.NORMAL is not None for mesh in document.meshes)


def test_gltf_stands_upright_in_trimesh(replay: Replay, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="reads glTF with the transforms of its nodes")
    carom.replay.export(replay, tmp_path / "swing.glb")
    scene = trimesh.load(tmp_path / "swing.glb")
    link = replay.bodies["physics"].links["cart"].pose[0, :3]
    matrix, _ = scene.graph.get("cart")
    assert BACK @ matrix[:3, 3] == pytest.approx(link, abs=1e-6)


def test_transparent_and_mirrored_things_of_gltf(tmp_path: Path) -> None:
    world = World()
    with world.record(tmp_path / "glass.html"):
        world.add_box((0.1, 0.1, 0.1), position=(0, 0, 1), mass=0.0, colour=(1, 0, 0, 0.5))
        world.step(4)
    carom.replay.export(tmp_path / "glass.html", tmp_path / "glass.glb")
    document, _ = _chunks(tmp_path / "glass.glb")
    (material,) = document["materials"]
    assert material["alphaMode"] == "BLEND"
    assert material["pbrMetallicRoughness"]["baseColorFactor"] == [1, 0, 0, 0.5]
    # Nothing moves, and there is no image: glTF forbids empty lists.
    assert not {"animations", "images", "textures"} & document.keys()


def test_a_glb_without_arrays_is_the_document_alone() -> None:
    data = Glb().packed({"asset": {"version": "2.0"}, "nodes": []})
    (length,) = struct.unpack_from("<I", data, 12)
    assert json.loads(data[20:]) == {"asset": {"version": "2.0"}}
    assert len(data) == 20 + length


def test_mcap_is_read_by_its_own_library(replay: Replay, tmp_path: Path) -> None:
    pytest.importorskip("foxglove", reason="writes MCAP; `make test-all` installs it")
    reader = pytest.importorskip("mcap.reader", reason="reads MCAP; `make test-all` installs it")
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    lost = carom.replay.export(replay, tmp_path / "swing.mcap")
    assert (
        lost == ("images on shapes", "velocities of links and loads of joints", lost[-1])[-len(lost) :]
        or lost
    )
    told: dict[str, list[tuple[int, Any]]] = {}
    with (tmp_path / "swing.mcap").open("rb") as stream:
        for schema, channel, message in reader.make_reader(stream).iter_messages():
            if channel.message_encoding == "json":
                value = json.loads(message.data)
            else:
                files = FileDescriptorSet.FromString(schema.data)
                pool = DescriptorPool()
                for file in files.file:
                    pool.Add(file)
                value = GetMessageClass(pool.FindMessageTypeByName(schema.name)).FromString(message.data)
            told.setdefault(channel.topic, []).append((message.log_time, value))
    count = len(replay.times)
    assert [time for time, _ in told["/tf"]] == np.rint(replay.clock * 1e9).astype(int).tolist()
    pole = replay.bodies["physics"].links["pole"].pose
    for frame in (0, 20, count - 1):
        found = {it.child_frame_id: it for it in told["/tf"][frame][1].transforms}
        at = found["physics/pole"]
        assert at.parent_frame_id == "world"
        assert [at.translation.x, at.translation.y, at.translation.z] == pytest.approx(pole[frame, :3])
        turn = at.rotation
        assert [turn.x, turn.y, turn.z, turn.w] == pytest.approx(pole[frame, 3:])
    (ball,) = set(replay.bodies) - {"plane", "physics"}
    present = [any(it.child_frame_id.startswith(f"{ball}/") for it in tf.transforms) for _, tf in told["/tf"]]
    assert present == replay.bodies[ball].present.tolist()
    (shown_at, shown), (gone_at, gone) = told[f"/scene/{ball}"]
    assert [shown_at, gone_at] == np.rint(replay.clock[[16, 31]] * 1e9).astype(int).tolist()
    (entity,) = shown.entities
    (triangles,) = entity.triangles
    points = np.array([[point.x, point.y, point.z] for point in triangles.points])
    assert np.linalg.norm(points, axis=1) == pytest.approx(0.25, abs=1e-3)
    assert max(triangles.indices) < len(points)
    assert not gone.entities
    assert len(gone.deletions) == 1
    states = {joint.name: joint for joint in told["/joints/physics"][20][1].joints}
    joint = replay.bodies["physics"].joints["cart_to_pole"]
    assert states["cart_to_pole"].position == pytest.approx(joint.position[20])
    assert states["cart_to_pole"].velocity == pytest.approx(joint.velocity[20])
    contacts = told["/contacts"][25][1]["contacts"]
    assert {tuple(contact["bodies"]) for contact in contacts} == {("plane", ball)}
    assert sum(contact["normal_force"] for contact in contacts) == pytest.approx(9.81, rel=0.02)


def test_rrd_is_read_by_rerun(replay: Replay, tmp_path: Path) -> None:
    pytest.importorskip("rerun", reason="writes .rrd, and reads it: pip install rerun-sdk")
    chunks = pytest.importorskip("rerun.chunk", reason="reads .rrd; it is there from 0.41 on")
    carom.replay.export(replay, tmp_path / "swing.rrd")
    (recording,) = chunks.RrdReader(tmp_path / "swing.rrd").recordings()
    assert recording.application_id == "carom"
    columns: dict[tuple[str, str], list[Any]] = {}
    times: dict[str, list[float]] = {}
    for chunk in chunks.RrdReader(tmp_path / "swing.rrd").stream():
        batch = chunk.to_record_batch()
        # Python's times have no nanoseconds.
        for name in (it for it in batch.schema.names if ":" in it and "RecordingInfo" not in it):
            columns.setdefault((chunk.entity_path, name), []).extend(batch.column(name).to_pylist())
        if "time" in batch.schema.names:
            nanoseconds = batch.column("time").cast("int64").to_pylist()
            times.setdefault(chunk.entity_path, []).extend(1e-9 * value for value in nanoseconds)
    pole = "/world/physics/pole"
    assert times[pole] == pytest.approx(replay.clock, abs=1e-8)
    pose = replay.bodies["physics"].links["pole"].pose
    assert np.squeeze(columns[pole, "Transform3D:translation"], 1) == pytest.approx(pose[:, :3], abs=1e-6)
    assert np.squeeze(columns[pole, "Transform3D:quaternion"], 1) == pytest.approx(pose[:, 3:], abs=1e-6)
    scalars = columns["/joints/physics/cart_to_pole/position", "Scalars:scalars"]
    position = replay.bodies["physics"].joints["cart_to_pole"].position
    assert np.squeeze(scalars, 1) == pytest.approx(position)
    (ball,) = set(replay.bodies) - {"plane", "physics"}
    (mesh,) = (
        entity for entity, name in columns if name == "Mesh3D:vertex_positions" and f"/{ball}/" in entity
    )
    assert sorted(times[mesh]) == pytest.approx(replay.clock[[16, 31]], abs=1e-8)
    assert len(columns["/world/contacts", "Arrows3D:vectors"]) == len(replay.times)


def test_times_of_rrd_begin_at_0_without_rerun(replay: Replay) -> None:
    rerun = MagicMock()
    _Writer(replace(replay, clock=replay.clock + 5.0), rerun, MagicMock()).write()
    told = [call.kwargs["duration"] for call in rerun.TimeColumn.call_args_list]
    assert min(times[0] for times in told) == 0.0
    assert max(times[-1] for times in told) == pytest.approx(replay.clock[-1] - replay.clock[0])


def test_the_command_line_exports_and_says_what_is_lost(
    page: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", str(page), str(tmp_path / "swing.glb")]) == 0
    first, *rest = capsys.readouterr().out.splitlines()
    assert first == f"Wrote {tmp_path / 'swing.glb'}"
    assert "- contacts" in rest
    assert (tmp_path / "swing.glb").stat().st_size > 1000


@each(
    ("name", "reason"),
    [
        ("it.gltf", "it is written by its ending, which has to be .glb, .mcap, .rrd"),
        ("no/it.glb", "no such folder"),
    ],
)
def test_wrong_names_are_refused(name: str, reason: str, page: Path, tmp_path: Path, capsys) -> None:
    assert main(["export", str(page), str(tmp_path / name)]) == 1
    assert reason in capsys.readouterr().err


def test_a_replay_without_frames_is_refused(replay: Replay, tmp_path: Path) -> None:
    from dataclasses import replace

    with pytest.raises(ValueError, match="the replay 'swing' has no frames"):
        carom.replay.export(replace(replay, times=np.zeros(0)), tmp_path / "it.glb")


@each(("ending", "extra"), [("mcap", "foxglove"), ("rrd", "rerun")])
def test_a_package_that_is_missing_is_named(
    ending: str, extra: str, page: Path, tmp_path: Path, capsys, monkeypatch: pytest.MonkeyPatch
) -> None:
    imported = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == extra:
            raise ImportError(name)
        return imported(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    assert main(["export", str(page), str(tmp_path / f"it.{ending}")]) == 1
    assert f"pip install 'carom[{extra}]'" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@each("ending", ["mcap", "rrd"])
def test_nothing_is_left_of_an_export_that_fails(ending: str, replay: Replay, tmp_path: Path) -> None:
    pytest.importorskip({"mcap": "foxglove", "rrd": "rerun"}[ending], reason="writes the file")
    from dataclasses import replace

    folder = tmp_path / ending
    folder.mkdir()
    file = folder / f"it.{ending}"
    file.write_text("old")
    with pytest.raises(AttributeError):
        carom.replay.export(replace(replay, contacts=None), file)
    assert file.read_text() == "old"
    assert list(folder.iterdir()) == [file]
    with pytest.raises(FileNotFoundError):
        carom.replay.export(replay, tmp_path / "no" / file.name)
