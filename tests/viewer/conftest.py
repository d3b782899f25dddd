from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.viewer.browser import Page, chromium

import pybullet as p
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

HERE = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Try tests twice that fail: of some hundred pages in software GL one never draws on a busy machine."""
    for item in items:
        if Path(item.path).parent == HERE:
            item.add_marker(pytest.mark.flaky(reruns=1))


@pytest.fixture
def viewer(monkeypatch: pytest.MonkeyPatch) -> Iterator[Viewer]:
    """The viewer of client 0. No browser opens."""
    monkeypatch.setenv("CI", "true")
    window = clients[p.connect(p.GUI, options="--port=0")].window
    assert isinstance(window, PageWindow)
    yield window.viewer
    # Whatever a test leaves open, and under whatever number, would be in the way of the next window.
    for number in list(clients):
        p.disconnect(number)


@pytest.fixture(scope="module")
def browser() -> Iterator:
    with chromium() as browser:
        yield browser


@pytest.fixture
def page(viewer: Viewer, browser) -> Iterator[Page]:
    """The page of the viewer in a browser, once it shows something; it must not complain."""
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.scene.layout.layout > 0")
    yield page
    page.page.close()
    assert page.complaints == []
