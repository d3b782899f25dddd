"""The dark theme, bodies of one name, dragging while paused, and the token in notebooks."""

from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom import World
from carom.viewer import viewer as viewers
from carom.viewer.viewer import Viewer

DATA = pybullet_data.getDataPath()


@needs_browser
def test_a_dark_theme_follows_the_system(page: Page):
    colour = "getComputedStyle(document.getElementById('panel')).color"
    light = page.page.evaluate(colour)
    page.page.emulate_media(color_scheme="dark")
    assert page.page.evaluate(colour) != light


@needs_browser
def test_bodies_of_one_name_are_told_apart_by_their_files(page: Page, tmp_path: Path):
    visual = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
    text = f'<robot name="ball"><link name="base">{visual}</link></robot>'
    for name in ("left.urdf", "right.urdf"):
        (tmp_path / name).write_text(text)
        p.loadURDF(str(tmp_path / name))
    page.until("app.scene.bodies.size === 2")
    names = page.page.evaluate("[...app.scene.bodies.values()].map((body) => body.name)")
    assert names[0] == names[1]
    texts = page.page.locator("#bodies-list button[data-body]").all_text_contents()
    assert "left.urdf" in texts[0]
    assert "right.urdf" in texts[1]


@needs_browser
def test_a_body_is_dragged_while_paused(page: Page, viewer: Viewer):
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.2)
    ball = p.createMultiBody(1, shape, basePosition=[0, 0, 0.5])
    p.resetDebugVisualizerCamera(2, 0, -20, [0.3, 0, 0.5])
    page.until("app.camera.distance === 2 && app.scene.groups.length > 0")
    viewer.pause(True)
    start, end = (page.page.evaluate(f"app.camera.pixel([{x}, 0, 0.5])")[:2] for x in (0, -0.5))
    page.page.mouse.move(*start)
    page.page.mouse.down()
    page.page.mouse.move(*end, steps=4)
    wait_for(lambda: p.getBasePositionAndOrientation(ball)[0][0] == pytest.approx(-0.5, abs=0.1), page)
    page.page.mouse.up()


def test_the_output_of_a_notebook_has_no_lasting_token(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(viewers, "user_token", lambda: "lasting")
    for notebook in (False, True):
        monkeypatch.setattr(viewers, "in_notebook", lambda notebook=notebook: notebook)
        shown = Viewer(World(), port=0)
        try:
            assert ("lasting" in shown._repr_html_()) is not notebook
        finally:
            shown.close()
