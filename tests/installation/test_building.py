"""What builds wheels and editable installs, without compiling anything."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from carom.native.building import library
from carom.native.targets import TARGETS, this_target

ROOT = Path(__file__).parents[2]

pytest.importorskip("hatchling", reason="it builds the wheels")


@pytest.fixture
def hook() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def built(hook: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[tuple[str, list[str]]]:
    """Which libraries are built: platforms and levels. They are text files here."""
    asked: list[tuple[str, list[str]]] = []

    def build(root: Path, target: Any, levels: list[str]) -> list[Path]:
        asked.append((target.name, list(levels)))
        made = [tmp_path / target.library_name(level) for level in levels] + [tmp_path / "manifest.json"]
        for path in made:
            path.write_text(f"build {len(asked)}")
        return made

    monkeypatch.setattr(hook, "_build", build)
    return asked


def test_a_clone_gets_the_library_of_its_processor_and_the_next_one_takes_its_place(
    hook: ModuleType, built: list[tuple[str, list[str]]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    monkeypatch.delenv("CAROM_CPU_LEVEL", raising=False)
    monkeypatch.setenv(hook.TARGET_VARIABLE, "no platform: wheels alone are for others")
    place = tmp_path / "carom" / "native" / "libraries"
    place.parent.mkdir(parents=True)
    for count in (1, 2):
        hook._build_for_clone(tmp_path)
        ((name, (level,)),) = {(name, tuple(levels)) for name, levels in built}
        assert name == this_target().name
        assert level in this_target().shipped
        files = {path.name: path.read_text() for path in place.iterdir()}
        assert files == dict.fromkeys([this_target().library_name(level), "manifest.json"], f"build {count}")


def test_a_wheel_gets_the_libraries_of_all_levels_and_the_tags_of_its_platform(
    hook: ModuleType, built: list[tuple[str, list[str]]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    monkeypatch.setenv(hook.TARGET_VARIABLE, "x86_64-windows")
    data: dict[str, Any] = {"force_include": {}}
    hook._build_for_wheel(tmp_path, data)
    assert built == [("x86_64-windows", ["v2", "v3"])]
    assert (data["tag"], data["pure_python"]) == ("py3-none-win_amd64", False)
    libraries, others = [], []
    for place in sorted(data["force_include"].values()):
        (libraries if place.startswith("carom/native/") else others).append(place)
    assert libraries == [
        "carom/native/libraries/carom-x86_64-windows-v2.dll",
        "carom/native/libraries/carom-x86_64-windows-v3.dll",
        "carom/native/libraries/manifest.json",
    ]
    # Examples and the manual lie outside the package.
    assert {"carom/examples/scripts/hold_arm.py", "carom/manual/index.md"} <= set(others)


def test_a_platform_that_there_is_not_is_named(hook: ModuleType, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv(hook.TARGET_VARIABLE, "amiga")
    with pytest.raises(SystemExit, match=r"CAROM_BUILD_TARGET is 'amiga'; expected one of x86_64-linux, "):
        hook._build_for_wheel(ROOT / "src", {})


def test_levels_that_are_not_in_wheels_are_used_if_no_other_is_offered():
    target = TARGETS["x86_64-linux"]
    assert target.usable_levels(["v4", "v3", "v2"]) == ["v3", "v2"]
    assert target.usable_levels(["v4"]) == ["v4"]
    assert target.usable_levels(["v9"]) == []


def test_the_code_generator_finds_what_this_process_finds_and_our_kernels_first(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    """pip tells the folders of a build's environment to one process, not to those that it starts."""
    monkeypatch.setattr(sys, "path", ["", str(tmp_path / "of pip"), *sys.path])
    folders = library._search_path(tmp_path / "root").split(os.pathsep)
    assert folders[:2] == [str(tmp_path / "root"), str(tmp_path / "of pip")]
    assert "" not in folders
