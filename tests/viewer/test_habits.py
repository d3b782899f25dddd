"""What users of PyBullet's window are used to: ESC, keys, pausing, and logging in over SSH."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.patience import PATIENCE, until
from tests.viewer.scripts import ROOT, started
from tests.viewer.watcher import Watcher

import pybullet as p
from carom.viewer.display import has_display, tunnel_command
from carom.viewer.viewer import Viewer

NOT_CONNECTED = "Not connected to physics server"


def press(page: Watcher, key: str) -> None:
    page.tell("key", key=key, code=key, down=True)


def test_escape_ends_the_connection_of_a_script_that_asks_for_no_keys(viewer: Viewer):
    with Watcher(viewer.address) as page:
        press(page, "Escape")
        until(lambda: not viewer.is_open)
        with pytest.raises(p.error, match=NOT_CONNECTED):
            p.stepSimulation()
        assert not p.isConnected()
        # The script may have been about to do so.
        p.disconnect()
        with pytest.raises(p.error, match=NOT_CONNECTED):
            p.disconnect()


def test_a_script_that_asks_for_keys_sees_escape_before_the_connection_ends(viewer: Viewer):
    with Watcher(viewer.address) as page:
        p.getKeyboardEvents()
        press(page, "Escape")
        events = until(p.getKeyboardEvents)
        assert events == {27: p.KEY_IS_DOWN | p.KEY_WAS_TRIGGERED}
        with pytest.raises(p.error, match=NOT_CONNECTED):
            p.stepSimulation()
        p.disconnect()
        assert p.connect(p.DIRECT) == 0
        p.disconnect()
        with pytest.raises(p.error, match=NOT_CONNECTED):
            p.disconnect()


def test_escape_ends_a_script_that_has_lost_interest_in_keys(viewer: Viewer):
    with Watcher(viewer.address) as page:
        p.getKeyboardEvents()
        press(page, "Escape")
        assert until(lambda: not viewer.is_open)


def in_background(script: Callable[[], object]) -> threading.Thread:
    thread = threading.Thread(target=script)
    thread.start()
    return thread


def test_a_paused_script_sees_sliders_and_escape(viewer: Viewer):
    gain = p.addUserDebugParameter("gain", 0, 1, 0)
    seen: list[float] = []
    keys: list[int] = []

    def script() -> None:
        while not keys:
            seen.append(p.readUserDebugParameter(gain))
            p.stepSimulation()
            keys.extend(p.getKeyboardEvents())

    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        until(lambda: viewer.pause_control.closed)
        thread = in_background(script)
        until(lambda: viewer.pause_control.listeners)
        page.tell("slider", slider=gain, value=0.5)
        until(lambda: seen[-1] == 0.5)
        assert viewer.time == 0.0
        press(page, "Escape")
        thread.join(PATIENCE)
        assert keys == [27]
        assert viewer.time == 0.0


def test_a_paused_script_that_asks_for_nothing_loses_no_step(viewer: Viewer):
    gain = p.addUserDebugParameter("gain", 0, 1, 0)
    done: list[int] = []
    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        until(lambda: viewer.pause_control.closed)
        thread = in_background(lambda: done.extend(len(p.stepSimulation()) for _ in range(3)))
        page.tell("slider", slider=gain, value=0.5)
        page.tell("pause", paused=False)
        thread.join(PATIENCE)
        assert viewer.time == pytest.approx(3 / 240)


def test_a_pause_ends_with_the_last_page(viewer: Viewer, capsys: pytest.CaptureFixture[str]):
    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        until(lambda: viewer.pause_control.closed)
        assert "paused" in capsys.readouterr().out
        thread = in_background(p.stepSimulation)
    thread.join(PATIENCE)
    assert not viewer.pause_control.closed
    # It is told once the step is free.
    assert until(lambda: "continues" in capsys.readouterr().out)


def test_a_pause_is_told_once(viewer: Viewer, capsys: pytest.CaptureFixture[str]):
    for paused in (False, True, True, False, False):
        viewer.pause(paused)
    said = capsys.readouterr().out
    assert said.count("is paused") == 1
    assert said.count("continues") == 1


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_nothing_goes_on_after_ctrl_c(tmp_path: Path):
    file = tmp_path / "endless.py"
    file.write_text(
        """
