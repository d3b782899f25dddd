"""What opening a page costs, and how many pictures of a hundred worlds it draws without a graphics card.

Used by `watching.py`.
"""

from __future__ import annotations

import os
import threading
import time
from typing import Any

from run import readable
from tests.viewer.browser import Page, chromium

import pybullet_data
from carom import World, Worlds
from carom.viewer import Viewer

WORLDS = 100
WIDE, HIGH = 1280, 800
LOADS = 5
SECONDS_WATCHED = 10.0
DATA = pybullet_data.getDataPath()
# How many pictures a page draws in so many seconds, of which the first half is left out.
PICTURES = """async seconds => {
  const { renderer } = app, times = [], draw = renderer.draw;
  renderer.draw = (...told) => { times.push(performance.now()); return draw.apply(renderer, told); };
  const began = performance.now();
  await new Promise(done => setTimeout(done, 1000 * seconds));
  renderer.draw = draw;
  return [times.filter(time => time > began + 500 * seconds).length / (seconds / 2), renderer.pace.sharpness];
}"""
SHOWN = "window.app?.scene.poses.length > 0 && app.scene.groups.length > 0 && !app.stale"


def open_pages() -> list[list[str]]:
    """Rows of the table about loading a page with a Panda: for the first time, and again."""
    world = panda()
    os.environ["CI"] = "true"
    viewer = Viewer(world, port=0)
    rows = []
    try:
        with chromium() as browser:
            for kind in ("cold", "warm"):
                context = browser.new_context()
                loads = [
                    load(context, viewer.address, fresh=kind == "cold", browser=browser) for _ in range(LOADS)
                ]
                files, socket, seconds = sorted(loads[1:] if kind == "warm" else loads, key=lambda it: it[2])[
                    LOADS // 2 - 1
                ]
                context.close()
                rows.append([f"the files of a page, {kind}", f"{files / 1e6:.2f} MB", "", ""])
                if kind == "cold":
                    rows.append(["a Panda by its socket", f"{socket / 1e6:.2f} MB", "", ""])
                rows.append([f"until the page shows the Panda, {kind}", readable(seconds), "", ""])
    finally:
        viewer.close()
    return rows


def load(context: Any, address: str, *, fresh: bool, browser: Any) -> tuple[float, float, float]:
    """Bytes of files and of messages that a page loads, and the time until it shows its scene [s]."""
    own = browser.new_context() if fresh else context
    page = own.new_page()
    session = own.new_cdp_session(page)
    session.send("Network.enable")
    taken = {"files": 0.0, "socket": 0.0}

    def add(name: str, size: float) -> None:
        taken[name] += size

    session.on("Network.loadingFinished", lambda it: add("files", it["encodedDataLength"]))
    session.on(
        "Network.webSocketFrameReceived", lambda it: add("socket", 0.75 * len(it["response"]["payloadData"]))
    )
    began = time.perf_counter()
    page.goto(address)
    while not page.evaluate(SHOWN):
        page.wait_for_timeout(5)
    passed = time.perf_counter() - began
    page.close()
    if fresh:
        own.close()
    return taken["files"], taken["socket"], passed


def watch_many_worlds() -> list[list[str]]:
    """Rows of the table about pictures of many worlds that move."""
    worlds = Worlds(panda(), WORLDS)
    worlds["panda"].joints.free()
    os.environ["CI"] = "true"
    viewer = Viewer(worlds, port=0, shown=WORLDS)
    ending = threading.Event()

    def run() -> None:
        while not ending.is_set():
            worlds.step()
            ending.wait(1.0 / 240.0)

    stepping = threading.Thread(target=run)
    try:
        with chromium() as browser:
            page = Page(browser, viewer.address, WIDE, HIGH)
            page.until(SHOWN)
            stepping.start()
            pictures, sharpness = page.page.evaluate(PICTURES, SECONDS_WATCHED)
            page.page.close()
    finally:
        ending.set()
        stepping.join()
        viewer.close()
    what = f"{WORLDS} worlds with a Panda each, {WIDE} x {HIGH}, without a graphics card"
    return [[what, f"{pictures:.0f} pictures a second, {sharpness:.2g} of the pixels along an edge", "", ""]]


def panda() -> World:
    """A world with a Panda."""
    world = World()
    world.parameters.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)
    return world
