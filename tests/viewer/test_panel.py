"""The panel in a real browser: bodies, joints, contacts, plots, the camera, keys, small screens."""

import csv
import math
from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()


@pytest.fixture
def arm(page: Page) -> int:
    p.loadURDF(f"{DATA}/plane.urdf")
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    page.until("app.scene.bodies.size === 2")
    return arm


def show(page: Page, *names: str) -> None:
    for name in names:
        page.page.locator(f"input[name={name}]").check()


def until_lines(page: Page, least: float, most: float | None = None) -> None:
    """Waits until as many lines are drawn."""
    page.until(f"{least} <= app.overlays.lines.count && app.overlays.lines.count <= {most or least}")


@pytest.mark.long
def test_the_first_view_shows_the_robot(page: Page, arm: int):
    page.until("app.viewpoint.fitted === '[0,1]' && app.camera.distance < 3")
    wait_for(lambda: p.getDebugVisualizerCamera()[10] < 3, page)
    lower, upper = p.getAABB(arm)
    corners = [(x, y, z) for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (0, 0.9)]
    for corner in corners:
        x, y, _ = page.page.evaluate("point => app.camera.pixel(point)", list(corner))
        assert 0 < x < 900
        assert 0 < y < 640


@pytest.mark.long
def test_the_view_a_script_has_chosen_is_left_alone(page: Page):
    p.resetDebugVisualizerCamera(7, 10, -20, [1, 2, 3])
    p.loadURDF(f"{DATA}/franka_panda/panda.urdf")
    page.until("app.scene.bodies.size === 1 && app.scene.poses.length > 0")
    page.page.wait_for_timeout(300)
    assert page.page.evaluate("app.camera.state()") == {
        "distance": 7,
        "yaw": 10,
        "pitch": -20,
        "target": [1, 2, 3],
    }
    # What is copied is the camera as it is, not as it was drawn last.
    call = page.page.evaluate(
        "(app.camera.set({ distance: 3, yaw: 4, pitch: -5, target: [6, 0, 0] }), app.viewpoint.call)"
    )
    assert call == "p.resetDebugVisualizerCamera(3.00, 4.0, -5.0, [6.00, 0.00, 0.00])"


@pytest.mark.long
def test_a_click_selects_a_body_and_its_joints_are_driven_without_code(page: Page, arm: int):
    p.resetDebugVisualizerCamera(1, 90, 0, [0, 0.6, 0.15])
    page.until("app.camera.distance === 1 && app.scene.groups.length > 5")
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0.1])")
    page.page.mouse.click(x, y)
    page.page.get_by_role("heading", name="panda (body 1)").wait_for()
    assert page.page.locator("#body-card").get_by_text("panda_link0").count() == 1
    p.stepSimulation()
    slider = page.page.locator(f"#joint-{arm}-3")
    slider.evaluate("(element) => { element.value = -1; element.dispatchEvent(new Event('input')); }")

    def driven() -> bool:
        p.stepSimulation()
        return p.getJointState(arm, 3)[0] == pytest.approx(-1, abs=0.02)

    wait_for(driven, page)
    typed = page.page.get_by_title("Value of panda_joint6")
    typed.fill("1.5")
    typed.press("Enter")

    def typed_is_reached() -> bool:
        p.stepSimulation()
        return p.getJointState(arm, 5)[0] == pytest.approx(1.5, abs=0.02)

    wait_for(typed_is_reached, page)
    now = page.page.locator(".slider", has=page.page.locator(f"#joint-{arm}-5")).locator(".now")
    page.until("app.readings.joints.get('1,5').position > 1.4")
    assert "rad/s" in now.text_content()
    # While nothing moves, a joint is put where its slider is.
    page.page.get_by_role("button", name="Pause").click()
    page.page.get_by_role("button", name="Continue").wait_for()
    typed.fill("0.5")
    typed.press("Enter")
    wait_for(lambda: p.getJointState(arm, 5)[0] == 0.5, page)


