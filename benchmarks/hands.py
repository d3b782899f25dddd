"""What users feel of the window: how long a slider takes to a script, how smoothly a replay is scrubbed.

Used by `watching.py`.
"""

from __future__ import annotations

import os
import statistics
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from run import readable
from tests.viewer.browser import Page, chromium

import pybullet as p
import pybullet_data
from carom import World
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

WANTED_DELAY = 0.020
WANTED_PICTURES = 30.0
MOVES = 60
BODIES = 100
SECONDS_SCRUBBED = 10.0
# What a window is like in which somebody looks at a replay.
WIDTH, HEIGHT = 900, 640

MOVE = """value => {
  const slider = document.querySelector("#sliders input[type=range]");
  slider.value = value;
  const moved = performance.timeOrigin + performance.now();
  slider.dispatchEvent(new Event("input"));
  return moved / 1000;
}"""
# Drags the handle to and fro, a moment for each picture; returns pictures a second and how fine they were.
SCRUB = """async seconds => {
  const { history, renderer } = app;
  const handle = document.getElementById("scrub");
  const began = performance.now();
  const times = [];
  while (performance.now() - began < 1000 * seconds) {
    await new Promise(requestAnimationFrame);
    const now = performance.now();
    times.push(now);
    const phase = ((now - began) / 4000) % 2;
    handle.value = (phase < 1 ? phase : 2 - phase) * history.end;
    handle.dispatchEvent(new Event("input"));
  }
  const settled = times.slice(times.length >> 1);
  return [(1000 * (settled.length - 1)) / (settled.at(-1) - settled[0]), renderer.pace.sharpness];
}"""


@contextmanager
def window() -> Iterator[PageWindow]:
    """A world with a page; no browser opens by itself."""
    os.environ["CI"] = "1"
    client = p.connect(p.GUI, options="--port=0")
    shown = clients[client].window
    assert isinstance(shown, PageWindow)
    yield shown
    p.disconnect(client)


def move_a_slider() -> list[list[str]]:
    """The row of the table about a slider, from its event in the page to the loop of a script."""
    arrivals: dict[float, float] = {}
    stop = threading.Event()
    with window() as shown, chromium() as browser:
        slider = p.addUserDebugParameter("moved", 0, MOVES, 0)

        def script() -> None:
            while not stop.wait(1 / 1000):
                arrivals.setdefault(p.readUserDebugParameter(slider), time.time())

        thread = threading.Thread(target=script)
        thread.start()
        page = Page(browser, shown.viewer.address, WIDTH, HEIGHT)
        page.page.wait_for_selector("#sliders input[type=range]")
        moves = {}
        for value in range(1, MOVES + 1):
            moves[float(value)] = page.page.evaluate(MOVE, value)
            page.page.wait_for_timeout(50)
        page.page.wait_for_timeout(500)
        stop.set()
        thread.join()
        page.page.close()
    delay = statistics.median(arrivals[value] - moved for value, moved in moves.items() if value in arrivals)
    verdict = "PASS" if delay <= WANTED_DELAY else "FAIL"
    return [["from a slider to the script, median", readable(delay), f"≤ {readable(WANTED_DELAY)}", verdict]]


def scrub_a_replay() -> list[list[str]]:
    """The row of the table about a replay whose handle is dragged, drawn by the processor."""
    with TemporaryDirectory() as folder, chromium() as browser:
        file = Path(folder) / "boxes.html"
        record_boxes(file)
        page = Page(browser, file.as_uri(), WIDTH, HEIGHT)
        page.until("window.app?.history.count > 0")
        pictures, sharpness = page.page.evaluate(SCRUB, SECONDS_SCRUBBED)
        page.page.close()
    what = f"scrubbing a replay of {BODIES} bodies, {WIDTH} x {HEIGHT}, without a graphics card"
    verdict = "PASS" if pictures >= WANTED_PICTURES else "FAIL"
    cost = f"{pictures:.0f} pictures a second, {sharpness:g} of the pixels along an edge"
    return [[what, cost, f"≥ {WANTED_PICTURES:.0f}", verdict]]


def record_boxes(file: Path) -> None:
    """Ten seconds of boxes that fall onto each other."""
    data = Path(pybullet_data.getDataPath())
    world = World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf(data / "plane.urdf", as_pybullet=True)
    for n in range(BODIES):
        place = (0.12 * (n % 5), 0.12 * (n // 5 % 5), 0.2 + 0.15 * (n // 25))
        world.load_urdf(data / "cube_small.urdf", place, as_pybullet=True)
    with world.record(file):
        world.step(2400)
