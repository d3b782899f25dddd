"""Where the cache is for those who have no home that they can write to."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from carom.native.building import cache

pytestmark = pytest.mark.skipif(os.name == "nt", reason="folders of others are told by their user")


@pytest.fixture(autouse=True)
def _fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A file stands where the home would be, and the temporary folder is empty."""
    monkeypatch.delenv("CAROM_CACHE_PATH", raising=False)
    (tmp_path / "file").touch()
    (tmp_path / "temporary").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "file"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    monkeypatch.setattr("sys.platform", "linux")
    cache._temporary_folder.cache_clear()
    yield
    cache._temporary_folder.cache_clear()


def test_it_is_a_temporary_folder_of_the_users_own(tmp_path: Path) -> None:
    folder = cache.cache_folder()
    assert folder.parent == tmp_path / "temporary"
    assert folder.stat().st_mode & 0o777 == 0o700
    cache._temporary_folder.cache_clear()
    assert cache.cache_folder() == folder


def test_one_that_others_can_write_to_is_not_used(tmp_path: Path) -> None:
    open_to_all = cache.cache_folder()
    open_to_all.chmod(0o777)
    cache._temporary_folder.cache_clear()
    folder = cache.cache_folder()
    assert folder != open_to_all
    assert folder.stat().st_mode & 0o777 == 0o700
    assert cache.cache_folder() == folder


def test_one_that_has_libraries_may_be_read_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (tmp_path / "carom" / "native" / "libraries").mkdir(parents=True)
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert cache.cache_folder() == tmp_path / "carom" / "native"


def test_a_cache_can_be_locked_where_none_is_and_again(tmp_path: Path) -> None:
    folder = tmp_path / "not" / "there"
    for _ in range(2):
        with cache.alone(folder):
            assert (folder / "lock").is_file()
