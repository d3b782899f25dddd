"""pip takes from a local index what is there, and the errors say what is not."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from tools.wheels import index
from tools.wheels.faults import Unfit

from carom.native.targets import TARGETS


def make_wheel(folder: Path, tag: str) -> Path:
    """A wheel with nothing in it but its metadata."""
    wheel = folder / f"carom-1.0-py3-none-{tag}.whl"
    about = "carom-1.0.dist-info"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr(f"{about}/METADATA", "Metadata-Version: 2.1\nName: carom\nVersion: 1.0\n")
        archive.writestr(
            f"{about}/WHEEL", f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: py3-none-{tag}\n"
        )
        archive.writestr(f"{about}/RECORD", "")
    return wheel


def test_pip_takes_the_wheel_of_the_platform(tmp_path: Path):
    wheels = [make_wheel(tmp_path, tag) for tag in ("win_amd64", "win_arm64", "macosx_11_0_arm64")]
    simple = index.make_index(wheels, tmp_path / "index")
    assert index._download(simple, "win_arm64", "3.15") == "carom-1.0-py3-none-win_arm64.whl"
    with pytest.raises(Unfit, match=r"pip finds nothing for musllinux_1_2_x86_64 and Python 3\.10"):
        index._download(simple, "musllinux_1_2_x86_64", "3.10")


def test_all_platforms_and_versions_are_asked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    asked: list[tuple[str, str]] = []

    def download(simple: Path, platform: str, version: str) -> str:
        asked.append((platform, version))
        return f"carom-1.0-py3-none-{platform}.whl"

    monkeypatch.setattr(index, "_download", download)
    count = index.check_downloads(tmp_path)
    assert count == len(set(asked)) == len(asked)
    assert {tag for tag, _ in asked} == {tag for target in TARGETS.values() for tag in target.wheel_tags}
    assert {version for _, version in asked} == {f"3.{minor}" for minor in range(10, 16)}
    monkeypatch.setattr(index, "_download", lambda *_: "carom-1.0-py3-none-win_amd64.whl")
    with pytest.raises(Unfit, match=r"for manylinux_2_28_x86_64 and Python 3\.10 pip takes carom-1\.0"):
        index.check_downloads(tmp_path)
