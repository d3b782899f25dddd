from collections.abc import Generator, Iterator
from contextlib import ExitStack

import pytest
from tests.viewer.browser import Page, SharedBrowser

import pybullet as p
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Show failures without parsing sources, which Python 3.11 may refuse between greenlets of the driver."""
    options = item.config.option
    style, options.tbstyle = options.tbstyle, "native"
    try:
        return (yield)
    finally:
        options.tbstyle = style


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
