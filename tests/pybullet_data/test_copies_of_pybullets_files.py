"""The user's own copy of PyBullet's files: verified, served, and given up again."""

from __future__ import annotations

import hashlib
from base64 import urlsafe_b64encode
from pathlib import Path
from zipfile import ZipFile

import pytest

import pybullet_data
from carom.cli.command_line import main

OWN = str(Path(pybullet_data.__file__).parent)
FILES = {
    "plane.urdf": b"<robot name='plane'/>",
    "r2d2.urdf": b"<robot name='r2d2'/>",
    "kuka_iiwa/model.urdf": b"<robot name='kuka'/>",
    "random_urdfs/000/000.obj": b"v 0 0 0\n",
    "__init__.py": b"def getDataPath(): ...\n",
}
RECORD = "pybullet-3.2.9.dist-info/RECORD"


@pytest.fixture(autouse=True)
def user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user without copies, whose folder for data this is."""
    for name in ("XDG_DATA_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "user"))
    monkeypatch.delenv("CAROM_PYBULLET_DATA")
    return tmp_path / "user"


def record(files: dict[str, bytes]) -> str:
    lines = [f"{RECORD},,"]
    for name, data in files.items():
        digest = urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
        lines.append(f"pybullet_data/{name},sha256={digest},{len(data)}")
    return "\n".join(lines) + "\n"


def wheel(path: Path, files: dict[str, bytes], recorded: dict[str, bytes] = FILES) -> Path:
    with ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(f"pybullet_data/{name}", data)
        archive.writestr(RECORD, record(recorded))
        archive.writestr("pybullet.so", b"not wanted")
    return path


def test_the_files_of_a_wheel_are_served(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["data"]) == 0
    assert capsys.readouterr().out == "pybullet_data serves Carom's own files.\n"
    assert pybullet_data.getDataPath() == OWN
    source = wheel(tmp_path / "pybullet.whl", FILES)
    assert main(["data", "--from-pybullet", str(source)]) == 0
    assert "serves the 4 files of PyBullet 3.2.9, in " in capsys.readouterr().out
    source.unlink()
    served = Path(pybullet_data.getDataPath())
    for name, data in FILES.items():
        if not name.endswith(".py"):
            assert (served / name).read_bytes() == data
    assert not (served / "__init__.py").exists()
    assert main(["data", "--own"]) == 0
    assert pybullet_data.getDataPath() == OWN


@pytest.mark.parametrize("place", ["", "pybullet_data"])
def test_the_files_of_an_installed_package_are_served(tmp_path: Path, place: str) -> None:
    with ZipFile(wheel(tmp_path / "pybullet.whl", FILES)) as archive:
        archive.extractall(tmp_path / "site-packages")
    assert main(["data", "--from-pybullet", str(tmp_path / "site-packages" / place)]) == 0
    assert pybullet_data.getDataPath() != OWN


@pytest.mark.parametrize(
    ("files", "complaint"),
    [
        ({**FILES, "plane.urdf": b"<robot name='other'/>"}, "published them: plane.urdf"),
        ({**FILES, "new.obj": b""}, "published them: new.obj"),
        ({n: d for n, d in FILES.items() if not n.endswith("obj")}, "them: random_urdfs/000/000.obj"),
        ({"plane.urdf": b""}, "has no pybullet_data"),
    ],
)
def test_files_that_are_not_as_published_are_refused(
    tmp_path: Path, files: dict[str, bytes], complaint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["data", "--from-pybullet", str(wheel(tmp_path / "pybullet.whl", files))]) == 1
    assert complaint in capsys.readouterr().err
    assert pybullet_data.getDataPath() == OWN


def test_what_is_no_wheel_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.whl").write_bytes(b"nothing")
    assert main(["data", "--from-pybullet", str(tmp_path / "x.whl")]) == 1
    assert "is not a wheel" in capsys.readouterr().err
    # Carom's own files are not PyBullet's.
    assert main(["data", "--from-pybullet", OWN]) == 1
    assert "are not those of PyBullet 3.2.7" in capsys.readouterr().err


def test_changes_of_a_copy_are_noticed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["data", "--from-pybullet", str(wheel(tmp_path / "pybullet.whl", FILES))]) == 0
    Path(pybullet_data.getDataPath(), "random_urdfs", "000", "000.obj").write_bytes(b"v 1 0 0\n")
    capsys.readouterr()
    assert main(["data"]) == 1
    assert "has changed: random_urdfs/000/000.obj;" in capsys.readouterr().err
    Path(pybullet_data.getDataPath(), "plane.urdf").unlink()
    with pytest.raises(FileNotFoundError, match="carom data --own"):
        pybullet_data.getDataPath()


def test_a_variable_names_a_folder_for_one_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with ZipFile(wheel(tmp_path / "pybullet.whl", FILES)) as archive:
        archive.extractall(tmp_path)
    monkeypatch.setenv("CAROM_PYBULLET_DATA", str(tmp_path / "pybullet_data"))
    assert pybullet_data.getDataPath() == str(tmp_path / "pybullet_data")
    monkeypatch.setenv("CAROM_PYBULLET_DATA", "own")
    assert pybullet_data.getDataPath() == OWN
    monkeypatch.setenv("CAROM_PYBULLET_DATA", str(tmp_path / "nowhere"))
    with pytest.raises(FileNotFoundError, match="CAROM_PYBULLET_DATA names it"):
        pybullet_data.getDataPath()
