from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from _pytest.runner import runtestprotocol
from tests.viewer.browser import Page, SharedBrowser

import pybullet as p
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

HERE = Path(__file__).parent


def pytest_runtest_protocol(item: pytest.Function, nextitem: pytest.Item | None) -> bool | None:
    """Run a test again that fails: of some hundred pages in software GL one never draws on a busy machine."""
    if HERE not in item.path.parents:
        return None
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    options = item.config.option
    style = options.tbstyle
    # Others parse sources, which Python 3.11 may refuse to do between greenlets of the driver.
    options.tbstyle = "native"
    try:
        reports = runtestprotocol(item, log=False, nextitem=nextitem)
        if any(report.failed for report in reports):
            item._initrequest()
            reports = runtestprotocol(item, log=False, nextitem=nextitem)
    finally:
        options.tbstyle = style
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


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


@pytest.fixture(scope="package")
def shared_browser() -> Iterator[SharedBrowser]:
    """A browser for all tests here that need no other one."""
    with ExitStack() as stack:
        yield SharedBrowser(stack)


@pytest.fixture
def browser(shared_browser: SharedBrowser) -> Iterator:
    """A browser without any page, and nothing of pages before; the test's own pages are closed after it."""
    browser = shared_browser.running()
    yield browser
    # They would go on drawing.
    for context in browser.contexts:
        context.close()


@pytest.fixture
def page(viewer: Viewer, browser) -> Iterator[Page]:
    """The page of the viewer in a browser, once it shows something; it must not complain."""
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.scene.layout.layout > 0")
    yield page
    page.page.close()
    assert page.complaints == []
