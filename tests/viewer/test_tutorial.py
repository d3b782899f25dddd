"""Whole scripts: the tutorial with sliders and ESC, as it is, driven from its page; and Ctrl-C."""

import re
import signal
import sys

import pytest
from tests.patience import PATIENCE
from tests.viewer.browser import Page, chromium, needs_browser
from tests.viewer.scripts import ROOT, started
from tests.viewer.watcher import Watcher

# Where the tests run in the background of a shell, it has told all that they start to ignore Ctrl-C.
STEPPING = """
import signal
import pybullet as p
signal.signal(signal.SIGINT, signal.default_int_handler)
p.connect(p.GUI, options="--port=0")
while p.isConnected():
    p.stepSimulation()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
@pytest.mark.parametrize("paused", [False, True])
def test_ctrl_c_ends_a_script_that_is_watched(paused: bool):
    script, address = started("-c", STEPPING)
    try:
        with Watcher(address) as page:
            page.wait_for(lambda: page.frame.get("time", 0) > 0)
            page.tell("pause", paused=paused)
            page.wait_for(lambda: page.shown["pause", None]["paused"] == paused)
            script.send_signal(signal.SIGINT)
            output, _ = script.communicate(timeout=PATIENCE)
        assert output.strip().endswith("KeyboardInterrupt")
        assert output.count("Traceback") == 1
    finally:
        script.kill()
        script.wait()


@needs_browser
def test_the_pid_tutorial_is_tuned_by_its_sliders_and_ends_with_escape():
    script, address = started(ROOT / "examples" / "pid_sliders.py")
    try:
        with chromium() as browser:
            page = Page(browser, address)
            plots = page.page.locator("#joint")
            plots.locator("option").nth(1).wait_for(state="attached")
            plots.select_option(index=1)
            angle = page.page.locator(".chart canvas[title=position]")
            angle.wait_for()
            page.page.get_by_label(re.compile(r"target \[rad\]")).fill("-0.7")
            value = None
            for _ in range(int(PATIENCE * 5)):
                value = page.page.locator(".chart").get_attribute("data-position")
                if value and abs(float(value) + 0.7) < 0.03:
                    break
                page.page.wait_for_timeout(200)
            else:
                raise AssertionError(f"the arm is at {value}")
            page.page.focus("#view")
            page.page.keyboard.press("Escape")
            assert script.wait(PATIENCE) == 0
            page.page.get_by_text("has ended").wait_for()
    finally:
        script.kill()
        script.wait()
