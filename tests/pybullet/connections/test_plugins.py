"""Plugins: ids and answers are PyBullet's; files are found in zip archives."""

import pkgutil
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data
from carom.formats import archives
from pybullet._clients.clients import clients

DATA = Path(pybullet_data.getDataPath())


@pytest.fixture
def archive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A zip file with a robot and its mesh, and another zip file with one more robot."""
    with zipfile.ZipFile(tmp_path / "inner.zip", "w") as inner:
        inner.write(DATA / "cartpole.urdf", "deep/cart.urdf")
    with zipfile.ZipFile(tmp_path / "outer.zip", "w") as outer:
        outer.writestr(
            "robots/cube.urdf", (DATA / "cube_small.urdf").read_text().replace("cube.obj", "mesh.obj")
        )
        outer.write(DATA / "cube.obj", "robots/mesh.obj")
        outer.write(tmp_path / "inner.zip", "inner.zip")
        outer.writestr("../outside.txt", "no")
    (tmp_path / "inner.zip").unlink()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    p.connect(p.DIRECT)
    yield tmp_path / "outer.zip"
    if p.isConnected():
        p.disconnect()


def found(name: str) -> bool:
    try:
        p.loadURDF(name)
    except p.error:
        return False
    return True


def test_files_in_archives_are_found(archive: Path) -> None:
    plugin = p.loadPlugin("fileIOPlugin")
    assert plugin == p.loadPlugin("fileIOPlugin") == 3
    assert not found("robots/cube.urdf")
    add = [p.AddFileIOAction, p.ZipFileIO]
    assert p.executePluginCommand(plugin, str(archive), add) == 1
    assert p.executePluginCommand(plugin, str(archive), add) == 1
    assert found("robots/cube.urdf")
    assert p.getVisualShapeData(0)[0][4].endswith(b"mesh.obj")
    assert p.executePluginCommand(plugin, "inner.zip", add) == 2
    assert found("deep/cart.urdf")
    assert p.executePluginCommand(plugin, "", [p.RemoveFileIOAction, 1]) == 1
    assert not found("robots/cube.urdf")
    assert found("deep/cart.urdf")
    p.resetSimulation()
    assert found("deep/cart.urdf")
    p.unloadPlugin(plugin)
    p.unloadPlugin(99)
    assert not found("deep/cart.urdf")
    assert p.executePluginCommand(plugin, str(archive), add) == -1
    assert not (archive.parent / "outside.txt").exists()


def _members_on_disk() -> set[str]:
    """Names of the files in the temporary folder of the archive in slot 1."""
    place = clients[0].plugins.places[1]
    assert not isinstance(place, Path)
    return {path.name for path in place.folder.rglob("*") if path.is_file()}


def test_members_are_unpacked_when_they_are_asked_for(archive: Path) -> None:
    plugin = p.loadPlugin("fileIOPlugin")
    p.executePluginCommand(plugin, str(archive), [p.AddFileIOAction, p.ZipFileIO])
    assert _members_on_disk() == set()
    assert found("robots/cube.urdf")
    assert _members_on_disk() == {"cube.urdf", "mesh.obj"}
    assert found("outside.txt") is False
    assert p.createCollisionShape(p.GEOM_MESH, fileName="robots/../robots/mesh.obj") >= 0


def test_members_may_have_so_many_bytes(
    archive: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as bomb:
        bomb.writestr("small.urdf", (DATA / "cartpole.urdf").read_text())
        bomb.writestr("big.urdf", bytes(100_000))
        bomb.writestr("big.png", bytes(100_000))
    monkeypatch.setattr(archives, "MAX_MEMBER_BYTES", 99_999)
    plugin = p.loadPlugin("fileIOPlugin")
    assert p.executePluginCommand(plugin, str(tmp_path / "bomb.zip"), [p.AddFileIOAction, p.ZipFileIO]) == 1
    assert found("small.urdf")
    stated = r"bomb.zip: its member 'big.{}' has 100000 bytes; at most 99999 are accepted"
    with pytest.raises(p.error, match=stated.format("urdf")):
        p.loadURDF("big.urdf")
    with pytest.raises(p.error, match=stated.format("png")):
        p.loadTexture("big.png")
    with pytest.raises(p.error, match=stated.format("urdf")):
        p.loadMJCF("big.urdf")
    assert _members_on_disk() == {"small.urdf"}
    monkeypatch.setattr(archives, "MAX_MEMBER_BYTES", 100_000)
    monkeypatch.setattr(archives, "MAX_BYTES", 100_000)
    with pytest.raises(p.error, match=r"of the 100000 accepted for all members \d+ are left"):
        p.loadURDF("big.urdf")


def test_folders_are_searched(archive: Path, tmp_path: Path) -> None:
    plugin = p.loadPlugin("fileIOPlugin")
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "cart.urdf").write_bytes((DATA / "cartpole.urdf").read_bytes())
    assert p.executePluginCommand(plugin, str(tmp_path / "own"), [p.AddFileIOAction, p.PosixFileIO]) == 1
    assert found("cart.urdf")


def test_what_cannot_be_done_is_minus_one(
    archive: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    plugin = p.loadPlugin("fileIOPlugin")
    (tmp_path / "bad.zip").write_bytes(b"PK rubbish")
    for name, numbers in (
        ("missing.zip", [p.AddFileIOAction, p.ZipFileIO]),
        (str(tmp_path / "bad.zip"), [p.AddFileIOAction, p.ZipFileIO]),
        ("x", [p.AddFileIOAction, p.CNSFileIO]),
        ("x", [5]),
        ("x", None),
    ):
        assert p.executePluginCommand(plugin, name, numbers) == -1
    assert p.executePluginCommand(99, "x", [1], [0.5]) == -1
    assert len(caplog.records) == 6
    with pytest.raises(p.error):
        p.executePluginCommand(plugin, "x", 5)  # type: ignore[arg-type]


def test_other_plugins_say_what_they_are(archive: Path, caplog: pytest.LogCaptureFixture) -> None:
    names = ("pdControlPlugin", "collisionFilterPlugin", "tinyRendererPlugin")
    assert [p.loadPlugin(name) for name in names] == [0, 1, 2]
    assert p.executePluginCommand(0, "", [1]) == -1
    assert "PD_CONTROL" in caplog.records[-1].message
    assert p.loadPlugin("eglRendererPlugin", "_eglRendererPlugin") == -1
    assert "getCameraImage" in caplog.records[-1].message
    assert p.loadPlugin("/somewhere/libmine.so") == -1
    assert "PyBullet's engine" in caplog.records[-1].message


@pytest.mark.skipif(sys.version_info >= (3, 14), reason="pkgutil has no get_loader any more")
def test_the_renderer_that_scripts_look_for_is_found_and_loaded(client: int) -> None:
    found = pkgutil.get_loader("eglRenderer")
    assert found is not None
    plugin = p.loadPlugin(found.get_filename(), "_eglRendererPlugin")  # type: ignore[attr-defined]
    assert plugin == 4
    image = p.getCameraImage(8, 8, renderer=p.ER_BULLET_HARDWARE_OPENGL)
    assert image[:2] == (8, 8)
    p.unloadPlugin(plugin)