import atexit
import signal
import pybullet as p
from pybullet._clients.clients import clients

p.connect(p.GUI, options="--port=0")
atexit.register(clients[0].window.viewer.pause, False)  # the last page is gone, and a while has passed
signal.signal(signal.SIGINT, signal.default_int_handler)
while True:
    p.stepSimulation()
""",
        encoding="utf-8",
    )
    script, address = started(file)
    assert script.stdout is not None
    with Watcher(address) as page:
        page.tell("pause", paused=True)
        assert "paused" in script.stdout.readline()
        script.send_signal(signal.SIGINT)
        said, _ = script.communicate(timeout=PATIENCE)
    assert "KeyboardInterrupt" in said
    assert "continues" not in said


def test_a_pause_lasts_while_a_page_is_loaded_again(viewer: Viewer):
    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        until(lambda: viewer.pause_control.closed)
    with Watcher(viewer.address):
        time.sleep(2.0)
        assert viewer.pause_control.closed


def test_key_d_keeps_bodies_awake(viewer: Viewer):
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    p.changeDynamics(ball, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)

    def rest() -> bool:
        """Whether it falls asleep: then gravity does not move it."""
        p.setGravity(0, 0, 0)
        p.resetBaseVelocity(ball, [0, 0, 0], [0, 0, 0])
        for _ in range(720):
            p.stepSimulation()
        p.setGravity(0, 0, -10)
        p.stepSimulation()
        return p.getBaseVelocity(ball)[0][2] == 0.0

    with Watcher(viewer.address) as page:
        assert rest()
        page.tell("sleep")
        until(lambda: not rest())
        assert not rest()
        page.tell("sleep")
        assert until(rest)


def test_key_p_writes_a_trace_of_the_steps_while_it_is_held(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch, tmp_path
):
    monkeypatch.setattr("pybullet._window.page_window.gettempdir", lambda: str(tmp_path))
    with Watcher(viewer.address) as page:
        page.tell("profile", running=True)
        until(lambda: list(tmp_path.iterdir()))
        p.stepSimulation()
        page.tell("profile", running=False)
        (file,) = tmp_path.iterdir()
        assert until(lambda: "stepSimulation" in file.read_text())


SSH = {"SSH_CONNECTION": "10.0.0.9 50222 192.0.2.7 22", "DISPLAY": "localhost:10.0"}


def test_over_ssh_no_browser_opens_and_the_tunnel_is_told(monkeypatch: pytest.MonkeyPatch):
    for name in ("CI", "SSH_CONNECTION", "SSH_CLIENT", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("USER", "ada")
    monkeypatch.setenv("LOGNAME", "ada")
    assert has_display()
    assert tunnel_command("http://127.0.0.1:8400/") is None
    for name, value in SSH.items():
        monkeypatch.setenv(name, value)
    assert not has_display()
    assert tunnel_command("http://127.0.0.1:8412/") == "ssh -L 8412:localhost:8412 ada@192.0.2.7"
    monkeypatch.setenv("SSH_CONNECTION", "10.0.0.9 50222 192.0.2.7 2222")
    assert tunnel_command("http://127.0.0.1:8400/") == "ssh -L 8400:localhost:8400 -p 2222 ada@192.0.2.7"


def test_a_script_over_ssh_prints_the_tunnel():
    code = "import pybullet as p; p.connect(p.GUI, options='--port=0'); p.disconnect()"
    environment = {**os.environ, **SSH, "CI": "1", "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    port = re.findall(r"http://127\.0\.0\.1:(\d+)/", done.stdout)[0]
    assert f"ssh -L {port}:localhost:{port}" in done.stdout
