"""The page at every width, from a phone's and a notebook's cell to a large screen."""

from __future__ import annotations

from tests.viewer.browser import Page, needs_browser

from carom.viewer.viewer import Viewer

WIDTHS = (360, 420, 560, 700, 760, 780, 850, 920, 945, 999, 1001, 1050, 1200, 1600, 2560)
# What of the controls of the time bar is cut off, or lies over another one.
CUT_OFF = """() => {
  const more = document.getElementById("more");
  const isOpen = document.getElementById("extras").classList.contains("open");
  if (more.offsetParent !== null && !isOpen) more.click();
  const shown = [...document.querySelectorAll("#timeline button, #timeline select, #track")].filter(
    (one) => one.offsetParent !== null && !one.classList.contains("tick"));
  const boxes = shown.map((one) => [one.id, one.getBoundingClientRect()]);
  const outside = boxes.filter(([, box]) =>
    box.left < 0 || box.right > innerWidth || box.bottom > innerHeight || box.top < 0);
  const over = boxes.filter(([, a], i) => boxes.slice(i + 1).some(([, b]) =>
    a.left < b.right - 0.5 && b.left < a.right - 0.5 && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5));
  return [...outside, ...over].map(([id]) => id);
}"""


@needs_browser
def test_the_time_bar_has_all_its_controls_at_every_width(viewer: Viewer, browser):
    page = Page(browser, viewer.address, 1024, 700)
    page.until("window.app?.history.count > 0")
    found = {}
    for width in WIDTHS:
        page.page.set_viewport_size({"width": width, "height": 700})
        assert page.page.locator("#save").count() == 1
        found[width] = page.page.evaluate(CUT_OFF)
        assert page.page.locator("#save").is_visible()
        assert page.page.locator("#render").is_visible()
    assert {width: cut for width, cut in found.items() if cut} == {}
    page.page.close()
