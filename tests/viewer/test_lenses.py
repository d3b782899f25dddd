"""The page looks through the script's cameras."""

from collections.abc import Callable, Sequence
from typing import cast

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
from carom import Camera, World
from carom.viewer.viewer import Viewer

pytestmark = needs_browser

# The page of these tests [pixels]; the image of a camera is fitted into it.
WIDTH, HEIGHT = 900, 640
IMAGE = (320, 160)
POINT = (0.35, 0.4, 0.55)


def red_ball(position: tuple[float, float, float], radius: float = 0.06) -> int:
    shape = p.createVisualShape(p.GEOM_SPHERE, radius=radius, rgbaColor=[1, 0, 0, 1], specularColor=[0, 0, 0])
    return p.createMultiBody(0, -1, shape, position)


def show_balls_only(page: Page) -> None:
    """Hides what else is red: the balls in the previews, and an axis of the grid."""
    page.page.evaluate(
        "document.getElementById('previews').style.opacity = 0, app.options.grid = false, app.changed()"
    )


def red(picture: np.ndarray) -> np.ndarray:
    colours = picture.astype(int)
    return (colours[..., 0] > 90) & (colours[..., 0] > 2 * np.maximum(colours[..., 1], colours[..., 2]))


def middle(picture: np.ndarray) -> np.ndarray:
    """Column and row of the middle of what is red."""
    rows, columns = np.nonzero(red(picture))
    return np.array([columns.mean(), rows.mean()])


def on_page(pixel: np.ndarray, image: tuple[int, int]) -> np.ndarray:
    """Where the page shows a pixel of an image that is fitted into its middle."""
    scale = min(WIDTH / image[0], HEIGHT / image[1])
    return (pixel + 0.5 - np.array(image) / 2) * scale + np.array([WIDTH, HEIGHT]) / 2


def near(aim: np.ndarray) -> Callable[[np.ndarray], bool]:
    return lambda picture: bool(red(picture).sum() > 40 and np.abs(middle(picture) - aim).max() < 2.5)


def taken(view: Sequence[float], projection: Sequence[float]) -> np.ndarray:
    """Middle of the red ball in an image of the script."""
    width, height, colours, *_ = p.getCameraImage(*IMAGE, view, projection, shadow=0)
    return middle(np.reshape(colours, (height, width, 4))[..., :3])


def off_centre() -> Sequence[float]:
    """A lens whose axis does not meet the middle of the image."""
    return p.computeProjectionMatrix(-0.09, 0.15, -0.03, 0.09, 0.1, 5)


@pytest.mark.long
@pytest.mark.parametrize("lens", [off_centre(), p.computeProjectionMatrixFOV(50, 2, 0.1, 5)])
def test_a_point_lies_where_the_image_of_the_script_has_it(page: Page, lens: Sequence[float]):
    show_balls_only(page)
    ball = red_ball(POINT)
    view = p.computeViewMatrix([1.6, -0.9, 1.2], [0, 0.2, 0.4], [0.1, 0, 1])
    aim = on_page(taken(view, lens), IMAGE)
    # The script's view stays, where the first one would be fitted to the ball.
    p.resetDebugVisualizerCamera(2, 40, -30, [0, 0, 0.5])
    page.until("Math.abs(app.camera.distance - 2) < 1e-6 && !app.viewpoint.undecided")
    before = page.page.evaluate("[...app.camera.matrix]")
    page.page.locator("#camera summary").click()
    page.page.get_by_role("button", name="camera 1").click()
    picture = page.wait_for_picture(near(aim))
    # Above and below the image is nothing of the scene.
    assert (picture[60] == picture[60, 0]).all()
    assert page.page.evaluate(f"app.camera.pixel({list(POINT)})")[:2] == pytest.approx(aim, abs=3)
    # The ray through that pixel meets the ball.
    found = page.page.evaluate("([x, y]) => (app.pointer.hovered = [x, y], app.underMouse())", aim.tolist())
    assert found["body"] == ball
    # The view goes along with the camera.
    view = p.computeViewMatrix([1.2, -1.2, 0.7], [0.2, 0.2, 0.5], [0, 0, 1])
    page.wait_for_picture(near(on_page(taken(view, lens), IMAGE)))
    # Another click shows what the user had.
    page.page.get_by_role("button", name="camera 1").click()
    page.until(f"app.camera.matrix.every((x, i) => Math.abs(x - {before}[i]) < 1e-6)")
    page.until("document.getElementById('letterbox').hidden")


@pytest.mark.long
def test_far_things_are_cut_off_as_in_the_image(page: Page):
    show_balls_only(page)
    red_ball((0, 0, 0.5), 0.2)
    view = p.computeViewMatrix([2, 0, 0.5], [0, 0, 0.5], [0, 0, 1])
    for number, (far, seen) in enumerate(((1.5, False), (5, True)), 1):
        projection = p.computeProjectionMatrixFOV(40, 2, 0.1, far)
        colours = np.reshape(p.getCameraImage(*IMAGE, view, projection, shadow=0)[2], (160, 320, 4))
        assert red(colours).any() == seen
        page.until(f"app.lenses.newest === {number}")
        page.page.evaluate("app.lenses.looking || app.lenses.toggle(app.lenses.newest)")
        page.page.evaluate("app.lenses.chosen === app.lenses.newest || app.lenses.toggle(app.lenses.newest)")
        page.wait_for_picture(lambda picture, seen=seen: bool(red(picture).sum() > 500) == seen)


@pytest.mark.long
def test_escape_and_drags_go_back_to_the_own_view(page: Page):
    red_ball(POINT)
    taken(p.computeViewMatrix([1.6, 0, 1.2], [0, 0, 0.4], [0, 0, 1]), off_centre())
    page.page.locator("#previews figure").first.click()
    page.until("app.lenses.looking")
    page.page.focus("#view")
    page.page.keyboard.press("Escape")
    page.until("!app.lenses.looking")
    # The script goes on, and does not get the key.
    assert p.isConnected()
    assert 27 not in p.getKeyboardEvents()
    distance = page.page.evaluate("app.camera.distance")
    page.page.locator("#previews figure").first.click()
    page.until("app.lenses.looking")
    page.page.mouse.move(300, 60)
    page.page.mouse.wheel(0, 100)
    page.until("!app.lenses.looking")
    assert page.page.evaluate("app.camera.distance") == pytest.approx(distance * np.exp(0.1))


@pytest.mark.long
def test_a_mounted_camera_is_followed(page: Page, viewer: Viewer):
    show_balls_only(page)
    arm = red_ball((0, 0, 0))
    red_ball(POINT)
    # The window of a connection shows a world that knows all of `World`.
    world = cast("World", viewer._world)
    body = world.bodies[arm]
    camera = Camera(300, 300, fx=250, cx=120, link=body.links.base).look_at((0, 0, 0.4), (1, 1, 0.5))
    viewer.show_camera("on the hand", camera)
    page.page.locator("#camera summary").click()
    page.page.get_by_role("button", name="on the hand").click()
    image = camera.capture(world)
    page.wait_for_picture(near(on_page(middle(image.colour), (300, 300))))
    p.resetBasePositionAndOrientation(arm, [0.1, -0.1, 0.05], [0, 0, 0, 1])
    image = camera.capture(world)
    page.wait_for_picture(near(on_page(middle(image.colour), (300, 300))))
    wait_for(lambda: page.page.evaluate("app.lenses.looking"), page)
