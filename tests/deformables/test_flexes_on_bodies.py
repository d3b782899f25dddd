"""Flexes of `<deformable>`, whose vertices are on bodies, beside what MuJoCo 4.0 makes of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from tests.deformables.cases import FALL, KEPT, RESTING, RIGID, STEPS, node
from tests.each import each

from carom import World
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "answers.json").read_text())
# Greatest distance of a node from where it is in MuJoCo, as a share of the sag.
WITHIN = {
    "cable of springs": 1e-3,
    "cable of constraints": 1e-2,
    "cloth of constraints": 0.02,
    "beam": 0.02,
}


def loaded(world, tmp_path, text):
    (tmp_path / "flex.xml").write_text(text)
    return world.load(tmp_path / "flex.xml")


@pytest.mark.parametrize("name", list(RESTING))
def test_they_come_to_rest_where_those_of_mujoco_do(tmp_path, name):
    answer = {key: np.array(value) for key, value in ANSWERS["rest"][name].items()}
    with World() as world:
        scene = loaded(world, tmp_path, RESTING[name])
        soft = scene["f"]
        assert not scene.ignored
        np.testing.assert_allclose(soft.nodes, answer["start"], atol=1e-9)
        for _ in range(STEPS):
            world.step()
            soft.set_node_velocities(KEPT * soft.node_velocities)
        sag = np.abs(answer["end"] - answer["start"]).max()
        assert sag > 0.002
        assert np.abs(soft.nodes - answer["end"]).max() < WITHIN[name] * sag


@pytest.mark.parametrize("name", list(RIGID))
def test_a_flex_on_one_body_is_its_shape(tmp_path, name):
    x, y, z, w, i, j, k = ANSWERS["fall"][name]
    with World() as world:
        scene = loaded(world, tmp_path, RIGID[name])
        assert not scene.ignored
        assert scene["p"].mass == 1.0
        world.step(FALL)
        position, orientation = scene["p"].pose
        # It lies on all its lower edges, and has hardly moved along the plane.
        assert abs(position[2] - z) < 2e-4
        np.testing.assert_allclose(position[:2], (x, y), atol=5e-3)
        np.testing.assert_allclose(orientation, (i, j, k, w), atol=5e-3)
        assert len(world.bodies) == 2


ONE = '<flex name="f" dim="{}" body="{}" element="{}"{}</flex>'


def model(flex, bodies="", rest=""):
    nodes = "".join(node(f"n{k}", f"{k} 0 1", 0.5) for k in range(3))
    return f"<mujoco><worldbody>{nodes}{bodies}</worldbody><deformable>{flex}</deformable>{rest}</mujoco>"


LINE = ONE.format(1, "n0 n1 n2", "0 1 1 2", "><contact selfcollide='none'/>")


def test_nodes_are_no_bodies_and_have_their_masses(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, model(LINE, node("m", "0 5 0", 2.0)))
        assert sorted(body.name for body in scene.bodies) == ["f", "m"]
        np.testing.assert_array_equal(scene["f"].soft_spec.masses, [0.5, 0.5, 0.5])
        assert not scene.ignored


def test_keyframes_count_the_sliders_of_nodes(tmp_path):
    key = '<keyframe><key name="k" qpos="' + "0 " * 9 + '.25"/></keyframe>'
    hinge = '<body name="h"><joint name="j"/><geom size=".1"/></body>'
    with World() as world:
        scene = loaded(world, tmp_path, model(LINE, hinge, key))
        scene.reset("k")
        assert scene["h"].joints["j"].position == 0.25


def test_a_body_that_moves_holds_vertices(tmp_path):
    cart = '<body name="cart" pos="3 0 1"><joint type="slide" axis="1 0 0"/><geom size=".1" mass="9"/></body>'
    flex = ONE.format(1, "n0 n1 n2 cart", "0 1 1 2 2 3", "><edge stiffness='50'/></flex>").replace(
        "</flex></flex>", "</flex>"
    )
    with World() as world:
        scene = loaded(world, tmp_path, model(flex, cart))
        scene["cart"].joints[0].velocity = 1.0
        world.step(100)
        pose = scene["cart"].links["cart"].pose
        np.testing.assert_allclose(scene["f"].nodes[3], pose.position, atol=1e-6)
        assert scene["f"].nodes[2][0] > 2.0


@each(
    ("text", "consequence"),
    [
        (model(ONE.format(1, "n0 n1", "0 1", " dof='trilinear'>")), "it is missing"),
        (model(LINE + LINE.replace('"f"', '"g"')), "it is missing"),
        (model(LINE, rest="<actuator><motor joint='x'/></actuator>").replace(
            '<joint type="slide" axis="1 0 0"/>', '<joint name="x" type="slide" axis="1 0 0"/>', 1
        ), None),
        (model(LINE).replace('axis="0 0 1"/>', 'axis="0 0 1" damping="1"/>', 1), "the node moves freely"),
        (
            model(LINE, rest="<equality><flex flex='f' active='false'/></equality>"),
            "this constraint does not hold",
        ),
        (model(LINE.replace("'none'/>", "'none' solref='.1 1'/>")), "its contacts do not yield"),
    ],
)  # fmt: skip
def test_what_soft_bodies_cannot_do_is_reported(tmp_path, text, consequence):
    with World() as world:
        scene = loaded(world, tmp_path, text)
        if consequence is None:
            # A body whose joint is driven stays a body, which holds its vertex.
            assert "n0" in [body.name for body in scene.bodies]
            assert [anchor.node for anchor in scene["f"].anchors] == [0]
        else:
            assert consequence in [it.consequence for it in scene.ignored]


@each(
    ("text", "says"),
    [
        (model(ONE.format(1, "n0 n9", "0 1", ">")), "there is no body 'n9'"),
        (model(ONE.format(1, "n0 n1", "0 2", ">")), "a vertex that is not there; there are 2"),
        (model(ONE.format(1, "n0 n1", "0 0", ">")), "an element names a vertex twice"),
        (model(ONE.format(2, "n0 n1", "0 1", ">")), "element needs 3 numbers"),
        (model(ONE.format(1, "n0 n1", "0 1", " vertex='0 0 0'>")), "body one name, or one for each vertex"),
        (model(ONE.format(4, "n0 n1", "0 1", ">")), "dim=4"),
        (model(ONE.format(1, "n0 n1", "0 1", " radius='-1'>")), "radius=-1"),
        (model(LINE, rest="<equality><flex flex='g'/></equality>"), "there is no flex 'g'"),
    ],
)
def test_broken_ones_are_errors_that_say_what_is_wrong(tmp_path, text, says):
    with World() as world:
        with pytest.raises(DescriptionError, match=says):
            loaded(world, tmp_path, text)
        assert len(world.bodies) == 0
