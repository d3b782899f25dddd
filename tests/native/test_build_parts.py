"""Parts of a build that need no compiler: how old what is kept may be, layouts, and what is shown."""

from __future__ import annotations

import os
import time
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from carom.native import cpu
from carom.native.building.cache import MANIFEST
from carom.native.building.library import _generated_code, _make, _shows
from carom.native.building.progress import ProgressLine
from carom.native.building.prune import prune

DAY = 24 * 3600.0


def test_what_was_not_used_for_thirty_days_is_removed(tmp_path: Path) -> None:
    for name, days in (("young", 29.9), ("old", 30.1)):
        file = tmp_path / "objects" / name
        file.parent.mkdir(exist_ok=True)
        file.touch()
        used = time.time() - days * DAY
        os.utime(file, (used, used))
    prune(tmp_path)
    assert [file.name for file in (tmp_path / "objects").iterdir()] == ["young"]


def test_code_that_is_used_again_counts_as_used_now(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "config.py").touch()
    code = tmp_path / "code" / "key"
    code.mkdir(parents=True)
    os.utime(code, (0.0, 0.0))
    monkeypatch.setattr("carom.native.building.library.content_key", lambda *_: "key")
    parts: Any = SimpleNamespace(digest="", modules=(), warp=tmp_path, cache=tmp_path)
    assert _generated_code(parts) == code
    assert time.time() - code.stat().st_mtime < DAY


def test_several_jobs_are_counted() -> None:
    stream = StringIO()
    line = ProgressLine(stream)
    line._last = float("-inf")
    _shows(line, "compiling")(1, 2)
    line._last = float("-inf")
    _shows(line, "linking")(1, 1)
    assert [text.partition(",")[0] for text in stream.getvalue().splitlines()] == [
        "carom: compiling 1/2",
        "carom: linking",
    ]


def test_the_compiler_checks_where_bounds_of_launches_lie() -> None:
    manifest = pytest.importorskip("carom.native.building.manifest")
    kernels = [
        SimpleNamespace(key=key, adj=SimpleNamespace(args=[], kernel_dim=dimensions))
        for key, dimensions in (("a", 1), ("b", 3))
    ]
    text = manifest.layout_assertions(kernels)
    for dimensions, size, places in ((1, 24, (0, 8, 16)), (3, 32, (0, 16, 24))):
        name = f"wp::launch_bounds_t<{dimensions}>"
        assert f"static_assert(sizeof({name}) == {size}," in text
        for field, place in zip(("shape", "size", "coord_mult"), places, strict=True):
            assert f"static_assert(__builtin_offsetof({name}, {field}) == {place}," in text


@pytest.mark.parametrize(
    ("platform", "has", "levels"),
    [
        ("darwin", {"hw.optional.avx2_0"}, ["v3", "v2"]),
        ("darwin", set(), ["v2"]),
        ("win32", {40, 41}, ["v4", "v3", "v2"]),
        ("win32", {40}, ["v3", "v2"]),
        ("other", {40, 41}, ["v2"]),
    ],
)
def test_each_system_says_in_its_own_way_what_the_processor_has(
    platform: str, has: set[Any], levels: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CAROM_CPU_LEVEL", raising=False)
    monkeypatch.setattr(cpu, "sys", SimpleNamespace(platform=platform))
    monkeypatch.setattr(cpu, "platform", SimpleNamespace(machine=lambda: "AMD64"))
    monkeypatch.setattr(cpu, "_macos_has", has.__contains__)
    kernel32 = SimpleNamespace(IsProcessorFeaturePresent=has.__contains__)
    monkeypatch.setattr(cpu.ctypes, "windll", SimpleNamespace(kernel32=kernel32), raising=False)
    assert cpu.cpu_levels() == levels


def test_the_manifest_of_its_code_is_kept_beside_a_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a compiler and a linker that only write names."""
    code, library = tmp_path / "code", tmp_path / "kept" / "library.so"
    code.mkdir()
    (code / MANIFEST).write_bytes(b"what it is made of")
    place = "carom.native.building.library."
    monkeypatch.setattr(f"{place}_generated_code", lambda _: code)
    monkeypatch.setattr(f"{place}_compiled", lambda *_: [])
    monkeypatch.setattr(f"{place}link_command", lambda *told: told[-1])
    monkeypatch.setattr(f"{place}run_all", lambda jobs, *_: jobs[0].command.write_bytes(b"linked"))
    monkeypatch.setattr(f"{place}remove_time", lambda _: None)
    zig = SimpleNamespace(environment=dict)
    parts: Any = SimpleNamespace(
        cache=tmp_path, zig=zig, target="", level="v1", progress=ProgressLine(StringIO())
    )
    _make(parts, library)
    assert library.read_bytes() == b"linked"
    assert (library.parent / MANIFEST).read_bytes() == b"what it is made of"