def test_a_value_of_a_slider_is_typed_and_reset(page: Page):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    typed = page.page.get_by_title("Value of gain")
    typed.fill("3.25")
    typed.press("Enter")
    wait_for(lambda: p.readUserDebugParameter(gain) == 3.25, page)
    page.page.get_by_title("Reset gain").click()
    wait_for(lambda: p.readUserDebugParameter(gain) == 2, page)


@pytest.mark.long
def test_contacts_forces_and_cones_are_drawn(page: Page):
    p.setGravity(0, 0, -10)
    p.loadURDF(f"{DATA}/plane.urdf")
    p.loadURDF(f"{DATA}/cube_small.urdf", [0, 0, 0.026])
    for _ in range(120):
        p.stepSimulation()
    until_lines(page, 0)
    show(page, "contacts")
    page.until("app.readings.contacts.length === 4")
    # Each point is a star of three lines and its normal.
    until_lines(page, 4 * 4)
    page.page.locator("input[name=contacts]").uncheck()
    show(page, "forces")
    page.until("app.overlays.solids.count === 4")
    scale = page.page.evaluate("app.overlays.scales.force")
    total = page.page.evaluate("app.readings.contacts.reduce((sum, c) => sum + c.pressure, 0)")
    weight = p.getDynamicsInfo(1, -1)[0] * 10
    assert total == pytest.approx(weight, rel=0.02)
    assert scale > 0
    # The plane is the first body of each pair; the arrows are those of the cube, which moves.
    starts_and_vectors = "[...app.overlays.solids.used]"
    solids = page.page.evaluate(starts_and_vectors)
    assert all(solids[at + 5] > 0 for at in range(0, len(solids), 13))
    lengths = sum(solids[at + 5] for at in range(0, len(solids), 13))
    assert lengths * scale == pytest.approx(weight, rel=0.02)
    page.page.locator("#legend .force").wait_for()
    bar = page.page.evaluate("document.querySelector('#legend .force i').offsetWidth")
    told = float(page.page.locator("#legend .force").inner_text().split()[0])
    metre = page.page.evaluate("app.camera.height / (2 * app.camera.distance)")
    assert bar == pytest.approx(told / scale * metre, abs=1)
    show(page, "cones")
    page.until("app.overlays.solids.count === 8 && app.overlays.solids.opaque === 4")
    until_lines(page, 4 * 16)


@pytest.mark.long
def test_joints_and_masses_are_drawn(page: Page, arm: int):
    p.setGravity(0, 0, -10)
    p.stepSimulation()
    for name, lines in (("axes", 9 * 6), ("masses", 12 * 3), ("inertias", 12 * 12)):
        show(page, name)
        until_lines(page, 0.5 * lines, 1.2 * lines)
        page.page.locator(f"input[name={name}]").uncheck()
    show(page, "positions")
    page.until("document.querySelectorAll('#labels .reading:not([hidden])').length === 9")
    p.resetJointState(arm, 1, math.radians(30))
    page.page.get_by_text("30.0°").first.wait_for()
    for name, drawn in (("torques", "solids"), ("limits", "lines")):
        show(page, name)
        page.until(f"app.overlays.{drawn}.count > 20")
        page.page.locator(f"input[name={name}]").uncheck()


@pytest.mark.long
def test_forces_are_seen_through_the_bodies_they_are_in(page: Page):
    p.setGravity(0, 0, -10)
    p.loadURDF(f"{DATA}/plane.urdf")
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.5])
    p.createMultiBody(20, box, basePosition=[0, 0, 0.5])
    for _ in range(60):
        p.stepSimulation()
    p.resetDebugVisualizerCamera(2.5, 30, -20, [0, 0, 0.5])
    page.until("app.scene.bodies.size === 2 && app.camera.distance === 2.5")

    def red(picture):
        return ((picture[..., 0] > 130) & (picture[..., 1] < 80) & (picture[..., 2] < 70)).sum()

    p.changeVisualShape(1, -1, rgbaColor=[1, 1, 1, 1])
    page.wait_for_picture(lambda picture: red(picture) == 0)
    show(page, "forces")
    page.wait_for_picture(lambda picture: red(picture) > 300)


