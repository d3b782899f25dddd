"""`python -m carom serve`, as users start and end it, and what they tell it."""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.patience import PATIENCE
from tests.servers import environment

import pybullet as p
from carom.cli.command_line import main
from carom.remote.rendezvous import find
from pybullet._connections.server_options import KEY_VARIABLE

ARM = str(Path(__file__).parent / "pybullet" / "robots" / "arm.urdf")
KEY = "a key that only the two of us know"


@pytest.fixture(autouse=True)
def _place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("LOCALAPPDATA" if os.name == "nt" else "XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.delenv(KEY_VARIABLE, raising=False)
    yield
    for client in range(8):
        if p.isConnected(client):
            p.disconnect(client)


@contextmanager
def serving(*options: str, **variables: str) -> Iterator[subprocess.Popen[str]]:
    """A server that is ready."""
    group = subprocess.CREATE_NEW_PROCESS_GROUP if sys.platform == "win32" else 0
    process = subprocess.Popen(
        [sys.executable, "-m", "carom", "serve", *options],
        stdout=subprocess.PIPE,
        env=environment(**variables),
        text=True,
        creationflags=group,
    )
    assert process.stdout is not None
    try:
        while "Ctrl-C ends it" not in (line := process.stdout.readline()):
            assert line, "the server has ended"
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def interrupt(process: subprocess.Popen[str]) -> None:
    process.send_signal(signal.CTRL_BREAK_EVENT if sys.platform == "win32" else signal.SIGINT)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return listening.getsockname()[1]


def test_a_world_to_join_until_ctrl_c() -> None:
    with serving() as process:
        assert p.connect(p.SHARED_MEMORY) == 0
        assert p.loadURDF(ARM) == 0
        assert p.connect(p.SHARED_MEMORY) == 1
        assert p.getNumBodies(1) == 1
        interrupt(process)
        assert process.wait(timeout=PATIENCE) == 0
        assert process.stdout is not None
        assert process.stdout.read() == "The physics server has ended.\n"
    assert [p.isConnected(client) for client in (0, 1)] == [0, 0]
    assert find("shared-memory-12347") is None


@pytest.mark.skipif(sys.platform == "win32", reason="processes are not asked to end there")
def test_a_world_to_join_until_it_is_terminated() -> None:
    with serving("--key", "7") as process:
        assert p.connect(p.SHARED_MEMORY, 7) == 0
        process.terminate()
        assert process.wait(timeout=PATIENCE) == 0


def test_ports_of_this_machine_need_no_key() -> None:
    tcp, udp = free_port(), free_port()
    with serving("--tcp", str(tcp), "--udp", str(udp)):
        for number, (method, host, port) in enumerate(
            ((p.TCP, "localhost", tcp), (p.TCP, "127.0.0.1", tcp), (p.UDP, "localhost", udp))
        ):
            assert p.connect(method, host, port) == number
            assert p.getConnectionInfo(number) == {"isConnected": 1, "connectionMethod": method}
        assert p.connect(p.UDP, "localhost", tcp) == -1


def test_a_key_from_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port, file = free_port(), tmp_path / "the key.txt"
    with serving("--tcp", str(port), "--key-file", str(file)):
        if os.name != "nt":
            assert file.stat().st_mode & 0o777 == 0o600
        # Another user: the notes are not found.
        monkeypatch.setenv("LOCALAPPDATA" if os.name == "nt" else "XDG_RUNTIME_DIR", str(tmp_path / "other"))
        (tmp_path / "other").mkdir()
        assert p.connect(p.TCP, "localhost", port) == -1
        assert p.connect(p.TCP, "localhost", port, options=f'--key-file="{file}"') == 0
        monkeypatch.setenv(KEY_VARIABLE, file.read_text())
        assert p.connect(p.TCP, "localhost", port) == 1
        monkeypatch.setenv(KEY_VARIABLE, KEY)
        assert p.connect(p.TCP, "localhost", port) == -1


def test_a_key_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    with serving("--tcp", str(port), "--bind", "0.0.0.0", **{KEY_VARIABLE: KEY}):
        monkeypatch.setenv(KEY_VARIABLE, KEY)
        assert p.connect(p.TCP, "127.0.0.1", port) == 0
        assert p.connect(p.SHARED_MEMORY) == 1


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--tcp", "70000"], "is no port"),
        (["--tcp", "5", "--bind", "no.such.host.invalid"], "Cannot start the physics server"),
        (["--tcp", "--bind", "0.0.0.0"], "clients need a key they know"),
        (["--key-file", "no/such/folder/key"], "Cannot start the physics server"),
    ],
)
def test_what_cannot_be_served(
    options: list[str], problem: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("carom.cli.serve.library", lambda: None)
    assert main(["serve", *options]) == 1
    assert problem in capsys.readouterr().err
    assert not p.isConnected()


def test_a_short_key_is_no_key(tmp_path: Path) -> None:
    file = tmp_path / "key"
    file.write_text("short")
    for call in (
        lambda: p.connect(p.SHARED_MEMORY_SERVER, 5, f"--key-file={file}"),
        lambda: p.connect(p.TCP, "localhost", 5, f"--key-file={file}"),
    ):
        with pytest.raises(p.error, match="too short"):
            call()
    with pytest.raises(p.error, match="Cannot read the key"):
        p.connect(p.TCP, "localhost", 5, f"--key-file={tmp_path / 'none'}")
    assert not p.isConnected()


def test_a_window_that_others_use() -> None:
    with serving("--gui", "--gui-port", "0"):
        p.connect(p.SHARED_MEMORY)
        slider = p.addUserDebugParameter("force", -5, 5, 1.5)
        assert p.readUserDebugParameter(slider) == 1.5
        p.resetDebugVisualizerCamera(2, 30, -40, [1, 2, 3])
        assert p.getDebugVisualizerCamera()[11] == (1.0, 2.0, 3.0)
        assert p.getKeyboardEvents() == {}
