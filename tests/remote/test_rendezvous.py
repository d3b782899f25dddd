"""Notes that servers leave."""

import os
from pathlib import Path

import pytest

from carom.remote import private_folder
from carom.remote.errors import RemoteError
from carom.remote.rendezvous import Note, find

NOTE = Note("127.0.0.1", 1234, b"\0key\xff")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("LOCALAPPDATA" if os.name == "nt" else "XDG_RUNTIME_DIR", str(tmp_path))
    return private_folder.private_folder()


def test_a_note_is_found_under_its_name(folder: Path) -> None:
    assert find("a") is None
    NOTE.leave("a")
    assert find("a") == NOTE
    assert find("b") is None
    assert [path.name for path in folder.iterdir()] == ["a.json"]
    NOTE.take_away("a")
    assert find("a") is None
    NOTE.take_away("a")


def test_only_ones_own_note_is_taken_away() -> None:
    other = Note("127.0.0.1", 1235, b"key")
    NOTE.leave("a")
    other.leave("a")
    NOTE.take_away("a")
    assert find("a") == other


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"\xff\xfe",
        b"{}",
        b"[" * 5000,
        b'{"host": 1, "port": 1, "key": ""}',
        b'{"host": "a", "port": "b", "key": ""}',
        b'{"host": "a", "port": 1, "key": "xyz"}',
    ],
)
def test_what_is_no_note_is_not_there(folder: Path, content: bytes) -> None:
    NOTE.leave("a")
    path = folder / "a.json"
    path.write_bytes(content)
    assert find("a") is None


@pytest.mark.skipif(os.name == "nt", reason="files have no such modes")
class TestPrivacy:
    def test_others_cannot_read_it(self, folder: Path) -> None:
        NOTE.leave("a")
        assert folder.stat().st_mode & 0o777 == 0o700
        assert (folder / "a.json").stat().st_mode & 0o777 == 0o600

    def test_a_note_that_others_can_read_does_not_count(self, folder: Path) -> None:
        NOTE.leave("a")
        (folder / "a.json").chmod(0o644)
        assert find("a") is None

    def test_nothing_is_left_in_a_folder_that_others_can_use(self, folder: Path) -> None:
        folder.mkdir()
        folder.chmod(0o755)
        with pytest.raises(RemoteError):
            NOTE.leave("a")

    def test_nor_through_a_link(self, folder: Path, tmp_path: Path) -> None:
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        folder.symlink_to(tmp_path / "elsewhere")
        with pytest.raises(RemoteError):
            NOTE.leave("a")

    def test_without_a_runtime_folder(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.delenv("XDG_RUNTIME_DIR")
        monkeypatch.setattr(private_folder.tempfile, "gettempdir", lambda: str(tmp_path / "temporary"))
        NOTE.leave("a")
        assert find("a") == NOTE
