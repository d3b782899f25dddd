"""Whole scripts: the tutorials with sliders and ESC, as they are, driven from their pages; and Ctrl-C."""

import re
import signal
import sys

import pytest
from tests.patience import PATIENCE
from tests.viewer.browser import Page, needs_browser
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


# What is moved in the page (sliders to a value, buttons without one), and what then comes true there.
TUTORIALS: dict[str, tuple[list[tuple[str, str | None]], str]] = {
    # The slider holds the arm that swings.
    "default_motors": ([("force of the second motor [N m]", "20")], "still(1, 1)"),
    "control_modes": (
        [
            ("angle of POSITION and PD [rad]", "-0.5"),
            ("speed of VELOCITY [rad/s]", "-1"),
            ("torque of TORQUE [N m]", "-5"),
        ],
        # POSITION arrives; PD hangs short of the angle.
        "Math.abs(angle(0, 1) + 0.5) < 0.01 && angle(3, 1) < -0.3 && angle(3, 1) > -0.5",
    ),
    "motor_arguments": ([("targetPosition [rad]", "-0.5")], "Math.abs(angle(0, 1) + 0.5) < 0.01"),
    "pid_terms": ([("target [rad]", "-0.7")], "Math.abs(angle(2, 1) + 0.7) < 0.02"),
    "joint_angle": (
        [("target [degrees]", "30")],
        "label('30.0°')",
    ),
    "gravity_torque": ([("angle [rad]", "-0.8")], "Math.abs(angle(0, 1) + 0.8) < 0.1"),
    "balance_torque": ([("torque of the arm [N m]", "5")], "angle(0, 1) < 0.9"),
    "panda_control": ([("seconds for each way", "1")], "document.querySelector('#clock').textContent > 5"),
    "dropping": ([("height [m]", "4"), ("drop again", None)], "place(1, 0)[2] > 3"),
    "robot_info": ([("link", "13")], "label('head')"),
    "inverse_kinematics": (
        [("radius [m]", "0.15")],
        "Math.hypot(place(0, 12)[0] - 0.5, place(0, 12)[1]) > 0.13",
    ),
    "rays_and_contacts": ([("push [N]", "40")], "place(1, 0)[0] > 0.1"),
    "constraints": ([], "place(1, 0)[2] < 0.1"),
    "frames": ([("shoulder [rad]", "0.5")], "place(0, 9)[2] > 0.6 && app.drawings.items.size === 3"),
    "save_and_restore": ([("push [N]", "0"), ("again", None)], "Math.abs(place(1, 0)[0]) < 0.02"),
    "stacking": ([("speed of the ball [m/s]", "8"), ("throw a ball", None)], "place(10, 0)[2] < 0.5"),
    "grasping": ([("height when lifted [m]", "0.5")], "place(2, 0)[2] > 0.45"),
    "driving": ([("speed", "1"), ("turn", "0.5")], "place(1, 0)[1] > 1"),
    "standing": ([("0 stand, 1 sit", "1"), ("push", None)], "place(1, 0)[2] < 0.2"),
}
# Places of links and angles of joints about the y axis, as the page has them.
HELPERS = """() => Object.assign(window, {
    place: (body, link) => app.scene.inertialPose(body, link)?.position ?? [NaN, NaN, NaN],
    angle: (body, link) => {
        const [x, y, z, w] = app.scene.inertialPose(body, link)?.orientation ?? [NaN, NaN, NaN, NaN];
        return Math.atan2(2 * w * y, 1 - 2 * y * y);
    },
    still: async (body, link) => {
        const before = angle(body, link);
        await new Promise((passed) => setTimeout(passed, 300));
        return Math.abs(angle(body, link) - before) < 1e-3;
    },
    label: (words) => document.querySelector("#labels").textContent.includes(words),
})"""


@needs_browser
@pytest.mark.parametrize("example", TUTORIALS)
def test_tutorials_run_in_the_window_and_end_with_escape(example: str, browser):
    moves, outcome = TUTORIALS[example]
    script, address = started(ROOT / "examples" / f"{example}.py")
    try:
        page = Page(browser, address, 900, 600)
        page.until("window.app?.history.count > 0")
        page.page.evaluate(HELPERS)
        for name, value in moves:
            if value is None:
                page.page.get_by_role("button", name=name, exact=True).click()
            else:
                page.page.get_by_label(name, exact=True).fill(value)
                assert page.page.get_by_title(f"Value of {name}").input_value().startswith(value)
        page.until(outcome)
        page.page.focus("#view")
        page.page.keyboard.press("Escape")
        assert script.wait(PATIENCE) == 0
        page.page.get_by_text("has ended").wait_for()
        page.expect_the_end()
        assert page.complaints == []
        page.page.close()
        assert script.stdout is not None
        assert "Traceback" not in script.stdout.read()
    finally:
        script.kill()
        script.wait()


@needs_browser
def test_the_pid_tutorial_is_tuned_by_its_sliders_and_ends_with_escape(browser):
    script, address = started(ROOT / "examples" / "pid_sliders.py")
    try:
        page = Page(browser, address)
        plots = page.page.locator("#joint")
        plots.locator("option").nth(1).wait_for(state="attached")
        plots.select_option(index=1)
        angle = page.page.locator(".chart canvas[title=position]")
        angle.wait_for()
        page.page.get_by_label(re.compile(r"^target \[rad\]")).fill("-0.7")
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
