"""What users feel of the window: how long a slider takes to a script, how smoothly robots and a replay move.

Used by `watching.py`.
"""

from __future__ import annotations

import math
import os
import statistics
import threading
import time
from collections.abc import Callable, Iterator
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
# The window of a laptop.
WIDE, HIGH = 1280, 800
WANTED_OF_ROBOTS = 20.0
WANTED_SHARPNESS = 0.5
SECONDS_WATCHED = 12.0

MOVE = """value => {
  const slider = document.querySelector("#sliders input[type=range]");
  slider.value = value;
  const moved = performance.timeOrigin + performance.now();
  slider.dispatchEvent(new Event("input"));
  return moved / 1000;
}"""
# How many pictures of a robot that moves a page draws in a second, and how fine they are.
WATCH = """async seconds => {
  const { scene, renderer } = app;
  const times = [];
  const draw = renderer.draw;
  renderer.draw = (...told) => { times.push(performance.now()); return draw.apply(renderer, told); };
  const sizes = [];
  const began = performance.now();
  while (performance.now() - began < 1000 * seconds) {
    await new Promise(done => setTimeout(done, 100));
    sizes.push(renderer.pace.sharpness);
  }
  const settled = times.filter(time => time > began + 500 * seconds);
  const later = sizes.slice(sizes.length >> 1);
  const mean = later.reduce((sum, each) => sum + each, 0) / later.length;
  return [(1000 * (settled.length - 1)) / (settled.at(-1) - settled[0]), mean];
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
def window(options: str = "") -> Iterator[PageWindow]:
    """A world with a page, connection 0 unless there is another; no browser opens by itself."""
    os.environ["CI"] = "1"
    client = p.connect(p.GUI, options=f"--port=0 {options}")
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


def swing(joints: dict[int, float]) -> Callable[[int], None]:
    """A script's way to move joints of the first robot to and fro [rad], step by step."""

    def move(step: int) -> None:
        for joint, amplitude in joints.items():
            target = amplitude * math.sin(step / 120)
            p.setJointMotorControl2(1, joint, p.POSITION_CONTROL, target, force=200)

    return move


def drive(step: int) -> None:
    """A script's way to drive R2D2, whose wheels are joints 2, 3, 6 and 7."""
    for joint in (2, 3, 6, 7):
        speed = -4.0 if joint < 4 else 4.0 * math.sin(step / 300)
        p.setJointMotorControl2(1, joint, p.VELOCITY_CONTROL, targetVelocity=speed, force=10)


ROBOTS: dict[str, tuple[str, bool, Callable[[int], None]]] = {
    "the Panda": ("franka_panda/panda.urdf", True, swing({0: 1.0, 1: 0.4, 3: 0.6, 5: 0.5})),
    "R2D2": ("r2d2.urdf", False, drive),
}


def watch_robots() -> list[list[str]]:
    """Rows of the table about robots on a plane that move in real time, drawn by the processor."""
    rows = []
    for name, (file, fixed, move) in ROBOTS.items():
        with window() as shown, stepping(file, fixed, move), chromium() as browser:
            page = Page(browser, shown.viewer.address, WIDE, HIGH)
            page.until("window.app?.scene.bodies.size === 2")
            pictures, sharpness = page.page.evaluate(WATCH, SECONDS_WATCHED)
            page.page.close()
        cost = f"{pictures:.0f} pictures a second, {sharpness:.2g} of the pixels along an edge"
        wanted = f"≥ {WANTED_OF_ROBOTS:.0f} at {WANTED_SHARPNESS:g}"
        verdict = "PASS" if pictures >= WANTED_OF_ROBOTS and sharpness >= WANTED_SHARPNESS else "FAIL"
        rows.append([f"{name} moves, {WIDE} x {HIGH}, without a graphics card", cost, wanted, verdict])
    return rows


@contextmanager
def stepping(file: str, fixed: bool, move: Callable[[int], None]) -> Iterator[None]:
    """A robot on a plane that a script moves and steps in real time, in a thread."""
    stop = threading.Event()
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    p.loadURDF(file, [0, 0, 0 if fixed else 0.5], useFixedBase=fixed)

    def steps() -> None:
        step = 0
        while not stop.wait(1 / 240):
            move(step)
            p.stepSimulation()
            step += 1

    thread = threading.Thread(target=steps)
    thread.start()
    yield
    stop.set()
    thread.join()


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
