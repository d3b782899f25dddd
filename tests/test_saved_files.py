"""What saved worlds take along, where they are written, and what damaged ones may cost."""

from __future__ import annotations

import json
import os
import stat
import struct
import sys
from hashlib import sha256
from pathlib import Path
from time import perf_counter
from types import GenericAlias
from typing import Any, TypeVar

import pytest

import pybullet as p
from carom import World
from carom.errors import DescriptionError
from carom.world_files import container
from carom.world_files.records import Reader
from carom.world_files.references import is_image, references

PNG = b"\x89PNG\r\n\x1a\n" + bytes(20)
CORNERS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"
POSIX = pytest.mark.skipif(os.name == "nt", reason="there are no such files")


def save_with_mesh(folder: Path, text: str) -> bytes:
    """A saved world with a body that has this OBJ file."""
    mesh = folder / "mesh.obj"
    mesh.write_text(text, encoding="utf-8")
    client = p.connect(p.DIRECT)
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_MESH, fileName=str(mesh)))
    p.saveBullet(str(folder / "world.bullet"))
    p.disconnect(client)
    return (folder / "world.bullet").read_bytes()


def test_materials_and_images_go_along(tmp_path: Path) -> None:
    (tmp_path / "look.mtl").write_text("newmtl a\nmap_Kd -s 1 1 1 image.png\n")
    (tmp_path / "image.png").write_bytes(PNG + b"the image")
    data = save_with_mesh(tmp_path, "mtllib look.mtl\n" + CORNERS)
    assert b"map_Kd" in data
    assert b"the image" in data


@POSIX
def test_other_files_stay(tmp_path: Path) -> None:
    secret = b"root:x:0:0"
    for name in ("secret", "secret.txt", "secret.png", "notes.mtl.bak"):
        (tmp_path / name).write_bytes(secret)
    (tmp_path / "link.mtl").symlink_to("secret")
    (tmp_path / "link.png").symlink_to("secret")
    (tmp_path / "look.mtl").write_text(
        "map_Kd secret.png\nmap_Kd link.png\nmap_Kd secret\nmap_Kd /etc/passwd\n"
    )
    names = ("secret", "secret.txt", "link.mtl", "/etc/passwd", "look.mtl", "a\0b")
    data = save_with_mesh(tmp_path, "".join(f"mtllib {name}\n" for name in names) + CORNERS)
    assert b"map_Kd" in data
    assert secret not in data
    assert b"root:" not in data


def test_references_of_a_scene(tmp_path: Path) -> None:
    (tmp_path / "a b.png").write_bytes(PNG)
    text = b"<init_from>file://a b.png</init_from><init_from> a b.png </init_from><init_from>x"
    assert references(tmp_path / "scene.dae", text) == [tmp_path / "a b.png"]
    assert is_image(bytes([0, 0, 2]), ".tga")
    assert not is_image(b"roo", ".tga")


def test_all_types_of_tga_files_are_images() -> None:
    # The types of the format: with a palette, with colours, grey; and the same compressed.
    assert [kind for kind in range(256) if is_image(bytes([0, 0, kind]), ".tga")] == [1, 2, 3, 9, 10, 11]


def test_bodies_cannot_be_made_of_a_file_that_pybullet_wrote() -> None:
    file = Path(__file__).parent / "pybullet" / "engine" / "bullet_files" / "arms.bullet"
    world = World()
    with pytest.raises(DescriptionError, match=r"arms\.bullet: PyBullet wrote this file.*restore"):
        world.load(file)
    assert not world.bodies


@pytest.mark.parametrize("suffix", [".obj", ".mtl", ".dae"])
@pytest.mark.parametrize("piece", [b"\n", b" ", b"mtllib ", b"map_Kd", b"<init_from>", b"<init_from> "])
def test_looking_for_references_takes_linear_time(tmp_path: Path, suffix: str, piece: bytes) -> None:
    data = piece * 200_000
    start = perf_counter()
    references(tmp_path / f"file{suffix}", data)
    assert perf_counter() - start < 2.0


@POSIX
def test_permissions_links_and_devices_are_kept(tmp_path: Path) -> None:
    client = p.connect(p.DIRECT)
    before = os.umask(0o027)
    try:
        new, old, link = (tmp_path / name for name in ("new", "old", "link"))
        p.saveBullet(str(new))
        assert stat.S_IMODE(new.stat().st_mode) == 0o640
        old.touch()
        old.chmod(0o604)
        p.saveBullet(str(old))
        assert stat.S_IMODE(old.stat().st_mode) == 0o604
        link.symlink_to("new")
        new.write_bytes(b"")
        p.saveBullet(str(link))
        assert link.is_symlink()
        assert new.stat().st_size > 0
        link.unlink()
        link.symlink_to(link)
        with pytest.raises(p.error, match="Couldn't save"):
            p.saveBullet(str(link))
        assert link.is_symlink()
        p.saveBullet("/dev/null")
        assert Path("/dev/null").is_char_device()
    finally:
        os.umask(before)
        p.disconnect(client)


