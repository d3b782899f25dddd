"""The files of the page: kept by the browser, and asked for again where they do not arrive."""

from __future__ import annotations

import time
from contextlib import suppress

from tests.patience import PATIENCE
from tests.viewer.browser import Page, needs_browser

from carom.viewer.page_files import lasting_files
from carom.viewer.viewer import Viewer

MODULES = [name for name in lasting_files() if name.endswith(".js")]


def until(page, expression: str) -> None:
    """Wait until an expression is true, also while the page is loaded again."""
    give_up = time.monotonic() + PATIENCE
    while time.monotonic() < give_up:
        with suppress(Exception):
            if page.evaluate(expression):
                return
        page.wait_for_timeout(20)
    raise AssertionError(expression)


@needs_browser
def test_a_page_that_is_loaded_again_takes_its_files_from_the_browser(viewer: Viewer, browser):
    page = Page(browser, viewer.address)
    page.until("window.app?.history.count > 0")
    assert page.page.locator("#arriving").count() == 0
    asked: list[str] = []
    page.page.on("response", lambda answer: asked.append(answer.url))
    page.page.reload()
    page.until("window.app?.history.count > 0")
    sizes = "performance.getEntriesByType('resource').map((one) => [one.name, one.transferSize])"
    sent = [name for name, size in page.page.evaluate(sizes) if size > 0]
    assert len(asked) > len(MODULES)
    assert not [name for name in sent if name.endswith((".js", ".css", ".svg"))]
    assert page.complaints == []
    page.page.close()


@needs_browser
def test_a_page_whose_files_are_cut_off_says_so_and_tries_again(viewer: Viewer, browser):
    page = browser.new_page()
    failures = [3]

    def cut_off(route) -> None:
        failures[0] -= 1
        route.abort() if failures[0] >= 0 else route.continue_()

    page.route("**/view/scene.js", cut_off)
    page.goto(viewer.address)
    told = "document.getElementById('notice')?.textContent.includes('have not arrived')"
    until(page, told)
    assert not page.locator("#notice").is_hidden()
    until(page, "window.app?.history.count > 0")
    assert page.locator("#notice").is_hidden()
    assert page.evaluate("sessionStorage.getItem('carom attempts')") is None
    page.close()
