"""Pages in Firefox, by the protocol it speaks itself (WebDriver BiDi)."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE, until
from websockets.sync.client import connect
from websockets.sync.connection import Connection

FIREFOX = next(filter(None, map(shutil.which, ("firefox", "firefox-esr"))), None)
# Without a display Firefox has no WebGL; this one needs no screen.
DISPLAY = shutil.which("Xvfb")
needs_firefox = pytest.mark.skipif(
    not (FIREFOX and DISPLAY and os.access(Path.home(), os.W_OK)),
    reason="no Firefox, no Xvfb for it, or no home folder that it may write to",
)
# WebGL by the processor, and no calls to its makers.
_PREFERENCES = {
    "webgl.force-enabled": "true",
    "app.normandy.enabled": "false",
    "app.update.enabled": "false",
    "datareporting.policy.dataSubmissionEnabled": "false",
    "network.captive-portal-service.enabled": "false",
}


class FirefoxPage:
    """One page in Firefox.

    Args:
        socket: To the browser.
        address: Of the page.
    """

    def __init__(self, socket: Connection, address: str) -> None:
        self._socket = socket
        self._number = 0
        self._call("session.new", capabilities={})
        tree = self._call("browsingContext.getTree")
        self._context = tree["contexts"][0]["context"]
        self._call("browsingContext.navigate", context=self._context, url=address, wait="complete")

    def evaluate(self, code: str) -> Any:
        """The value of an expression: a string, a number or a boolean."""
        result = self._call(
            "script.evaluate", expression=code, target={"context": self._context}, awaitPromise=True
        )
        assert result["type"] == "success", result
        return result["result"].get("value")

    def wait_for(self, code: str) -> Any:
        """Waits until an expression is true."""
        return until(lambda: self.evaluate(code))

    def picture(self) -> bytes:
        """What the page shows, as a PNG file."""
        result = self._call("browsingContext.captureScreenshot", context=self._context)
        return base64.b64decode(result["data"])

    def _call(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=PATIENCE))
            if answer.get("id") == self._number:
                assert answer["type"] == "success", answer
                return answer["result"]


@contextmanager
def firefox(folder: Path, address: str) -> Iterator[FirefoxPage]:
    """A page in a Firefox of its own.

    Args:
        folder: Where the browser keeps its profile.
        address: Of the page.
    """
    assert FIREFOX is not None
    assert DISPLAY is not None
    preferences = "\n".join(f'user_pref("{name}", {value});' for name, value in _PREFERENCES.items())
    (folder / "user.js").write_text(preferences)
    command = [FIREFOX, "--no-remote", "--profile", folder, "--remote-debugging-port", "0"]
    display = subprocess.Popen(
        [DISPLAY, "-displayfd", "1", "-screen", "0", "1100x760x24"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        assert display.stdout is not None
        number = display.stdout.readline().strip()
        environment = {**os.environ, "DISPLAY": f":{number}"}
        browser = subprocess.Popen([*map(str, command)], env=environment, stderr=subprocess.PIPE, text=True)
        try:
            assert browser.stderr is not None
            listening = next(line for line in browser.stderr if "WebDriver BiDi listening on" in line)
            with connect(listening.split()[-1] + "/session", max_size=None) as socket:
                yield FirefoxPage(socket, address)
        finally:
            browser.terminate()
            browser.wait()
    finally:
        display.terminate()
        display.wait()
