"""What it costs to be watched: `PYTHONPATH=. python benchmarks/watching.py [--page docs/viewer.md]`.

Needs Chromium. The questions: what opening a page costs, what many moving bodies cost the server for each
frame, what they cost the page, apart from drawing, which a graphics card does, by how much stepping takes
longer than without a window, how long a slider takes to the script, what a page at rest takes, how smoothly
robots, many worlds and a replay move without a graphics card, and how memory grows (`--minutes 30`).
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from hands import move_a_slider, scrub_a_replay, watch_robots, window
from lasting import grow, rest
from opening import PICTURES, open_pages, watch_many_worlds
from run import put_between_marks, readable
from tests.viewer.browser import Page, chromium
from websockets.sync.client import connect

import pybullet as p
import pybullet_data
from carom.viewer.messages import decoded

WANTED_PERIOD = 1.0 / 30.0
WANTED_SHARE = 0.05
WANTED_SLOWDOWN = 0.20
STEPS_IN_A_BLOCK, BLOCKS, ROUNDS = 5000, 4, 12
# Windows: what they are called in the table, options of `connect`, and whether a page is open.
CASES = (
    ("a window, `--history=0` and no page open", "--history=0", False),
    ("a window and no page open", "", False),
    ("a page open", "", True),
)
SECONDS_TRACED = 6.0
SECONDS_OF_READING = 1.0

# A page that takes what it is sent and draws nothing; it says when it is connected, and goes with its input.
READER = """
import sys
from threading import Thread
from websockets.sync.client import connect
socket = connect(sys.argv[1], max_size=None)
socket.recv()
Thread(target=lambda: (sys.stdin.read(), socket.close()), daemon=True).start()
print("connected", flush=True)
for message in socket:
    pass
"""


def crowd(count: int) -> None:
    """Boxes, balls and cylinders that spin, in all colours."""
    random = np.random.default_rng(0)
    shapes = [
        p.createVisualShape(p.GEOM_BOX, halfExtents=[0.05, 0.06, 0.07]),
        p.createVisualShape(p.GEOM_SPHERE, radius=0.06),
        p.createVisualShape(p.GEOM_CYLINDER, radius=0.05, length=0.15),
    ]
    side = int(count**0.5)
    for n in range(count):
        place = [0.3 * (n % side - 0.5 * side), 0.3 * (n // side - 0.5 * side), 0.5]
        body = p.createMultiBody(1, -1, shapes[n % 3], place)
        p.resetBaseVelocity(body, [0, 0, 0], random.normal(size=3).tolist())
        p.changeVisualShape(body, -1, rgbaColor=[*random.random(3).tolist(), 1])
    p.resetDebugVisualizerCamera(0.2 * side, 40, -30, [0, 0, 0])


@contextmanager
def moving() -> Iterator[None]:
    """Steps the world at display rate, in a thread."""
    stop = threading.Event()

    def steps() -> None:
        while not stop.wait(1 / 60):
            p.stepSimulation()

    thread = threading.Thread(target=steps)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def work_of_main_thread(session: Any, page: Page) -> tuple[float, int]:
    """Processor time of a page's main thread [s] while it is traced, and how many pictures it began."""
    events: list[dict[str, Any]] = []
    finished = threading.Event()
    session.on("Tracing.dataCollected", lambda data: events.extend(data["value"]))
    session.on("Tracing.tracingComplete", lambda _: finished.set())
    categories = {"includedCategories": ["toplevel", "devtools.timeline"], "excludedCategories": ["*"]}
    session.send("Tracing.start", {"traceConfig": categories, "transferMode": "ReportEvents"})
    page.page.wait_for_timeout(1000 * SECONDS_TRACED)
    session.send("Tracing.end")
    while not finished.is_set():
        page.page.wait_for_timeout(50)
    main = {
        (event["pid"], event["tid"])
        for event in events
        if event["name"] == "thread_name" and event["args"]["name"] == "CrRendererMain"
    }
    done = [event for event in events if event["ph"] == "X" and (event["pid"], event["tid"]) in main]
    work = sum(event.get("tdur", 0) for event in done if event["name"] == "ThreadControllerImpl::RunTask")
    return work / 1e6, sum(event["name"] == "FireAnimationFrame" for event in done)


def watch_a_crowd(count: int) -> list[list[str]]:
    """Rows of the table about frames of many bodies."""
    with window() as shown, moving(), chromium() as browser:
        crowd(count)
        page = Page(browser, shown.viewer.address, 640, 480)
        page.page.wait_for_timeout(3000)
        server = clock_of_server()
        before, began = time.clock_gettime(server), time.perf_counter()
        work, pictures = work_of_main_thread(browser.new_browser_cdp_session(), page)
        passed = time.perf_counter() - began
        server_share = (time.clock_gettime(server) - before) / passed
        drawn, _ = page.page.evaluate(PICTURES, SECONDS_TRACED)
        page.page.close()
        size = size_of_frame(shown.viewer.address)
    # A page that has time for fewer pictures takes all frames the same, so this is the most it can be.
    by_picture = work / max(pictures, 1)
    wanted = f"≤ {readable(WANTED_PERIOD)}"
    return [
        [f"a frame of {count:,} bodies on its way", f"{size:,} bytes", "", ""],
        ["the server's thread, a frame", readable(server_share / 60), "", ""],
        [
            "the same at 30 frames a second, of a core",
            f"{50 * server_share:.1f} %",
            f"≤ {100 * WANTED_SHARE:.0f} %",
            "PASS" if 0.5 * server_share <= WANTED_SHARE else "FAIL",
        ],
        ["the page's main thread, a picture", readable(by_picture), wanted, mark(by_picture)],
        ["pictures a second without a graphics card", f"{drawn:.0f}", "", ""],
    ]


