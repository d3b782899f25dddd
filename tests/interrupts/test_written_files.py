"""Files that Carom writes are complete, whatever happens meanwhile."""

from __future__ import annotations

import ast
import os
import stat
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE

import pybullet as p
from carom.writing import write_text, write_whole

SOURCE = Path(__file__).parents[2] / "src"
POSIX = pytest.mark.skipif(os.name == "nt", reason="there are no such files")
# Files that grow while something is recorded, or that nobody else sees before they are complete.
GROWING = {"pybullet/_clients/log_file.py", "carom/recording/video.py", "pybullet_utils/logger.py"}
UNSEEN = {
    "carom/cli/pybullet_files.py",
    "carom/native/building/cache.py",
    "carom/native/building/library.py",
    "carom/native/building/codegen.py",
    "carom/remote/user_token.py",
    "carom/viewer/protocol/__main__.py",
    "carom/world/face/texts.py",
    "carom/world/pickling.py",
    "carom/writing.py",
}
_FULL_DISK = """
import resource, sys
# Python would keep the first bytes of what it compiles from now on, and fail to read them next time.
sys.dont_write_bytecode = True
import pybullet as p
p.connect(p.DIRECT)
for _ in range(50):
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
for save in (p.saveWorld, p.saveBullet):
    try:
        save(sys.argv[1])
    except p.error as problem:
        print(problem)
"""


def _writes(call: ast.Call) -> bool:
    """Whether a call opens a file to write it, or writes a whole one."""
    name = getattr(call.func, "attr", getattr(call.func, "id", ""))
    if name in ("write_text", "write_bytes"):
        return isinstance(call.func, ast.Attribute)
    modes = [*call.args[:2], *(word.value for word in call.keywords if word.arg == "mode")]
    said = [mode.value for mode in modes if isinstance(mode, ast.Constant) and isinstance(mode.value, str)]
    return name in ("open", "fdopen") and any(set(mode) <= set("wxabt+") and mode for mode in said)


# What is in the text of every module that writes, so that others need not be parsed.
_WRITING = ("open", "write_text", "write_bytes")


def test_all_files_are_written_by_one_function() -> None:
    writers = set()
    for path in SOURCE.rglob("*.py"):
        package = path.relative_to(SOURCE).parts[0]
        if package.startswith(("carom", "pybullet")):
            text = path.read_text(encoding="utf-8")
            tree = ast.parse(text if any(word in text for word in _WRITING) else "")
            if any(isinstance(node, ast.Call) and _writes(node) for node in ast.walk(tree)):
                writers.add(path.relative_to(SOURCE).as_posix())
    assert writers == GROWING | UNSEEN


@POSIX
def test_a_full_disk_leaves_the_old_file(tmp_path: Path) -> None:
    old = tmp_path / "world.py"
    old.write_text("the old one")
    command = [sys.executable, "-c", _FULL_DISK, str(old)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.count("File too large") == 2
    assert old.read_text() == "the old one"
    assert list(tmp_path.iterdir()) == [old]


@pytest.mark.parametrize("problem", [KeyboardInterrupt(), OSError("no")])
def test_an_interrupted_write_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, problem: BaseException
) -> None:
    old = tmp_path / "file"
    old.write_text("the old one")

    def stop(*_: object) -> None:
        raise problem

    monkeypatch.setattr(os, "replace", stop)
    with pytest.raises(type(problem)):
        write_text(old, "the new one")
    assert old.read_text() == "the old one"
    assert list(tmp_path.iterdir()) == [old]


def _refusing(function: Callable[..., Any], number: int) -> Callable[..., Any]:
    """`os.open` or `os.replace` in a folder that allows no new files."""

    def call(first: str, *rest: Any) -> Any:
        if ".carom-" in str(first):
            raise OSError(number, "it is not allowed", first)
        return function(first, *rest)

    return call


@pytest.mark.parametrize(("name", "number"), [("open", 13), ("open", 30), ("replace", 16), ("replace", 13)])
def test_a_folder_without_the_right_to_write_is_no_obstacle_to_old_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, number: int
) -> None:
    old = tmp_path / "file"
    old.write_text("the old one, which is longer")
    monkeypatch.setattr(os, name, _refusing(getattr(os, name), number))
    write_text(old, "the new one")
    assert old.read_text() == "the new one"
    with pytest.raises(OSError, match="not allowed"):
        write_text(tmp_path / "other", "")
    assert list(tmp_path.iterdir()) == [old]


@POSIX
@pytest.mark.skipif(os.name != "nt" and os.geteuid() == 0, reason="root may write all files")
def test_files_that_may_only_be_read_stay(tmp_path: Path) -> None:
    old = tmp_path / "file"
    old.touch(0o444)
    with pytest.raises(PermissionError):
        write_text(old, "new")


@POSIX
def test_worlds_are_written_to_devices_and_pipes_but_never_replace_them(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    client = p.connect(p.DIRECT)
    with os.fdopen(os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)) as reader:
        p.saveWorld(str(pipe))
        assert "import pybullet" in reader.read()
    assert pipe.is_fifo()
    with pytest.raises(p.error, match=r"saveWorld command execution failed"):
        p.saveWorld(str(pipe))
    if Path("/dev/full").is_char_device():
        with pytest.raises(p.error, match="No space left"):
            p.saveWorld("/dev/full")
        assert Path("/dev/full").is_char_device()
    p.disconnect(client)


@POSIX
def test_a_pipe_takes_more_than_it_holds(tmp_path: Path) -> None:
    pipe, text = tmp_path / "pipe", "x" * 1_000_000
    os.mkfifo(pipe)
    # Readable from the start on, and read later than the pipe is full.
    reader, found = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK), bytearray()

    give_up = time.monotonic() + PATIENCE

    def read() -> None:
        while len(found) < len(text) and time.monotonic() < give_up:
            time.sleep(0.002)
            with suppress(BlockingIOError):
                found.extend(os.read(reader, 1 << 20))

    with ThreadPoolExecutor(1) as pool:
        reading = pool.submit(read)
        write_text(pipe, text)
        reading.result()
    os.close(reader)
    assert found.decode() == text


@POSIX
def test_a_script_goes_to_a_redirected_output(tmp_path: Path) -> None:
    code = "import pybullet as p; p.connect(p.DIRECT); p.saveWorld('/dev/stdout')"
    with (tmp_path / "out").open("w") as out:
        subprocess.run([sys.executable, "-c", code], stdout=out, timeout=120, check=True)
    assert list(tmp_path.iterdir()) == [tmp_path / "out"]
    assert "import pybullet" in (tmp_path / "out").read_text()


@POSIX
def test_private_files_are_private_from_the_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    modes = []
    real = os.replace

    def replace(draft: str, target: str) -> None:
        modes.append(stat.S_IMODE(os.stat(draft).st_mode))
        real(draft, target)

    monkeypatch.setattr(os, "replace", replace)
    path = tmp_path / "file"
    write_whole(path, b"secret", private=True)
    path.chmod(0o604)
    write_whole(path, b"secret", private=True)
    assert modes == [0o600, 0o600]
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_file_that_has_the_name_of_a_draft_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("secrets.token_hex", lambda size: "0" * 2 * size)
    theirs = tmp_path / f".carom-{'0' * 16}"
    theirs.write_text("theirs")
    with pytest.raises(FileExistsError):
        write_text(tmp_path / "file", "ours")
    assert theirs.read_text() == "theirs"
    assert not (tmp_path / "file").exists()