@pytest.mark.long
def test_masses_of_removed_bodies_are_forgotten(page: Page, arm: int):
    show(page, "masses")
    page.until(f"app.scene.dynamics.has({arm})")
    p.removeBody(arm)
    page.until(f"!app.scene.dynamics.has({arm})")


@pytest.mark.long
def test_constraints_and_rays_are_drawn(page: Page, arm: int, viewer: Viewer):
    p.createConstraint(arm, 7, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
    show(page, "constraints", "rays")
    page.until("app.overlays.lines.count === 7")
    # Rays are recorded from when the page has asked for them.
    wait_for(lambda: viewer.rays.wanted, page)
    p.rayTestBatch([[0, 0, 2], [3, 3, 2]], [[0, 0, -1], [3, 3, 1]])
    page.until("app.overlays.lines.count === 7 + 3 + 1")


@pytest.mark.long
def test_transparent_bodies_and_collision_shapes_of_each_body_in_a_colour(page: Page, arm: int):
    p.loadURDF(f"{DATA}/table/table.urdf", [1, 0, 0])
    show(page, "transparent")
    page.until("app.scene.groups.some((group) => group.clear)")
    page.page.locator("input[name=transparent]").uncheck()
    show(page, "collisions")
    page.until("[...app.scene.bodies.values()].every((body) => body.shapes.some((shape) => shape.collision))")
    colours = page.page.evaluate(
        "[...app.scene.bodies.values()].map((body) => body.shapes.find((shape) => shape.collision).rgba)"
    )
    assert len({tuple(colour) for colour in colours}) == 3


@pytest.mark.long
def test_everything_is_plotted_zoomed_and_saved(page: Page, arm: int, viewer: Viewer, tmp_path: Path):
    p.setGravity(0, 0, -10)
    p.enableJointForceTorqueSensor(arm, 6)
    cube = p.loadURDF(f"{DATA}/cube_small.urdf", [1, 0, 0.1])
    viewer.plot("error", 0.5)
    select = page.page.locator("#joint")
    # What a script plots is there without being asked for.
    wait_for(lambda: page.page.locator(".chart canvas[title=error]").count() == 1, page)
    for group, label in (
        ("Joints", "panda · panda_joint2"),
        ("Bodies", f"cube.urdf (body {cube})"),
        ("Contact forces", f"cube.urdf (body {cube})"),
        ("Force-torque sensors", "panda · panda_joint7"),
    ):
        key = select.locator(f"optgroup[label='{group}'] option", has_text=label).first.get_attribute("value")
        select.select_option(value=key)
    assert page.page.locator(".chart").count() == 5
    samples = "app.plots.plotted.get('value error').samples.length"
    for part in range(15):
        for _ in range(10):
            p.stepSimulation()
        page.until(f"{samples} > {part}")
    page.until("app.history.frames.at(-1).header.time > 150 / 240 - 1e-6")
    chart = page.page.locator(".chart", has_text="panda_joint2")
    weight = p.getDynamicsInfo(cube, -1)[0] * 10
    newest = f"app.plots.plotted.get('contact {cube}').samples.at(-1).values[0][0]"
    page.until(f"Math.abs({newest} - {weight}) < 0.1 * {weight}")
    fallen = f"app.plots.plotted.get('body {cube}').samples.at(-1).values[0][2]"
    assert page.page.evaluate(fallen) == pytest.approx(0.025, abs=2e-3)
    span = "app.plots.plotted.get('1,1').charts[0].span"
    before = page.page.evaluate(span)
    canvas = chart.locator("canvas").first
    canvas.hover()
    page.page.mouse.wheel(0, -200)
    page.until(f"{span} < {before}")
    canvas.dblclick()
    assert page.page.evaluate(span) == before
    with page.page.expect_download() as download:
        chart.get_by_title("Save these numbers").click()
    download.value.save_as(tmp_path / "plot.csv")
    with open(tmp_path / "plot.csv", newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert header[:3] == ["time [s]", "position", "position target"]
    assert float(rows[-1][0]) == pytest.approx(150 / 240, abs=0.02)


@pytest.mark.long
def test_camera_presets_numbers_and_following(page: Page, arm: int):
    page.page.locator("#camera summary").click()
    page.page.get_by_role("button", name="top").click()
    wait_for(lambda: p.getDebugVisualizerCamera()[9] == pytest.approx(-89.9), page)
    page.page.get_by_role("button", name="front").click()
    wait_for(lambda: p.getDebugVisualizerCamera()[8] == 90, page)
    page.page.get_by_role("button", name="Fit").click()
    page.until_drawn()
    info = p.getDebugVisualizerCamera()
    numbers = page.page.locator("#camera-numbers").text_content()
    distance, yaw, pitch, target = eval(numbers)
    assert (yaw, pitch) == (90, 0)
    wait_for(lambda: p.getDebugVisualizerCamera()[10] == pytest.approx(distance, abs=0.01), page)
    assert len(target) == len(info[11]) == 3
    cube = p.loadURDF(f"{DATA}/cube_small.urdf", [0, 1, 0.5])
    page.page.locator("#bodies summary").click()
    page.page.locator(f"#bodies-list button[data-body='{cube}']").click()
    page.until_drawn()
    page.page.locator("#follow").check()
    assert page.page.evaluate("app.camera.followed !== null")
    before = page.page.evaluate("app.camera.target")
    p.resetBasePositionAndOrientation(cube, [0.5, 1, 0.5], [0, 0, 0, 1])
    page.until(f"Math.abs(app.camera.target[0] - {before[0]} - 0.5) < 1e-4")


@pytest.mark.long
@pytest.mark.parametrize(
    ("key", "option"),
    [
        ("a", "bounds"),
        ("c", "contacts"),
        ("j", "frames"),
        ("k", "constraints"),
        ("l", "limits"),
        ("s", "shadows"),
        ("v", "visuals"),
        ("w", "wireframe"),
    ],
)
def test_keys_show_what_they_show_in_pybullets_window(page: Page, key: str, option: str):
    before = page.page.evaluate(f"app.options.{option}")
    page.page.focus("#view")
    page.page.keyboard.press(key)
    assert page.page.evaluate(f"app.options.{option}") is not before
    page.page.keyboard.press(key)
    assert page.page.evaluate(f"app.options.{option}") is before


def test_key_i_pauses_o_steps_and_g_hides_panel_and_grid(page: Page, viewer: Viewer):
    page.page.focus("#view")
    page.page.keyboard.press("i")
    wait_for(lambda: viewer.pause_control.closed, page)
    page.page.keyboard.press("o")
    wait_for(lambda: viewer.pause_control._steps == 1, page)
    page.page.keyboard.press("i")
    wait_for(lambda: not viewer.pause_control.closed, page)
    page.page.keyboard.press("g")
    assert not page.page.locator("#panel").is_visible()
    assert not page.page.locator("#timeline").is_visible()
    assert not page.page.evaluate("app.options.grid")


@pytest.mark.long
def test_who_pauses_twice_before_an_answer_goes_on(page: Page, viewer: Viewer):
    told: list[bool] = []
    viewer.on_pause = told.append
    page.page.evaluate("() => { app.panel.togglePause(); app.panel.togglePause(); }")
    wait_for(lambda: len(told) == 2, page)
    assert told == [True, False]


def test_escape_in_the_page_ends_the_connection(page: Page):
    page.page.focus("#view")
    page.page.keyboard.press("Escape")
    wait_for(lambda: not p.isConnected(), page)
    page.page.get_by_text("has ended").wait_for()
    page.expect_the_end()


@pytest.mark.long
def test_the_panel_folds_and_a_phone_starts_with_it_folded(viewer: Viewer, browser):
    phone = Page(browser, viewer.address, 390, 700)
    assert not phone.page.locator("#pause").is_visible()
    phone.page.get_by_title("Expand the panel").click()
    assert phone.page.locator("#pause").is_visible()
    box = phone.page.locator("#panel").bounding_box()
    assert box is not None
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    phone.page.get_by_title("Collapse the panel").click()
    assert not phone.page.locator("#pause").is_visible()
    phone.page.get_by_title("More controls").click()
    phone.page.get_by_role("button", name="Picture").wait_for()
    phone.page.close()
