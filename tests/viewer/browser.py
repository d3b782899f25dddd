"""The viewer's page in a real browser without a window."""

from __future__ import annotations

import io
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from tests.patience import PATIENCE

BROWSER = next(
    filter(
        None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"))
    ),
    None,
)
needs_browser = pytest.mark.skipif(
    BROWSER is None, reason="no Chromium here; tests/viewer/server/test_server.py does what needs no browser"
)
# Drawn by the processor: small, so that it is quick.
WIDTH, HEIGHT = 480, 360
_ARGUMENTS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    # Hubs of notebooks and sites of editors.
    "--host-resolver-rules=MAP *.test 127.0.0.1",
]
# The software renderer warns of being slow when its pictures are read. On a busy machine a socket may take
# longer to open than the page waits before it polls.
_NO_COMPLAINTS = ("GPU stall", "WebSocket is closed before the connection is established")
# The page goes on looking for the next run, and the browser says each time that nobody is there.
_WHEN_A_RUN_HAS_ENDED = ("WebSocket connection to", "net::ERR_")


@contextmanager
def chromium() -> Iterator:
    """The browser; it is closed at the end."""
    driver = pytest.importorskip("playwright.sync_api", reason="drives the browser")
    with driver.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER or "", args=_ARGUMENTS)
        yield browser
        browser.close()


class SharedBrowser:
    """A browser that is started when it is needed first, and again if it has crashed.

    Args:
        stack: Closes it.
    """

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._browser: Any = None

    def running(self) -> Any:
        """The browser."""
        if self._browser is None or not self._browser.is_connected():
            self._stack.close()
            self._browser = self._stack.enter_context(chromium())
        return self._browser


class Page:
    """The viewer's page, as a user sees it.

    Attributes:
        page: The page of playwright.
    """

    def __init__(self, browser, address: str, width: int = WIDTH, height: int = HEIGHT) -> None:
        self._complaints: list[str] = []
        self._expected: list[str] = [*_NO_COMPLAINTS]
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.page.set_default_timeout(PATIENCE * 1000)
        self.page.on("console", self._note)
        self.page.on("pageerror", lambda error: self._complaints.append(str(error)))
        self.page.goto(address)

    def _note(self, message) -> None:
        if message.type in ("error", "warning"):
            self._complaints.append(message.text)

    @property
    def complaints(self) -> list[str]:
        """What the browser has complained about so far, but for what is expected."""
        return [each for each in self._complaints if not any(text in each for text in self._expected)]

    def expect(self, *texts: str) -> None:
        """Complaints that have one of these texts in them are none, whenever they come."""
        self._expected += texts

    def expect_the_end(self) -> None:
        """The run ends, and with it the page's server."""
        self.expect(*_WHEN_A_RUN_HAS_ENDED)

    def until(self, expression: str) -> None:
        """Waits until an expression is true in the page."""
        wait_for(lambda: self.page.evaluate(expression), self)

    def until_drawn(self) -> None:
        """Waits until the picture, and what is drawn with it, is of what the page knows."""
        self.until("!app.stale")

    def until_kept(self) -> None:
        """Waits until the browser has kept what it remembers of the script, which it writes soon."""
        self.until("app.memory.timer === null")

    def picture(self) -> NDArray[np.int16]:
        """What the page shows of the scene alone: (height, width, 3) red, green and blue."""
        self.page.evaluate(
            "for (const id of ['panel', 'labels', 'timeline']) document.getElementById(id).style.opacity = 0"
        )
        image = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        self.page.evaluate(
            "for (const id of ['panel', 'labels', 'timeline']) document.getElementById(id).style.opacity = 1"
        )
        return np.array(image).astype(np.int16)

    def wait_for_picture(self, condition) -> NDArray[np.int16]:
        """Takes pictures until something holds of one."""
        give_up = time.monotonic() + PATIENCE
        while not condition(picture := self.picture()):
            assert time.monotonic() < give_up, "the picture does not become what it should be"
            self.page.wait_for_timeout(200)
        return picture


def wait_for(condition: Callable[[], object], page: Page) -> None:
    """Lets the browser work until something holds here."""
    give_up = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < give_up
        page.page.wait_for_timeout(20)
