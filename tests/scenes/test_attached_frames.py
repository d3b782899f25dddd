"""Frames and bodies that a model attaches, from another model or from itself; as MuJoCo 4.0 has them."""

import numpy as np
import pytest
from tests.each import each

from carom import World
from carom.errors import DescriptionError

FRAME = """<frame name="out" pos="5 0 0"><frame name="fr" pos="0 0 1" euler="0 0 90">
<body name="b" pos=".1 0 0"><joint name="j" axis="0 1 0"/><geom size=".1" mass="1"/></body></frame></frame>"""
HOLDER = '<body name="c" pos="0 2 0"><geom size=".1"/><attach {} frame="fr" prefix="q_"/></body>'
ACTING = '<actuator><motor name="m" joint="j"/></actuator><sensor><jointpos name="s" joint="j"/></sensor>'


def loaded(world, tmp_path, text):
    (tmp_path / "m.xml").write_text(text)
    return world.load(tmp_path / "m.xml")


def position(scene, name):
    return next(link.pose.position for body in scene.bodies for link in body.links if link.name == name)


def test_a_frame_of_another_model_keeps_its_own_pose(tmp_path):
    (tmp_path / "o.xml").write_text(f'<mujoco model="o"><worldbody>{FRAME}</worldbody></mujoco>')
    text = '<mujoco><asset><model name="o" file="o.xml"/></asset><worldbody>{}</worldbody></mujoco>'
    with World() as world:
        scene = loaded(world, tmp_path, text.format(HOLDER.format('model="o"')))
        np.testing.assert_allclose(position(scene, "q_b"), [0.0, 2.1, 1.0], atol=1e-12)


def test_a_model_attaches_frames_and_bodies_of_itself_with_all_that_names_them(tmp_path):
    body = '<frame pos="1 0 0"><attach body="b" prefix="p_"/></frame>'
    text = f"<mujoco><worldbody>{FRAME}{body}{HOLDER.format('')}</worldbody>{ACTING}</mujoco>"
    with World() as world:
        scene = loaded(world, tmp_path, text)
        np.testing.assert_allclose(position(scene, "b"), [5.0, 0.1, 1.0], atol=1e-12)
        np.testing.assert_allclose(position(scene, "p_b"), [1.1, 0.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(position(scene, "q_b"), [0.0, 2.1, 1.0], atol=1e-12)
        assert list(scene.actuators) == ["m", "p_m", "q_m"]
        assert set(scene.sensors) == {"s", "p_s", "q_s"}


@each(
    ("content", "says"),
    [
        ('<body name="b"><body name="k"><attach body="b" prefix="p_"/></body></body>', "attached in itself"),
        ('<body name="b"/><attach prefix="p_"/>', "needs a model, or a body or frame"),
        ('<body name="b"/><attach body="none" prefix="p_"/>', "none"),
    ],
)
def test_what_cannot_be_attached_is_an_error(tmp_path, content, says):
    with World() as world, pytest.raises(DescriptionError, match=says):
        loaded(world, tmp_path, f"<mujoco><worldbody>{content}</worldbody></mujoco>")
