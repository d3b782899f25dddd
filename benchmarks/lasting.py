"""What a window costs over time: a page at which nothing moves, and memory after minutes of moving bodies.

Used by `watching.py`.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hands import HEIGHT, WIDTH, window
from tests.viewer.browser import Page, chromium

import pybullet as p
import pybullet_data

WANTED_IDLE = 0.02
SECONDS_TO_REST, SECONDS_IDLE = 6.0, 15.0
TICKS = os.sysconf("SC_CLK_TCK")
MEGABYTE = 2**20


def rest() -> list[list[str]]:
    """The row of the table about a page that shows a robot at rest: the browser's processor time."""
    with window() as shown, chromium() as browser:
        p.setAdditionalSearchPath(pybullet_data.getDataPath())
        p.loadURDF("plane.urdf")
        p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
        page = Page(browser, shown.viewer.address, WIDTH, HEIGHT)
        page.until("window.app?.scene.bodies.size === 2")
        # Until the sharp picture is drawn, and the browser has done what it does at its start.
        page.page.wait_for_timeout(1000 * SECONDS_TO_REST)
        before, began = processor_time(), time.perf_counter()
        page.page.wait_for_timeout(1000 * SECONDS_IDLE)
        share = (processor_time() - before) / (time.perf_counter() - began)
        page.page.close()
    verdict = "PASS" if share <= WANTED_IDLE else "FAIL"
    what = "a page at which nothing moves, all processes of the browser, of a core"
    return [[what, f"{100 * share:.1f} %", f"≤ {100 * WANTED_IDLE:.0f} %", verdict]]


def grow(page: Page, minutes: float) -> list[list[str]]:
    """Rows of the table about the memory of a script and its page, as bodies move for minutes.

    Both keep the past, so they grow until that takes the memory it may take; the rows tell how it was at the
    middle and at the end.
    """
    rows = []
    for part in ("middle", "end"):
        page.page.wait_for_timeout(30_000 * minutes)
        past = size(page.page.evaluate("app.history.bytes + app.history.ledger.bytes"))
        script, shown = size(resident(os.getpid())), size(max(map(resident, renderers())))
        rows += [[f"memory of the script at the {part} of {minutes:g} minutes", script, "", ""]]
        rows += [[f"memory of the page, the past in it {past}", shown, "", ""]]
    return rows


def size(count: float) -> str:
    """A number of bytes, for a table."""
    return f"{count / MEGABYTE:.0f} MB"


def processor_time() -> float:
    """Processor time that the processes of the browser have taken [s]; those of the driver are not its."""
    return sum(float(field) for process in browsers() for field in stat(process)[11:13]) / TICKS


def renderers() -> list[int]:
    """Processes of the browser that show pages."""
    return [process for process in browsers() if "--type=renderer" in command(process)]


def browsers() -> list[int]:
    """Processes of the browser that this one has started."""
    return [process for process in descendants(os.getpid()) if "chrom" in command(process)]


def descendants(process: int) -> Iterator[int]:
    """Processes that a process has started, and those that they have."""
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            child = int(folder.name)
            with gone():
                if int(stat(child)[1]) == process:
                    yield child
                    yield from descendants(child)


def stat(process: int) -> list[str]:
    """What the system tells of a process, from its state on (the third field)."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


def command(process: int) -> str:
    """The command of a process; nothing if it is gone."""
    with gone():
        return Path(f"/proc/{process}/cmdline").read_text().replace("\0", " ")
    return ""


def resident(process: int) -> int:
    """Memory of a process [bytes]; 0 if it is gone."""
    with gone():
        return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return 0


@contextmanager
def gone() -> Iterator[None]:
    """Processes may end while they are asked for."""
    try:
        yield
    except (FileNotFoundError, ProcessLookupError):
        return
