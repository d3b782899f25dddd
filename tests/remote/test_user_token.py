"""The user's token stays the same, and nobody else can read it."""

from __future__ import annotations

import os
import stat
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from carom.remote.private_folder import private_folder
from carom.remote.user_token import fresh_token, user_token

posix = pytest.mark.skipif(sys.platform == "win32", reason="the user's folder is private by its access list")


@pytest.fixture(autouse=True)
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))


def test_it_stays_the_same() -> None:
    token = user_token()
    assert len(token) >= 20
    assert user_token() == token
    assert sorted(path.name for path in private_folder().iterdir()) == ["token"]


def test_those_who_ask_at_once_get_the_same() -> None:
    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(lambda _: user_token(), range(40)))) == 1


def test_fresh_ones_differ() -> None:
    assert fresh_token() != fresh_token()


@posix
def test_only_the_user_can_read_it() -> None:
    user_token()
    assert stat.S_IMODE(os.stat(private_folder() / "token").st_mode) == 0o600


@posix
def test_one_that_others_can_read_is_not_used() -> None:
    token = user_token()
    (private_folder() / "token").chmod(0o644)
    assert user_token() not in (token, user_token())


def test_it_works_without_a_place_to_write_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setattr("carom.remote.user_token.private_folder", lambda: blocked / "carom")
    assert len(user_token()) >= 20
