"""Texts in the view keep clear of each other and of the panel; names and small numbers are readable."""

from itertools import combinations
from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()
BOXES = """() => [...document.querySelectorAll("#labels span:not([hidden])")].map((span) => {
  const { left, top, right, bottom } = span.getBoundingClientRect();
  return { text: span.textContent, left, top, right, bottom };
})"""


def meet(a: dict, b: dict) -> bool:
    return (
        a["left"] < b["right"]
        and b["left"] < a["right"]
        and a["top"] < b["bottom"]
        and b["top"] < a["bottom"]
    )


def test_names_of_links_do_not_cover_each_other(page: Page):
    p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    page.until("app.scene.bodies.size === 1")
    # From above, where the links are one behind the other.
    p.resetDebugVisualizerCamera(2, 0, -89, [0, 0, 0])
    page.page.locator("input[name=linkNames]").check()
    wait_for(lambda: len(page.page.evaluate(BOXES)) > 8, page)
    boxes = page.page.evaluate(BOXES)
    assert [(a["text"], b["text"]) for a, b in combinations(boxes, 2) if meet(a, b)] == []


def test_texts_of_a_script_neither_overlap_nor_run_under_the_panel(page: Page):
    p.resetDebugVisualizerCamera(2, 0, 0, [0, 0, 0])
    for number in range(3):
        p.addUserDebugText(f"text {number}", [0, 0, 0])
    # It would end under the panel, and the last one is behind it.
    p.addUserDebugText("a long text beside the panel", [0.4, 0, 0.5])
    p.addUserDebugText("covered", [2.2, 0, 1])
    page.until("app.camera.distance === 2")
    wait_for(lambda: len(page.page.evaluate(BOXES)) == 4, page)
    page.until_drawn()
    boxes = page.page.evaluate(BOXES)
    panel = page.page.evaluate("app.panel.root.getBoundingClientRect().toJSON()")
    assert {box["text"] for box in boxes} == {"text 0", "text 1", "text 2", "a long text beside the panel"}
    assert [pair for pair in combinations(boxes, 2) if meet(*pair)] == []
    assert [box for box in boxes if meet(box, panel)] == []
    # The first one is where the script has put it: its lower left corner.
    first = next(box for box in boxes if box["text"] == "text 0")
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0])")
    assert (first["left"], first["bottom"]) == pytest.approx((x, y), abs=1)


def test_robots_of_one_file_are_told_apart_wherever_they_are_named(page: Page):
    for x in (0, 1):
        p.loadURDF(f"{DATA}/cartpole.urdf", [x, 0, 0])
    page.until("app.scene.bodies.size === 2")
    wait_for(lambda: page.page.locator("#joint option").count() > 4, page)
    titles = page.page.locator("#joint optgroup[label=Joints] option").all_text_contents()
    joints = ("slider_to_cart", "cart_to_pole")
    assert titles == [f"physics (body {number}) · {joint}" for number in (0, 1) for joint in joints]
    page.page.evaluate("app.bodies.select(1); document.getElementById('bodies').open = true")
    assert page.page.locator("#body-card h2").text_content() == "physics (body 1)"


def test_files_of_one_name_are_told_apart_by_their_folders(page: Page, tmp_path: Path):
    visual = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
    for folder in ("left", "right"):
        (tmp_path / folder).mkdir()
        file = tmp_path / folder / "ball.urdf"
        file.write_text(f'<robot name="ball"><link name="base">{visual}</link></robot>')
        p.loadURDF(str(file))
    page.until("app.scene.bodies.size === 2")
    texts = page.page.locator("#bodies-list button[data-body]").all_text_contents()
    assert texts == ["0  ball (left/ball.urdf)", "1  ball (right/ball.urdf)"]


def test_a_slider_of_a_tiny_range_has_digits_and_steps_of_its_size(page: Page):
    slider = p.addUserDebugParameter("tiny", 0, 1e-6, 5e-7)
    plain = p.addUserDebugParameter("plain", -1, 1, -0.0001)
    typed = page.page.get_by_title("Value of tiny")
    typed.wait_for()
    assert typed.input_value() == "5.00e-7"
    # The whole number is seen.
    assert typed.evaluate("field => field.scrollWidth <= field.clientWidth")
    assert page.page.get_by_title("Value of plain").input_value() == "0.000"
    typed.press("ArrowUp")
    wait_for(lambda: p.readUserDebugParameter(slider) == pytest.approx(5.1e-7, rel=1e-6), page)
    typed.fill("2.5e-7")
    typed.press("Enter")
    wait_for(lambda: p.readUserDebugParameter(slider) == pytest.approx(2.5e-7, rel=1e-9), page)
    track = page.page.locator(f"#slider-{slider}")
    box = track.bounding_box()
    assert box is not None
    page.page.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + box["height"] / 2)
    wait_for(lambda: p.readUserDebugParameter(slider) == pytest.approx(7.5e-7, abs=3e-8), page)
    page.page.get_by_title("Reset tiny").click()
    wait_for(lambda: p.readUserDebugParameter(slider) == pytest.approx(5e-7, rel=1e-9), page)
    assert p.readUserDebugParameter(plain) == -0.0001
