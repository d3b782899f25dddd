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
        assert output.strip().splitlines()[-1] == "KeyboardInterrupt"
        assert "continues" not in output
        assert output.count("Traceback") == 1
    finally:
        script.kill()
        script.wait()


@needs_browser
@pytest.mark.parametrize(
    ("example", "slider", "value"),
    [
        ("motor_arguments", "targetPosition [rad]", "-0.5"),
        ("pid_terms", "target [rad]", "-0.7"),
        ("joint_angle", "target [degrees]", "30"),
        ("balance_torque", "torque of the arm [N m]", "5"),
        ("inverse_kinematics", "radius [m]", "0.15"),
        ("rays_and_contacts", "push [N]", "20"),
        ("constraints", None, None),
    ],
)
def test_tutorials_run_in_the_window_and_end_with_escape(example: str, slider: str | None, value: str | None):
    script, address = started(ROOT / "examples" / f"{example}.py")
    try:
        with chromium() as browser:
            page = Page(browser, address, 900, 600)
            page.until("window.app?.history.count > 5")
            if slider is not None:
                page.page.get_by_label(slider, exact=True).fill(value)
                page.page.wait_for_timeout(500)
                assert page.page.get_by_title(f"Value of {slider}").input_value().startswith(value)
            page.page.focus("#view")
            page.page.keyboard.press("Escape")
            assert script.wait(PATIENCE) == 0
            assert page.complaints == [] or all("WebSocket" in line for line in page.complaints)
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
