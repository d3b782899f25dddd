"""The window draws MJCF files as they say: groups, sites, tendons, lights, sky, mirrors and cameras."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser

from carom import World
from carom.scene.tendons.making import tendons_of
from carom.scene.tendons.slack import is_slack
from carom.viewer import readings
from carom.viewer.viewer import Viewer

SCENE = """<mujoco>
  <visual><headlight ambient=".2 .2 .2" diffuse="0 0 0" specular="0 0 0"/></visual>
  <asset>
    <texture type="skybox" builtin="flat" rgb1=".1 .8 .2" rgb2=".1 .8 .2" width="16"/>
    <material name="floor" rgba=".6 .6 .6 1" reflectance=".5"/>
  </asset>
  <worldbody>
    <light directional="true" pos="0 0 3" dir="0 0 -1" diffuse=".8 .8 .8"/>
    <geom name="floor" type="plane" size="4 4 .1" pos="0 0 .1" material="floor"/>
    <site name="post" pos="0 -.6 1"/>
    <camera name="aside" pos="0 -2 1" xyaxes="1 0 0 0 0 1"/>
    <body name="arm" pos="0 0 1">
      <joint name="j" axis="1 0 0"/>
      <geom type="box" size=".2 .2 .2" rgba="1 0 0 1" contype="0" conaffinity="0" group="1"/>
      <geom type="box" size=".3 .3 .3" rgba="0 0 1 1" group="3"/>
      <site name="tip" pos="0 -.25 0" size=".05" rgba="1 1 0 1" group="0"/>
      <site name="hidden" pos="0 0 .6" size=".05" rgba="0 1 1 1" group="4"/>
      <camera name="moving" pos="0 0 .4"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="slack" width=".02" rgba="1 0 1 1" range="0 2">
      <site site="post"/><site site="tip"/>
    </spatial>
    <spatial name="taut" width=".01" rgba="0 1 1 1" stiffness="5">
      <site site="post"/><site site="hidden"/>
    </spatial>
  </tendon>
