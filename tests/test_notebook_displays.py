"""What notebooks show of worlds, bodies, joints, cameras and images: tables and pictures."""

import re
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from carom import Camera, World
from carom.scene.body import Body


@pytest.fixture
def arm() -> Body:
    return World().load_urdf("kuka_iiwa/model.urdf", fixed_base=True)


def cells(html: str) -> list[str]:
    return re.findall(r"<td[^>]*>(.*?)</td>", html)


def test_a_world_lists_its_bodies(arm: Body):
    html = arm.world._repr_html_()
    assert "World: 1 body, 0.0000 s, gravity (" in html
    assert {arm.name, str(arm.joint_count)} <= set(cells(html))


def test_a_body_lists_its_joints_and_links(arm: Body):
    html = arm._repr_html_()
    assert "fixed base" in html
    assert {joint.name for joint in arm.joints} | {link.name for link in arm.links} <= set(cells(html))


def test_joints_show_their_present_state(arm: Body):
    arm.joints[3].reset(0.5, velocity=-0.25)
    shown = cells(arm.joints._repr_html_())
    row = shown[shown.index(arm.joints[3].name) :]
    assert "0.5" in row[2]
    assert "-0.25" in row[3]


def test_joints_that_cannot_move_have_no_state():
    body = World().load_urdf("TwoJointRobot_w_fixedJoints.urdf", fixed_base=True)
    shown = cells(body.joints._repr_html_())
    rows = {shown[at + 1]: shown[at + 2 : at + 7] for at in range(0, len(shown), 7)}
    fixed = [rows[joint.name] for joint in body.joints if joint.degrees_of_freedom == 0]
    assert fixed
    assert all(row == ["fixed", "", "", "", ""] for row in fixed)


def test_names_cannot_bring_markup_of_their_own(monkeypatch: pytest.MonkeyPatch):
    world = World()
    # Other worlds share the description.
    monkeypatch.setattr(world.load_urdf("cube_small.urdf").spec, "name", "<script>")
    assert "<script>" not in world._repr_html_()


def test_a_camera_says_where_it_is_and_an_image_is_a_picture(arm: Body):
    camera = Camera.with_field_of_view(64, 48, 60).look_at((2, 0, 1), (0, 0, 0.5))
    assert "64 x 48" in camera._repr_html_()
    image = camera.capture(arm.world)
    with Image.open(BytesIO(image._repr_png_())) as picture:
        assert np.array_equal(np.asarray(picture), image.colour)