@POSIX
def test_what_cannot_be_written_is_refused(tmp_path: Path) -> None:
    client = p.connect(p.DIRECT)
    longest = "x" * 255
    p.saveBullet(str(tmp_path / longest))
    os.mkfifo(tmp_path / "pipe")
    for name in ("pipe", "", "no/such", longest + "x", "a\0b"):
        with pytest.raises(p.error, match="Couldn't save"):
            p.saveBullet(str(tmp_path / name))
    assert {path.name for path in tmp_path.iterdir()} == {longest, "pipe"}
    p.disconnect(client)


@POSIX
def test_pipes_and_devices_are_no_files_to_load(tmp_path: Path) -> None:
    client = p.connect(p.DIRECT)
    os.mkfifo(tmp_path / "pipe.obj")
    robot = tmp_path / "robot.urdf"
    robot.write_text(
        "<robot name='r'><link name='a'><collision><geometry><mesh filename='pipe.obj'/></geometry>"
        "</collision></link></robot>"
    )
    for name in (tmp_path / "pipe.obj", "/dev/zero", robot):
        for load in (p.loadURDF, p.loadSDF, p.loadMJCF, p.loadBullet, p.loadTexture):
            with pytest.raises(p.error):
                load(str(name))
    with pytest.raises(p.error, match="not a regular file"):
        p.loadURDF("/dev/zero")
    p.disconnect(client)


def changed(path: Path, change: Any) -> None:
    """Changes the document of a saved world, whose checksum is right again then."""
    data = path.read_bytes()
    document, blocks = container.unpacked(data, path)
    change(document)
    text = json.dumps(document).encode()
    payload = struct.pack("<Q", len(text)) + text + bytes(blocks)
    header = struct.pack("<8sIIQ32s", container.MAGIC, 1, 0, len(payload), sha256(payload).digest())
    path.write_bytes(header + payload)


@pytest.mark.parametrize("count", ["links", "positions", "dofs"])
@pytest.mark.parametrize("value", [10**9, -1, 2**62])
def test_counts_in_a_file_ask_for_no_memory(tmp_path: Path, count: str, value: int) -> None:
    path = tmp_path / "world.bullet"
    client = p.connect(p.DIRECT)
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=1))
    p.saveBullet(str(path))

    def change(document: dict[str, Any]) -> None:
        document["state"]["bodies"][0][count] = value

    changed(path, change)
    for load in (lambda: p.loadBullet(str(path)), lambda: p.restoreState(fileName=str(path))):
        with pytest.raises(p.error, match="does not have the rows"):
            load()
    assert p.getNumBodies() == 1
    p.disconnect(client)


def test_a_world_that_lost_a_body_can_be_saved_at_once(tmp_path: Path) -> None:
    path = str(tmp_path / "world.bullet")
    client = p.connect(p.DIRECT)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    bodies = [p.createMultiBody(1, ball, basePosition=[place, 0, 0.2]) for place in range(4)]
    for _ in range(60):
        p.stepSimulation()
    p.removeBody(bodies[0])
    p.saveBullet(path)

    def after(client: int) -> list[Any]:
        for _ in range(20):
            p.stepSimulation(physicsClientId=client)
        return [p.getBasePositionAndOrientation(body, physicsClientId=client) for body in bodies[1:]]

    other = p.connect(p.DIRECT)
    p.loadBullet(path, physicsClientId=other)
    first = after(client)
    p.restoreState(fileName=path)
    assert first == after(client) == after(other)
    p.disconnect(other)
    p.disconnect(client)


@pytest.mark.skipif(sys.platform == "win32", reason="the archive is made by hand")
@pytest.mark.parametrize("method", [8, 12, 14])
def test_damaged_archives_are_refused(tmp_path: Path, method: int) -> None:
    import zipfile

    archive = tmp_path / "robots.zip"
    with zipfile.ZipFile(archive, "w", method) as file:
        file.writestr("robot.urdf", "<robot/>" * 1000)
    whole = archive.read_bytes()
    client = p.connect(p.DIRECT)
    plugin = p.loadPlugin("fileIOPlugin")
    for place in range(30, len(whole) - 70):
        archive.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        slot = p.executePluginCommand(plugin, str(archive), [p.AddFileIOAction, p.ZipFileIO])
        assert slot >= -1
        if slot >= 0:
            p.executePluginCommand(plugin, "", [p.RemoveFileIOAction, slot])
    p.disconnect(client)


def test_aliases_of_types_are_looked_through(tmp_path: Path) -> None:
    # As `NDArray` is one of NumPy from 2.5 on, where Python has statements for them.
    class Alias:
        __value__ = list[TypeVar("Item")]  # type: ignore[misc]

    reader = Reader(tmp_path, memoryview(b""), [])
    assert reader.read(GenericAlias(Alias(), (int,)), [1, 2], "here") == [1, 2]  # type: ignore[arg-type]
