"""The distribution that packages which require PyBullet are satisfied with."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from importlib.metadata import Distribution, distributions
from pathlib import Path

import pytest
from packaging.specifiers import SpecifierSet
from packaging.utils import parse_wheel_filename

from carom.cli import stand_in
from carom.cli.command_line import main

pytest.importorskip("pip")


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Distribution:
    """The stand-in, as pip installs it."""
    folder = tmp_path_factory.mktemp("stand_in")
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--target"]
    subprocess.run([*command, folder / "site", stand_in.write(folder / "new")], check=True, timeout=120)
    (found,) = distributions(path=[str(folder / "site")])
    return found


def test_it_has_the_name_and_no_files_but_its_metadata(installed):
    assert installed.metadata["Name"] == "pybullet"
    assert installed.files
    assert {file.parts[0] for file in installed.files} == {"pybullet-3.2.7+carom.dist-info"}


@pytest.mark.parametrize("required", ["", "==3.2.7", ">=3.2.5", "~=3.2", "<3.3"])
def test_it_satisfies_what_pybullet_would_satisfy(installed, required):
    assert installed.version in SpecifierSet(required)


def test_it_requires_carom(installed):
    assert installed.requires == ["carom"]


def test_its_file_name_is_that_of_its_version(tmp_path):
    name, version, _, tags = parse_wheel_filename(stand_in.write(tmp_path).name)
    assert (name, str(version)) == ("pybullet", stand_in.VERSION)
    assert [str(tag) for tag in tags] == ["py3-none-any"]


def test_it_is_the_same_at_every_call(tmp_path):
    first, second = (stand_in.write(tmp_path / name).read_bytes() for name in "ab")
    assert first == second


def test_the_command_writes_its_wheel_and_installs_nothing(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(stand_in, "install", None)
    assert main(["stand-in", "--wheel", str(tmp_path)]) == 0
    (wheel,) = tmp_path.iterdir()
    assert capsys.readouterr().out == f"Wrote {wheel}\n"
    assert zipfile.is_zipfile(wheel)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[list[str]]:
    """The commands that are run, which do nothing, in an environment without a distribution `pybullet`."""
    commands: list[list[str]] = []

    def call(command: list[str], *, check: bool) -> subprocess.CompletedProcess[str]:
        assert not check
        commands.append(command)
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(subprocess, "run", call)
    monkeypatch.setattr(stand_in, "mkdtemp", lambda prefix: str(tmp_path / prefix))
    monkeypatch.setattr(stand_in, "_pybullet", lambda: None)
    return commands


def without_pip(monkeypatch: pytest.MonkeyPatch, uv: str | None) -> None:
    monkeypatch.setattr(stand_in, "find_spec", lambda name: None)
    monkeypatch.setattr("shutil.which", lambda name: uv)


def test_the_command_installs_with_pip(calls, tmp_path, capsys):
    assert main(["stand-in"]) == 0
    ((program, *words),) = calls
    assert program == sys.executable
    assert words[:3] == ["-m", "pip", "install"]
    assert "3.2.7+carom" in capsys.readouterr().out
    assert not list(tmp_path.iterdir())


def test_the_command_installs_with_uv_where_there_is_no_pip(calls, monkeypatch):
    without_pip(monkeypatch, "/bin/uv")
    assert main(["stand-in"]) == 0
    assert calls[0][:5] == ["/bin/uv", "pip", "install", "--python", sys.executable]


def test_without_pip_and_uv_the_command_says_where_the_wheel_is(calls, monkeypatch, tmp_path, capsys):
    without_pip(monkeypatch, None)
    assert main(["stand-in"]) == 1
    (wheel,) = (tmp_path / "carom-").iterdir()
    assert f"Install {wheel} " in capsys.readouterr().err
    assert not calls


def test_the_command_fails_if_pip_does(calls, monkeypatch, capsys):
    monkeypatch.setattr(subprocess, "run", lambda words, check: subprocess.CompletedProcess(words, 2))
    assert main(["stand-in"]) == 1
    assert "-m pip install" in capsys.readouterr().err


@pytest.mark.parametrize(("version", "status"), [("3.2.7", 1), ("3.2.7+carom", 0)])
def test_the_command_refuses_beside_pybullet_and_not_beside_itself(
    calls, version, status, monkeypatch, capsys
):
    monkeypatch.undo()
    monkeypatch.setattr(stand_in, "version", lambda name: version)
    monkeypatch.setattr(subprocess, "run", lambda words, check: subprocess.CompletedProcess(words, 0))
    assert main(["stand-in"]) == status
    said = capsys.readouterr().err
    assert ("PyBullet 3.2.7 is installed" in said, "pip uninstall -y pybullet" in said) == (status == 1,) * 2