</mujoco>"""


@pytest.fixture
def world(tmp_path: Path) -> World:
    (tmp_path / "scene.xml").write_text(SCENE)
    world = World()
    world.load(tmp_path / "scene.xml")
    return world


def test_a_tendon_is_slack_where_nothing_pulls(world: World):
    body = next(body for body in world.bodies.values() if body.name == "arm")
    slack, taut = tendons_of(body)
    assert is_slack(slack, 1.0) and not is_slack(slack, 2.0) and not is_slack(slack, -0.1)
    assert not is_slack(taut, 1.0)
    rows, looks = readings.tendons(world)
    assert len(rows) == len(looks) == 2
    np.testing.assert_allclose(looks[0], [1, 0.02, 1, 0, 1, 1, 0], rtol=1e-6)
    np.testing.assert_allclose(looks[1], [0, 0.01, 0, 1, 1, 1, 0], rtol=1e-6)


@pytest.mark.long
@needs_browser
class TestOnThePage:
    """What the page draws."""

    @pytest.fixture
    def page(self, world: World, browser) -> Iterator[Page]:
        viewer = Viewer(world, port=0)
        page = Page(browser, viewer.address)
        page.until("window.app?.scene.bodies.size === 2 && app.overlays.stage.facts !== null")
        page.until("app.scene.groups.length > 0 && app.readings.tendons.length === 2")
        page.page.evaluate("""() => {
            app.cameraMoved();
            Object.assign(app.camera, { distance: 2, yaw: 0, pitch: -10, target: [0, 0, 0.9] });
            app.camera.update();
            app.changed();
        }""")
        yield page
        page.page.close()
        assert page.complaints == []
        viewer.close()

    def click(self, page: Page, name: str) -> None:
        page.page.evaluate(f"document.querySelector('input[name={name}]').click()")

    def middle(self, page: Page, point: str) -> str:
        """An expression for the colour of the picture where a point is."""
        return f"(() => {{ const p = app.camera.pixel({point}); return [p[0], p[1]]; }})()"

    def until_coloured(self, page: Page, point: str, holds) -> None:
        """Waits until the colour where a point is seen is as it should be."""
        x, y = page.page.evaluate(self.middle(page, point))
        page.wait_for_picture(lambda picture: holds(*picture[round(y), round(x)].tolist()))

    def test_groups_are_switches_and_three_are_shown_at_first(self, page: Page):
        for name in ("shapes", "sites", "tendons"):
            shown = page.page.evaluate(
                f"[0, 1, 2, 3, 4, 5].map((n) => document.querySelector(`input[name={name}${{n}}]`).checked)"
            )
            assert shown == [True] * 3 + [False] * 3
        assert page.page.evaluate("app.toggles.sections.every(({ section }) => !section.hidden)")
        near = "[0.12, -0.2, 1.15]"
        self.until_coloured(page, near, lambda r, g, b: r > 2 * max(g, b))
        self.click(page, "shapes3")
        self.until_coloured(page, near, lambda r, g, b: b > 2 * max(r, g))
        self.click(page, "shapes3")
        self.until_coloured(page, near, lambda r, g, b: r > 2 * max(g, b))
        self.click(page, "sites0")
        page.until(
            "!app.scene.groups.some((group) => group.site && app.options.shows(group) && group.group === 0)"
        )
        self.click(page, "sites4")
        page.until(
            "app.scene.groups.some((group) => group.site && app.options.shows(group) && group.group === 4)"
        )

    def test_a_click_on_a_site_meets_what_is_behind_it(self, page: Page):
        self.click(page, "sites4")
        page.until("app.options.sites4")
        page.page.evaluate("app.bodies.select(1, 0)")
        self.until_coloured(page, "[0, 0, 1.6]", lambda r, g, b: min(g, b) > 1.5 * r)
        x, y = page.page.evaluate(self.middle(page, "[0, 0, 1.6]"))
        # The panel may be over that place.
        assert page.page.evaluate(f"(app.pointer.clicked({x}, {y}), app.bodies.selected)") is None

    def test_tendons_are_seen_at_first_and_slack_ones_dashed(self, page: Page):
        assert page.page.evaluate("app.options.tendons")
        count = """(wanted) => {
            const { lines } = app.overlays;
            app.drawScene();
            let found = [];
            for (let at = 0; at < lines.count * 10; at += 10) {
                const colour = [...lines.data.subarray(at + 6, at + 9)];
                if (colour.join() === wanted) found.push(lines.data[at + 9]);
            }
            return found;
        }"""
        assert page.page.evaluate(count, "0,1,1") != []
        assert len(page.page.evaluate(count, "0,1,1")) == 1
        dashes = page.page.evaluate(count, "1,0,1")
        assert len(dashes) > 1
        # As wide as 2 radii at that distance.
        depth = page.page.evaluate(
            "app.camera.forward.reduce((sum, x, i) => sum + x * ([0, -0.425, 1][i] - app.camera.eye[i]), 0)"
        )
        focal = page.page.evaluate("app.camera.height / 2")
        assert dashes[0] == pytest.approx(0.04 * focal / depth, rel=1e-4)
        self.click(page, "tendons0")
        page.until("!app.options.tendons0")
        assert page.page.evaluate(count, "1,0,1") == []

    def test_a_switch_that_the_user_has_set_counts_more_than_the_file(self, page: Page):
        self.click(page, "tendons")
        page.until_kept()
        page.page.reload()
        page.until("window.app?.overlays.stage.facts?.tendons")
        assert not page.page.evaluate("app.options.tendons")

    def test_the_lights_and_the_sky_are_those_of_the_file(self, page: Page):
        # Lit from above alone, with a fifth of its colour elsewhere.
        self.until_coloured(page, "[0.12, -0.2, 0.9]", lambda r, g, b: 30 < r < 75)
        self.until_coloured(page, "[0, 40, 22]", lambda r, g, b: g > 1.5 * max(r, b))
        # The floor mirrors the box below it.
        assert page.page.evaluate("app.overlays.stage.mirror") == {
            "height": pytest.approx(0.1),
            "share": pytest.approx(0.5),
        }

    def test_a_floor_that_mirrors_adds_the_light_of_things_and_not_of_the_sky(self, page: Page):
        # Its own light is a grey; with half of the green sky mixed in it would be green.
        self.until_coloured(page, "[-1.5, -0.5, 0.1]", lambda r, g, b: max(r, g, b) - min(r, g, b) < 12 < r)
        # A ray down to the floor and up again meets the red box.
        mirrored = "[0, -0.8, 0.1]"
        self.until_coloured(page, mirrored, lambda r, g, b: r > g + 20 and r > b + 20)

    def test_without_a_plane_that_has_no_end_there_is_neither_haze_nor_grid(self, page: Page):
        assert not page.page.evaluate("app.overlays.stage.hazy")
        assert not page.page.evaluate("app.options.grid")
        # The sky is the same at the horizon as above it.
        self.until_coloured(page, "[30, 100, 2]", lambda r, g, b: g > 2 * max(r, b) and g > 150)
        self.click(page, "grid")
        page.until_kept()
        page.page.reload()
        page.until("window.app?.overlays.stage.facts?.sky >= 0 && app.options.grid")

    def test_a_plane_without_end_has_haze_at_the_horizon(self, browser, tmp_path: Path):
        (tmp_path / "endless.xml").write_text(SCENE.replace('size="4 4 .1"', 'size="0 0 .1"'))
        world = World()
        world.load(tmp_path / "endless.xml")
        viewer = Viewer(world, port=0)
        page = Page(browser, viewer.address)
        page.until("window.app?.overlays.stage.facts?.sky >= 0 && app.scene.groups.length > 0")
        assert page.page.evaluate("app.overlays.stage.hazy")
        page.page.close()
        viewer.close()

    def test_light_that_something_holds_up_is_missing_on_the_floor(self, page: Page):
        lit = page.page.evaluate(self.middle(page, "[-0.8, -0.6, 0.1]"))
        dark = page.page.evaluate(self.middle(page, "[0, -0.05, 0.1]"))

        def is_darker(picture: np.ndarray) -> bool:
            (a, b), (c, d) = lit, dark
            return picture[round(b), round(a)].sum() > picture[round(d), round(c)].sum() + 60

        page.page.evaluate("app.camera.pitch = -35, app.camera.update(), app.changed()")
        lit = page.page.evaluate(self.middle(page, "[-0.8, -0.6, 0.1]"))
        dark = page.page.evaluate(self.middle(page, "[0.1, -0.15, 0.1]"))
        page.wait_for_picture(is_darker)

    def test_cameras_and_frames_are_switches(self, page: Page):
        def lines() -> int:
            return page.page.evaluate("(app.drawScene(), app.overlays.lines.count)")

        before = lines()
        for name, more in (
            ("fileCameras", 2 * 10),
            ("jointFrames", 3),
            ("inertiaFrames", 3 * 3),
            ("siteFrames", 3 * 3),
        ):
            self.click(page, name)
            page.until(f"app.options.{name}")
            assert lines() == before + more, name
            self.click(page, name)
            page.until(f"!app.options.{name}")
        assert page.page.evaluate("app.overlays.stage.facts.cameras.map(({ name }) => name)") == [
            "aside",
            "moving",
        ]
