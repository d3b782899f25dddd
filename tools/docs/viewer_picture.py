"""Takes the picture of the viewer in the docs: `python tools/docs/viewer_picture.py`. Needs Chromium."""

import math
import os
import shutil
import sys
import threading
import time
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

import pybullet as p
import pybullet_data
from pybullet._clients import clients
from pybullet._page_window import PageWindow

PICTURE = Path(__file__).parents[2] / "docs" / "viewer.png"
WIDTH, HEIGHT = 1280, 760
# Drawn by the processor, where there is no GPU.
ARGUMENTS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
]
ARM, ELBOW = 7, 3
REST = [0.4, -0.2, 0.1, -2.1, 0.1, 1.9, 0.9]


def set_up() -> int:
    """Fills the scene; returns the arm."""
    os.environ["CI"] = "1"
    # The page has the name of the script.
    sys.argv[0] = "panda.py"
    p.connect(p.GUI, options="--port=0")
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    p.loadURDF("r2d2.urdf", [-0.7, 0.9, 0.5], p.getQuaternionFromEuler([0, 0, -0.6]))
    for position in ([0.55, -0.3, 0.03], [0.62, -0.22, 0.03], [0.58, -0.26, 0.09]):
        p.loadURDF("cube_small.urdf", position)
    p.loadURDF("duck_vhacd.urdf", [0.65, 0.2, 0.05], p.getQuaternionFromEuler([math.pi / 2, 0, 1]))
    for joint, angle in enumerate(REST):
        p.resetJointState(arm, joint, angle)
    for name, lower, upper, value in (("kp", 0, 1, 0.3), ("kd", 0, 2, 1), ("amplitude [rad]", 0, 1, 0.35)):
        p.addUserDebugParameter(name, lower, upper, value)
    p.addUserDebugParameter("reset", 1, 0, 0)
    p.addUserDebugText("hand", [0, 0, 0.12], [1, 0.85, 0.3], 1.2, parentObjectUniqueId=arm, parentLinkIndex=8)
    for axis in range(3):
        tip = [0.15 * (axis == i) for i in range(3)]
        colour = [float(axis == i) for i in range(3)]
        p.addUserDebugLine([0, 0, 0], tip, colour, 4, parentObjectUniqueId=arm, parentLinkIndex=8)
    p.resetDebugVisualizerCamera(1.25, 62, -22, [0.25, 0.1, 0.35])
    return arm


def simulate(arm: int, stop: threading.Event) -> None:
    """Swings the arm until told to stop."""
    step = 0
    while not stop.is_set():
        swing = 0.35 * math.sin(step / 120)
        targets = [angle + swing * (joint in (1, ELBOW)) for joint, angle in enumerate(REST)]
        p.setJointMotorControlArray(
            arm, list(range(ARM)), p.POSITION_CONTROL, targets, positionGains=[0.05] * ARM
        )
        p.stepSimulation()
        if step % 240 == 0:
            view = p.computeViewMatrix([1.3, -0.9, 0.9], [0.3, 0, 0.25], [0, 0, 1])
            p.getCameraImage(320, 240, view, p.computeProjectionMatrixFOV(50, 4 / 3, 0.05, 6))
        step += 1
        time.sleep(1 / 240)


def take_picture(page: Page) -> None:
    """Plots a joint, and waits until there is something to see."""
    page.locator("#joint option").nth(ARM).wait_for(state="attached")
    page.locator("#joint").select_option(index=ELBOW + 1)
    page.wait_for_timeout(12_000)
    # Where the processor draws, only what stands still is drawn sharply.
    page.get_by_role("button", name="Pause").click()
    page.wait_for_timeout(8_000)
    page.screenshot(path=PICTURE)


def main() -> None:
    """Takes the picture."""
    browser_path = shutil.which("chromium") or shutil.which("google-chrome")
    if browser_path is None:
        sys.exit("No Chromium here.")
    arm = set_up()
    window = clients[0].window
    assert isinstance(window, PageWindow)
    stop = threading.Event()
    script = threading.Thread(target=simulate, args=(arm, stop))
    script.start()
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=browser_path, args=ARGUMENTS)
            page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
            page.set_default_timeout(120_000)
            page.goto(window.viewer.address)
            take_picture(page)
            browser.close()
    finally:
        stop.set()
        window.viewer.pause(False)
        script.join()
        p.disconnect()


if __name__ == "__main__":
    main()