def watch_for(minutes: float) -> list[list[str]]:
    """Rows of the table about memory while a hundred bodies move."""
    with window() as shown, moving(), chromium() as browser:
        crowd(100)
        return grow(Page(browser, shown.viewer.address, 640, 480), minutes)


def clock_of_server() -> int:
    """The processor clock of the thread that sends."""
    (server,) = (thread for thread in threading.enumerate() if thread.name == "carom viewer")
    assert server.ident is not None
    return time.pthread_getcpuclockid(server.ident)


def size_of_frame(address: str) -> int:
    """Length of the message with the poses of all bodies."""
    with connect(address.replace("http", "ws", 1).replace("/?", "/socket?", 1), max_size=None) as socket:
        while True:
            message = socket.recv()
            assert isinstance(message, bytes)
            if decoded(message)[0]["type"] == "frame":
                return len(message)


def mark(seconds: float) -> str:
    """Whether there is time for it 30 times a second."""
    return "PASS" if seconds <= WANTED_PERIOD else "FAIL"


def block(client: int = 0) -> float:
    """Processor time of a step, as the mean over a block long enough for several frames [s]."""
    began = time.thread_time()
    for _ in range(STEPS_IN_A_BLOCK):
        p.stepSimulation(client)
    return (time.thread_time() - began) / STEPS_IN_A_BLOCK


def watch_the_panda() -> list[list[str]]:
    """Rows of the table about the Panda under its default motors: with a window beside `DIRECT`, in turns.

    A step waits for the server's thread at most while that works, as both need the interpreter: so what a
    window costs is what a step's own time grows by, and the time that the server takes.
    """
    rows: list[list[str]] = []
    for title, options, is_watched in CASES:
        with window(options) as shown, without_window() as beside, ExitStack() as stack:
            panda(0)
            panda(beside)
            # Meanwhile the server's thread reads the files of the robot, which it does once.
            time.sleep(SECONDS_OF_READING)
            if is_watched:
                stack.enter_context(reader(shown.viewer.address))
            direct, seen, share = compare(beside)
        slower = seen / direct * (1.0 + share) - 1.0
        verdict = "PASS" if slower <= WANTED_SLOWDOWN else "FAIL"
        if not rows:
            rows.append(["a step of the Panda in `DIRECT`", readable(direct), "", ""])
        rows += [
            [f"a step with {title}", readable(seen), "", ""],
            ["the server's thread meanwhile, of a core", f"{100 * share:.1f} %", "", ""],
            ["so longer than in `DIRECT` by", f"{100 * slower:.0f} %", "≤ 20 %", verdict],
        ]
    return rows


def compare(beside: int) -> tuple[float, float, float]:
    """Times of a step of connection `beside` and of 0 [s], in turns, and the share of 0's server."""
    direct: list[float] = []
    seen: list[float] = []
    serving = passed = 0.0
    server = clock_of_server()
    for _ in range(ROUNDS):
        direct += [block(beside) for _ in range(BLOCKS)]
        before, began = time.clock_gettime(server), time.perf_counter()
        seen += [block() for _ in range(BLOCKS)]
        serving += time.clock_gettime(server) - before
        passed += time.perf_counter() - began
    return statistics.median(direct), statistics.median(seen), serving / passed


def panda(client: int) -> None:
    """The arm, at rest under its default motors; its kernels are there."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    p.loadURDF("franka_panda/panda.urdf", useFixedBase=True, physicsClientId=client)
    block(client)


@contextmanager
def without_window() -> Iterator[int]:
    """The number of a connection without a window."""
    client = p.connect(p.DIRECT)
    yield client
    p.disconnect(client)


@contextmanager
def reader(address: str) -> Iterator[None]:
    """Somebody who watches from another process."""
    command = [sys.executable, "-c", READER, address.replace("http", "ws", 1).replace("/?", "/socket?", 1)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdout.readline()
        yield
        process.stdin.close()
        process.wait()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time what watching costs.")
    parser.add_argument("--bodies", type=int, default=1000)
    parser.add_argument("--minutes", type=float, default=0, help="how long memory is watched")
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    arguments = parser.parse_args()
    header = [["what", "cost", "wanted", ""], ["---", "---:", "---", "---"]]
    rows = header + open_pages() + watch_a_crowd(arguments.bodies) + watch_many_worlds() + watch_the_panda()
    rows += move_a_slider() + rest() + watch_robots() + scrub_a_replay()
    rows += watch_for(arguments.minutes) if arguments.minutes else []
    figures = "\n".join("| " + " | ".join(row) + " |" for row in rows)
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures)


if __name__ == "__main__":
    main()
