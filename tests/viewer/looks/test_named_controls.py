"""Every control has a name that screen readers take, which a title alone is not (axe-core's rules)."""

from __future__ import annotations

from pathlib import Path

from tests.viewer.browser import Page, needs_browser

import pybullet as p
import pybullet_data

pytestmark = needs_browser
DATA = Path(pybullet_data.getDataPath())
NAMELESS = """() => [...document.querySelectorAll("input, select, textarea")].filter((one) => {
  const labels = [...one.labels].some((label) => label.textContent.trim());
  return !labels && !one.ariaLabel && !one.getAttribute("aria-labelledby");
}).map((one) => one.outerHTML)"""
WITHOUT_ROLE = """() => ["div", "span"].flatMap(
  (tag) => [...document.querySelectorAll(`${tag}[aria-label]:not([role])`)]
).map((one) => one.outerHTML)"""


def test_each_control_has_a_name_and_no_mere_box_has_one(page: Page):
    p.addUserDebugParameter("gain", 0, 1, 0.5)
    p.loadURDF(str(DATA / "kuka_iiwa/model.urdf"), useFixedBase=True)
    page.until("app.panel.controls.size === 1 && app.scene.bodies.size === 1")
    page.page.locator("#bodies summary").click()
    page.page.locator("#bodies-list button[data-body]").first.click()
    page.until("document.querySelectorAll('.slider select, .slider input[type=number]').length > 7")
    assert page.page.evaluate(NAMELESS) == []
    assert page.page.evaluate(WITHOUT_ROLE) == []
