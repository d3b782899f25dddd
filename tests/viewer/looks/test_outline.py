"""The outline of the selected body, and the axes in the corner."""

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()


def orange(picture: NDArray[np.int16]) -> NDArray[np.bool_]:
    red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
    return (red > 220) & (green > 110) & (green < 180) & (blue < 80)


@pytest.fixture
def balls(page: Page) -> tuple[int, int]:
    """A ball, and a wall in front of its lower half."""
    grey = [0.5, 0.5, 0.5, 1]
    ball = p.createMultiBody(1, -1, p.createVisualShape(p.GEOM_SPHERE, radius=0.2, rgbaColor=grey))
    box = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.4, 0.02, 0.2], rgbaColor=grey)
    wall = p.createMultiBody(0, -1, box, [0, -0.5, -0.2])
    p.resetDebugVisualizerCamera(2, 0, 0, [0, 0, 0])
    page.until("app.camera.distance === 2 && app.scene.groups.length === 2")
    return ball, wall


def ring(page: Page, picture: NDArray[np.int16], radius: float) -> list[float]:
    """Share of orange pixels along the silhouette of the ball, above and below its middle."""
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0])")
    found = orange(picture)
    shares = []
    for angles in (np.linspace(0.2, 2.9, 60), np.linspace(3.4, 6.0, 60)):
        seen = []
        for angle in angles:
            # The outline is a few pixels wide.
            places = [
                (y - r * np.sin(angle), x + r * np.cos(angle)) for r in np.arange(radius - 2, radius + 6)
            ]
            seen.append(any(found[round(row), round(column)] for row, column in places))
        shares.append(float(np.mean(seen)))
    return shares


def test_the_selected_body_has_an_outline_that_is_seen_through_others(page: Page, balls: tuple[int, int]):
    assert not orange(page.picture()).any()
    page.page.evaluate(f"app.bodies.select({balls[0]})")
    # Half the height of the view is 2 m at the ball; from so near a bit more than its radius is seen.
    pixels = 0.2 / 2 / np.sqrt(1 - 0.1**2) * page.page.evaluate("app.camera.height") / 2
    # Above and below; at first pictures may be coarse.
    picture = page.wait_for_picture(lambda picture: min(ring(page, picture, pixels)) > 0.9)
    # A line, not a filled disc.
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0])")
    assert not orange(picture)[int(y) - 10 : int(y) + 10, int(x) - 10 : int(x) + 10].any()
    page.page.evaluate(f"app.bodies.select({balls[1]})")
    page.wait_for_picture(lambda picture: orange(picture).any() and max(ring(page, picture, pixels)) < 0.7)
    page.page.evaluate("app.bodies.select(null)")
    page.wait_for_picture(lambda picture: not orange(picture).any())


def test_the_outline_moves_with_the_body_and_a_hidden_one_has_none(page: Page, balls: tuple[int, int]):
    page.page.evaluate(f"app.bodies.select({balls[0]})")
    before = page.wait_for_picture(lambda picture: orange(picture).sum() > 100)
    p.resetBasePositionAndOrientation(balls[0], [-0.6, 0, 0.3], [0, 0, 0, 1])

    def middle(picture: NDArray[np.int16]) -> NDArray[np.float64]:
        return np.argwhere(orange(picture)).mean(axis=0)

    def moved(picture: NDArray[np.int16]) -> bool:
        rows, columns = middle(picture) - middle(before)
        return rows < -30 and columns < -60

    page.wait_for_picture(lambda picture: orange(picture).any() and moved(picture))
    page.page.evaluate(f"app.scene.setHidden({balls[0]}, true); app.changed()")
    page.wait_for_picture(lambda picture: not orange(picture).any())


def test_a_robot_has_one_outline_around_all_its_links(page: Page):
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    page.until("app.scene.bodies.size === 1 && app.scene.groups.length > 5")
    page.page.evaluate(f"app.bodies.select({arm})")
    page.wait_for_picture(lambda picture: orange(picture).sum() > 200)
    assert page.page.evaluate("app.renderer.outline.groups.length") > 5


def test_axes_in_the_corner_turn_with_the_view_and_a_click_looks_along_them(page: Page):
    p.resetDebugVisualizerCamera(2, 0, 0, [0, 0, 0])
    page.until("app.camera.distance === 2")
    tip = "name => { const end = document.querySelector(`#gizmo .${name}.plus line`);"
    tip += " return [Number(end.getAttribute('x2')), Number(end.getAttribute('y2'))]; }"
    wait_for(lambda: page.page.evaluate(tip, "x")[0] > 20, page)
    assert page.page.evaluate(tip, "z") == pytest.approx([0, -27])
    p.resetDebugVisualizerCamera(2, 90, 0, [0, 0, 0])
    wait_for(lambda: page.page.evaluate(tip, "y")[0] > 20, page)
    for name, sign, axis in (("x", "plus", 0), ("y", "minus", 1), ("z", "plus", 2)):
        page.page.evaluate(
            "() => { app.camera.yaw = 35; app.camera.pitch = -30; app.camera.update(); app.changed(); }"
        )
        page.until_drawn()
        page.page.locator(f"#gizmo .{name}.{sign} circle").click()
        eye = page.page.evaluate("app.camera.eye")
        assert eye[axis] == pytest.approx(2 if sign == "plus" else -2, abs=0.01)
    p.configureDebugVisualizer(p.COV_ENABLE_GUI, 0)
    page.page.locator("#gizmo").wait_for(state="hidden")


def test_axes_look_along_y_where_it_is_upwards(page: Page):
    p.configureDebugVisualizer(p.COV_ENABLE_Y_AXIS_UP, 1)
    p.resetDebugVisualizerCamera(2, 35, -30, [0, 0, 0])
    page.until("app.camera.distance === 2 && app.camera.yUp")
    for axis, name in enumerate("xyz"):
        page.page.evaluate(
            "() => { app.camera.yaw = 35; app.camera.pitch = -30; app.camera.update(); app.changed(); }"
        )
        page.until_drawn()
        page.page.locator(f"#gizmo .{name}.plus circle").click()
        assert page.page.evaluate("app.camera.eye")[axis] == pytest.approx(2, abs=0.01)
