"""Takes the pictures of the viewer: `PYTHONPATH=. python tools/docs/viewer_pictures.py [NAME ...]`.

Each shows a page of a program that runs meanwhile. Needs Chromium.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from tests.viewer.browser import Page, chromium
from tests.viewer.scripts import ROOT, started

DOCS = ROOT / "docs"
WIDTH, HEIGHT = 1280, 760
# Where the processor draws, what moves is drawn coarsely, and what stands still takes its time to get sharp.
STILL = 8_000


def panda(page: Page) -> None:
    """A joint that has been plotted for a while, and the images of a camera."""
    plot(page, "panda_joint4")
    page.page.wait_for_timeout(12_000)
    pause(page)


def pid(page: Page) -> None:
    """An arm that follows its slider."""
    plot(page, "shoulder")
    for target in ("-0.8", "1.2"):
        page.page.get_by_label("target [rad]").fill(target)
        page.page.wait_for_timeout(3_500)
    pause(page)


def robot(page: Page) -> None:
    """A robot file: a joint that was moved, the name of a link, and its frame."""
    for joint, angle in (("joint_2", "0.6"), ("joint_4", "-1.3"), ("joint_6", "0.9")):
        field = page.page.locator(f"#joints-list input[aria-label$='{joint}']")
        field.fill(angle)
        field.press("Enter")
    page.page.wait_for_timeout(3_000)
    for row in range(HEIGHT // 4, HEIGHT, 25):
        page.page.mouse.move(WIDTH / 2, row)
        page.page.wait_for_timeout(500)
        if page.page.locator(".hover").is_visible():
            break
    page.page.wait_for_timeout(STILL)


def mirror(page: Page) -> None:
    """Things on a floor that mirrors them."""
    page.page.wait_for_timeout(STILL)


def crowd(page: Page) -> None:
    """A thousand bodies."""
    page.page.wait_for_timeout(20_000)
    pause(page)


def plot(page: Page, joint: str) -> None:
    """Begins to plot a joint."""
    choice = page.page.locator("#joint")
    option = choice.locator("optgroup[label=Joints] option", has_text=joint)
    option.wait_for(state="attached")
    choice.select_option(value=option.get_attribute("value"))


def pause(page: Page) -> None:
    """Holds the program, and waits until the picture is sharp."""
    page.page.get_by_role("button", name="Pause").click()
    page.page.wait_for_timeout(STILL)


Picture = tuple[Path, list[str | Path], Callable[[Page], None]]
SCENES = ROOT / "tools" / "docs" / "viewer_scenes.py"
PICTURES: dict[str, Picture] = {
    "panda": (DOCS / "viewer.png", [SCENES, "panda"], panda),
    "pid": (DOCS / "tutorials" / "pid-sliders.png", [ROOT / "examples" / "pid_sliders.py"], pid),
    "robot": (DOCS / "robot-view.png", ["-m", "carom", "view", "kuka_iiwa/model.urdf", "--port", "0"], robot),
    "mirror": (DOCS / "mirror.png", [SCENES, "mirror"], mirror),
    "crowd": (DOCS / "crowd.png", [SCENES, "crowd"], crowd),
}


def main() -> None:
    """Takes the pictures that are named, or all."""
    for name in sys.argv[1:] or PICTURES:
        file, command, prepare = PICTURES[name]
        script, address = started(*command)
        try:
            with chromium() as browser:
                page = Page(browser, address, WIDTH, HEIGHT)
                page.page.set_default_timeout(120_000)
                page.page.wait_for_timeout(4_000)
                prepare(page)
                page.page.screenshot(path=file)
        finally:
            script.kill()
            script.wait()


if __name__ == "__main__":
    main()
