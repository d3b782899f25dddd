from collections.abc import Iterator

import pytest

import pybullet as p
from carom.viewer.viewer import Viewer
from pybullet._clients import clients
from pybullet._page_window import PageWindow


@pytest.fixture
def viewer(monkeypatch: pytest.MonkeyPatch) -> Iterator[Viewer]:
    """The viewer of client 0. No browser opens."""
    monkeypatch.setenv("CI", "true")
    window = clients[p.connect(p.GUI, options="--port=0")].window
    assert isinstance(window, PageWindow)
    yield window.viewer
    if p.isConnected():
        p.disconnect()
