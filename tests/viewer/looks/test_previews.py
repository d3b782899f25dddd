"""Previews of camera images are folded, enlarged and moved, and the browser remembers it."""

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
FIGURE = "#previews figure:has(span:text('{}'))"


def photograph(width: int = 640) -> None:
    p.getCameraImage(width, width // 2, *p.getDebugVisualizerCamera()[2:4])


def place(page: Page) -> tuple[float, float]:
    box = page.page.locator("#previews").bounding_box()
    assert box is not None
    return box["x"], box["y"]


def pixels(page: Page, title: str) -> int:
    return page.page.locator(FIGURE.format(title)).locator("canvas").evaluate("canvas => canvas.width")


def width(page: Page, title: str) -> float:
    box = page.page.locator(FIGURE.format(title)).locator("canvas").bounding_box()
    return 0 if box is None else box["width"]


def test_previews_are_folded_enlarged_moved_and_remembered(page: Page, viewer: Viewer):
    photograph()
    page.page.get_by_text("segmentation").wait_for()
    assert pixels(page, "colour") <= 200
    small = width(page, "colour")
    page.page.get_by_title("Fold the preview of depth").click()
    assert width(page, "depth") == 0
    page.page.get_by_title("Enlarge the preview of colour").click()
    large = width(page, "colour")
    assert large > 1.4 * small

    def finer() -> bool:
        photograph()
        return pixels(page, "colour") > 300

    wait_for(finer, page)
    before = place(page)
    caption = page.page.locator(FIGURE.format("colour")).locator("figcaption span")
    box = caption.bounding_box()
    assert box is not None
    x, y = box["x"] + 5, box["y"] + 5
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    page.page.mouse.move(x + 60, y - 80, steps=4)
    page.page.mouse.up()
    moved = place(page)
    assert moved == pytest.approx((before[0] + 60, before[1] - 80), abs=1)
    page.until_kept()
    page.page.reload()
    page.until("window.app?.scene.layout.layout > 0")
    photograph()
    page.page.get_by_text("segmentation").wait_for()
    assert width(page, "depth") == 0
    assert width(page, "colour") == pytest.approx(large)
    assert place(page) == pytest.approx(moved, abs=1)
    caption.dblclick()
    assert place(page) == pytest.approx(before, abs=1)
    page.page.get_by_title("Fold the preview of depth").click()
    assert width(page, "depth") > 0


def test_previews_stay_in_a_window_that_becomes_small(page: Page):
    photograph()
    page.page.get_by_text("segmentation").wait_for()
    for title in ("depth", "segmentation"):
        page.page.get_by_title(f"Fold the preview of {title}").click()
    page.page.evaluate("app.previews.change({ place: [600, 300] })")
    page.page.set_viewport_size({"width": 500, "height": 320})

    def is_within() -> bool:
        box = page.page.locator("#previews").bounding_box()
        return box is not None and box["x"] + box["width"] <= 500 and box["y"] + box["height"] <= 320

    # The window is as small at once; what is in it is laid out again with the next frame.
    wait_for(is_within, page)
    page.page.set_viewport_size({"width": 1400, "height": 900})
    wait_for(lambda: place(page) == (600, 300), page)
