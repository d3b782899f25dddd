"""Bounded reading and the cache that notices every change."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Any

import pytest
from tests.budget.limits import limited

from carom.errors import DescriptionError
from carom.files import bounded
from carom.files.bounded import FileCache, FileStamp, read_bounded

LONG_AGO = 1_000_000_000


def write(file: Path, text: str, when: int | None = LONG_AGO) -> FileStamp:
    file.write_text(text)
    if when is not None:
        os.utime(file, (when, when))
    return FileStamp.of(file)


def test_unchanged_files_are_served(tmp_path: Path) -> None:
    cache: FileCache[str, str] = FileCache(2)
    file = tmp_path / "f"
    cache.put("key", write(file, "one"), "value")
    assert cache.get("key", file) == "value"
    assert cache.get("other", file) is None


def test_a_new_size_time_or_inode_is_noticed(tmp_path: Path) -> None:
    cache: FileCache[str, str] = FileCache(2)
    file = tmp_path / "f"
    for text, when in (("longer", LONG_AGO), ("two", LONG_AGO + 1)):
        cache.put("key", write(file, "one"), "value")
        write(file, text, when)
        assert cache.get("key", file) is None
    cache.put("key", write(file, "one"), "value")
    write(tmp_path / "g", "two")
    os.replace(tmp_path / "g", file)
    assert cache.get("key", file) is None


def test_a_file_that_may_still_change_within_its_time_stamp_is_not_served(tmp_path: Path) -> None:
    cache: FileCache[str, str] = FileCache(2)
    file = tmp_path / "f"
    cache.put("key", write(file, "one", when=None), "value")
    assert cache.get("key", file) is None


def test_a_file_that_is_gone_is_noticed(tmp_path: Path) -> None:
    cache: FileCache[str, str] = FileCache(2)
    file = tmp_path / "f"
    cache.put("key", write(file, "one"), "value")
    file.unlink()
    assert cache.get("key", file) is None


def test_the_least_recently_used_goes_first(tmp_path: Path) -> None:
    cache: FileCache[int, str] = FileCache(2)
    file = tmp_path / "f"
    stamp = write(file, "one")
    for key in (1, 2):
        cache.put(key, stamp, str(key))
    cache.get(1, file)
    cache.put(3, stamp, "3")
    assert [cache.get(key, file) for key in (1, 2, 3)] == ["1", None, "3"]


def test_large_and_unreadable_files_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "f"
    write(file, "0123456789")
    with limited(file_bytes=10):
        assert read_bounded(file)[0] == b"0123456789"
    with limited(file_bytes=9), pytest.raises(DescriptionError, match="10 bytes are more than the 9"):
        read_bounded(file)
    with pytest.raises(DescriptionError, match="it is not a regular file"):
        read_bounded(tmp_path)


class Endless(io.RawIOBase):
    """A file, like some devices, that goes on for ever and whose stamp promises nothing."""

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any, /) -> int:
        return len(buffer)


def test_a_file_without_end_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "f"
    assert write(file, "").size == 0
    monkeypatch.setattr(bounded, "open", lambda *_: io.BufferedReader(Endless()), raising=False)
    with limited(file_bytes=1000), pytest.raises(DescriptionError, match="more than the 1000"):
        read_bounded(file)


def test_the_least_recently_used_go_when_the_sizes_are_too_large(tmp_path: Path) -> None:
    cache: FileCache[str, str] = FileCache(9, most_bytes=10)
    file = tmp_path / "f"
    stamp = write(file, "one")
    for key in ("a", "b", "c"):
        cache.put(key, stamp, key, 4)
    assert [cache.get(key, file) for key in ("a", "b", "c")] == [None, "b", "c"]
    cache.put("d", stamp, "d", 100)
    assert [cache.get(key, file) for key in ("b", "c", "d")] == [None, None, "d"]
