"""The first view keeps arms in view, and what has no shape is seen and chosen as well."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = [needs_browser, pytest.mark.long]
DATA = pybullet_data.getDataPath()
FOLDED = (0, 1.7, 0, 1.9, 0, 1.2, 0)


@pytest.fixture
def arm(viewer: Viewer) -> int:
    """A KUKA that lies near the floor, and has done so for a second."""
    p.loadURDF(f"{DATA}/plane.urdf")
    arm = p.loadURDF(f"{DATA}/kuka_iiwa/model.urdf", useFixedBase=True)
    place(arm, FOLDED)
    for _ in range(250):
        p.stepSimulation()
    return arm


@pytest.fixture
def seen(viewer: Viewer, arm: int, browser) -> Iterator[Page]:
    """Its first view, which no longer depends on what is added."""
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.viewpoint.settled && app.viewpoint.fitted")
    yield page
    page.page.close()
    assert page.complaints == []


def place(arm: int, angles: tuple[float, ...]) -> None:
    """Puts the joints of an arm somewhere, where they are held."""
    for joint, angle in enumerate(angles):
        p.resetJointState(arm, joint, angle)
        p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, angle)


def distance(page: Page) -> float:
    return page.page.evaluate("app.camera.distance")


def until_shown(page: Page, arm: int) -> None:
    """Waits until the page shows the last link of the arm where it is."""
    height = p.getLinkState(arm, 6)[4][2]
    page.until(f"Math.abs(app.scene.linkPose(1, 7).position[2] - {height}) < 1e-3")


def test_the_first_view_gets_wider_when_an_arm_is_lifted_out_of_it(seen: Page, arm: int, viewer: Viewer):
    before = distance(seen)
    place(arm, (0,) * 7)
    p.stepSimulation()
    until_shown(seen, arm)
    assert distance(seen) > 1.1 * before
    x, y, _ = seen.page.evaluate("app.camera.pixel(app.scene.linkPose(1, 7).position)")
    assert 0 < x < 900
    assert 0 < y < 640
    # The script is told; nobody has chosen this view.
    wait_for(lambda: p.getDebugVisualizerCamera()[10] > 1.1 * before, seen)
    assert not viewer.camera.chosen
    # It stays when the arm comes back.
    wide = distance(seen)
    place(arm, FOLDED)
    p.stepSimulation()
    until_shown(seen, arm)
    assert distance(seen) == wide


def test_a_view_that_the_user_has_chosen_stays_when_an_arm_leaves_it(seen: Page, arm: int):
    seen.page.locator("#camera summary").click()
    seen.page.get_by_role("button", name="front").click()
    before = distance(seen)
    place(arm, (0,) * 7)
    p.stepSimulation()
    until_shown(seen, arm)
    assert distance(seen) == before


def test_what_flies_away_does_not_take_the_first_view_along(seen: Page, arm: int):
    box = p.loadURDF(f"{DATA}/cube_small.urdf", [0.5, 0.5, 0.1])
    seen.until("app.scene.bodies.size === 3 && app.scene.inertialPose(2, 0)")
    before = distance(seen)
    p.resetBasePositionAndOrientation(box, [0, 0, 30], [0, 0, 0, 1])
    p.stepSimulation()
    seen.until("app.scene.inertialPose(2, 0).position[2] > 20")
    assert distance(seen) == before


BARE = """<robot name="bare">
  <link name="base"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="5"/>
  </joint>
</robot>"""


def test_a_body_without_shapes_is_seen_and_chosen_by_a_click(viewer: Viewer, browser, tmp_path: Path):
    (tmp_path / "bare.urdf").write_text(BARE)
    p.loadURDF(f"{DATA}/plane.urdf")
    bare = p.loadURDF(str(tmp_path / "bare.urdf"), [0.2, 0.1, 0], useFixedBase=True)
    page = Page(browser, viewer.address, 900, 640)
    # Both links are in the first view, and drawn as crosses, with a line between them.
    page.until("window.app?.viewpoint.fitted && app.overlays.lines.count === 3 + 3 + 1")
    for link in (0, 1):
        x, y, _ = page.page.evaluate(f"app.camera.pixel(app.scene.linkPose({bare}, {link}).position)")
        assert 0 < x < 900
        assert 0 < y < 640
        page.page.mouse.click(x + 5, y - 5)
        assert page.page.evaluate("[app.bodies.selected, app.bodies.link]") == [bare, link]
    page.page.mouse.click(x + 30, y - 30)
    assert page.page.evaluate("app.bodies.selected") != bare
    # One that is hidden is neither seen nor chosen.
    page.page.get_by_title(f"Show bare (body {bare})").uncheck()
    page.until("app.overlays.lines.count < 7")
    page.page.mouse.click(x + 5, y - 5)
    assert page.page.evaluate("app.bodies.selected") != bare
    page.page.close()
    assert page.complaints == []
