import os
import time
from pathlib import Path

import pytest

from carom.native.building.cache import mark_used
from carom.native.building.prune import prune

DAY = 24 * 3600.0


def _entry(path: Path, days: float, size: int = 10) -> Path:
    """A file, or a folder with one, that was used so many days ago."""
    file = path if path.suffix else path / "content"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(bytes(size))
    used = time.time() - days * DAY
    os.utime(path, (used, used))
    return path


@pytest.mark.parametrize("name", ["libraries/abc", "code/def", "objects/ghi.o"])
def test_what_was_not_used_for_long_is_removed(tmp_path: Path, name: str):
    young = _entry(tmp_path / name, 29)
    old = _entry(young.with_name(f"old-{young.name}"), 31)
    prune(tmp_path)
    assert (old.exists(), young.exists()) == (False, True)


def test_what_is_used_again_stays(tmp_path: Path):
    entry = _entry(tmp_path / "libraries" / "abc", 31)
    mark_used(entry)
    prune(tmp_path)
    assert entry.exists()


def test_of_too_much_the_oldest_is_removed(tmp_path: Path):
    entries = [_entry(tmp_path / folder / "x.o", days) for folder, days in (("objects", 2), ("libraries", 1))]
    entries.append(_entry(tmp_path / "code" / "y", 3))
    prune(tmp_path, most_bytes=25)
    assert [entry.exists() for entry in entries] == [True, True, False]


def test_what_killed_builds_left_is_removed(tmp_path: Path):
    old, young = _entry(tmp_path / "work-abc", 1.1), _entry(tmp_path / "work-def", 0.1)
    prune(tmp_path)
    assert (old.exists(), young.exists()) == (False, True)


def test_nothing_else_is_touched(tmp_path: Path):
    others = [_entry(tmp_path / "lock.x", 99), _entry(tmp_path / "zig" / "o", 99)]
    prune(tmp_path, most_bytes=0)
    assert all(other.exists() for other in others)


def test_a_cache_that_is_not_there_is_no_problem(tmp_path: Path):
    prune(tmp_path / "none")
    mark_used(tmp_path / "none")
