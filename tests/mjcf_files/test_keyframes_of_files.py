"""Keyframes of files, and of the models that they attach, are those of MuJoCo.

The answers are those of `mujoco` 4.0: `key_qpos`, `key_qvel`, `key_ctrl` and `key_act` of each key, by the
names of joints and actuators. Keys without a name have a number here.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import carom
from carom import World
from carom.errors import DescriptionError

CHILD = """<mujoco model="c"><worldbody>
<body name="x" pos="0 0 9"><joint name="jx" type="slide"/><geom size=".1"/></body>
<body name="b" pos="0 0 1"><joint name="j1" type="slide" axis="1 0 0"/>
<joint name="j2" ref="0.5" type="slide" axis="0 1 0"/><geom size=".1"/></body></worldbody>
<actuator><position name="px" joint="jx" kp="1"/><motor name="m1" joint="j1"/>
<position name="m2" joint="j2" kp="3" timeconst="1"/></actuator>
<keyframe><key name="k" time="3" qpos="1 2 3" qvel="4 5 6" ctrl="7 8 9" act="10"/><key qpos="-1 -2 -3"/>
<key name="few" qpos="5"/><key name="ctrl" ctrl="1 1 1"/></keyframe></mujoco>"""
OWN = '<body name="own"><joint name="own" type="slide"/><geom size=".1"/></body>'
MINE = '<keyframe><key name="mine" qpos="9"/></keyframe>'
FREE = """<mujoco model="c"><worldbody><body name="b" pos="0 0 1"><freejoint/><geom size=".1"/><body name="h">
<joint/><geom size=".1"/></body></body></worldbody><keyframe><key name="few" qpos="7 7"/><key name="none"/>
<key name="all" qpos="1 2 3 2 0 0 0 .5" qvel="1 2 3 4 5 6 7"/></keyframe></mujoco>"""


def attach(prefix, body="b"):
    of = f'body="{body}"' if body else ""
    return f'<attach model="c" {of} prefix="{prefix}"/>'


def write(folder, body, child=CHILD, keyframe=""):
    (folder / "child.xml").write_text(child)
    (folder / "whole.xml").write_text(
        '<mujoco><asset><model name="c" file="child.xml"/></asset>'
        f"<worldbody>{body}</worldbody>{keyframe}</mujoco>"
    )
    return folder / "whole.xml"


def states(scene):
    """Of each keyframe: positions and velocities of joints, controls and activations of actuators."""
    found = {}
    for name in scene.keyframes:
        scene.reset(name)
        joints = [joint for body in scene.bodies for joint in body.joints.movable]
        found[name] = (
            {joint.name: float(joint.position) for joint in joints},
            {joint.name: float(joint.velocity) for joint in joints if joint.velocity},
            {it.name: it.control for it in scene.actuators.values() if it.control},
            {it.name: it.activation for it in scene.actuators.values() if it.spec.dynamics and it.activation},
        )
    return found


P = {"p-j1": 0.0, "p-j2": 0.5}
OF_P = {
    "p-k": (
        {"p-j1": 2.0, "p-j2": 3.0},
        {"p-j1": 5.0, "p-j2": 6.0},
        {"p-m1": 8.0, "p-m2": 9.0},
        {"p-m2": 10.0},
    ),
    "p-1": ({"p-j1": -2.0, "p-j2": -3.0}, {}, {}, {}),
    "p-few": (P, {}, {}, {}),
    "p-ctrl": (P, {}, {"p-m1": 1.0, "p-m2": 1.0}, {}),
}
WHOLE = {
    "p-k": (
        {"p-jx": 1.0, "p-j1": 2.0, "p-j2": 3.0},
        {"p-jx": 4.0, "p-j1": 5.0, "p-j2": 6.0},
        {"p-px": 7.0, "p-m1": 8.0, "p-m2": 9.0},
        {"p-m2": 10.0},
    ),
    "p-1": ({"p-jx": -1.0, "p-j1": -2.0, "p-j2": -3.0}, {}, {}, {}),
    "p-few": ({"p-jx": 5.0, **P}, {}, {}, {}),
    "p-ctrl": ({"p-jx": 0.0, **P}, {}, {"p-px": 1.0, "p-m1": 1.0, "p-m2": 1.0}, {}),
}


def renamed(found, change, rest):
    """Keys whose joints and actuators have other names, beside `rest` at the reference."""
    return {
        key: ({**{change(name): at for name, at in parts[0].items()}, **rest}, *(
            {change(name): at for name, at in part.items()} for part in parts[1:]
        ))
        for key, parts in found.items()
    }  # fmt: skip


def of_q(found):
    return {key.replace("p-", "q-"): parts for key, parts in found.items()}


CASES = {
    "a body": (attach("p-"), "", OF_P),
    "all of it": (attach("p-", ""), "", WHOLE),
    "beside others": (
        OWN + attach("p-"), MINE,
        {"mine": ({"own": 9.0, **P}, {}, {}, {}), **renamed(OF_P, str, {"own": 0.0})},
    ),
    "twice": (
        attach("p-") + OWN + attach("q-"), "",
        {
            **renamed(OF_P, str, {"own": 0.0, "q-j1": 0.0, "q-j2": 0.5}),
            **of_q(renamed(OF_P, lambda name: name.replace("p-", "q-"), {"own": 0.0, **P})),
        },
    ),
    "copies": (
        f'<replicate count="3" sep="_" offset="1 0 0">{attach("p-")}</replicate>{OWN}', "",
        renamed(
            OF_P, lambda name: f"{name}_0",
            {"own": 0.0, "p-j1_1": 0.0, "p-j2_1": 0.5, "p-j1_2": 0.0, "p-j2_2": 0.5},
        ),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_keyframes_come_with_attached_models(tmp_path, name):
    body, keyframe, expected = CASES[name]
    with World() as world:
        found = states(world.load(write(tmp_path, body, keyframe=keyframe)))
        assert found == expected
        assert list(found) == list(expected)
    with World() as world:
        found = states(world.load(carom.read(tmp_path / "whole.xml")))
        assert found == expected
        assert list(found) == list(expected)


def test_a_key_without_positions_has_those_of_the_reference(tmp_path):
    (tmp_path / "child.xml").write_text(CHILD)
    with World() as world:
        found = states(world.load(tmp_path / "child.xml"))
        # After "few", at which jx is elsewhere.
        assert found["ctrl"][0] == {"jx": 0.0, "j1": 0.0, "j2": 0.5}


def test_free_bodies_are_where_the_keys_of_attached_models_put_them(tmp_path):
    body = f'<frame pos="5 0 0" euler="0 0 90">{attach("p-")}</frame>'
    with World() as world:
        scene = world.load(write(tmp_path, body, child=FREE))
        (free,) = [it for it in scene.bodies if not it.fixed_base]
        half = np.sqrt(0.5)
        for name, position, orientation, joint in (
            ("p-few", (7, 7, 1), (0, 0, 0, 1), 0.0),
            ("p-all", (1, 2, 3), (0, 0, 0, 1), 0.5),
            ("p-none", (5, 0, 1), (0, 0, half, half), 0.0),
        ):
            scene.reset(name)
            assert_allclose(free.pose.position, position, atol=1e-15)
            assert_allclose(free.pose.orientation, orientation, atol=1e-15)
            # It has no name: it is found as the first joint of a body that has one.
            assert_allclose(free.joints.positions, [joint])
        scene.reset("p-all")
        assert_allclose(free.joints.velocities, [7.0])
        assert_allclose(free.links[-1].velocity.linear, [1, 2, 3], atol=1e-12)


def test_joints_without_names_in_bodies_without_names_are_reported(tmp_path):
    child = FREE.replace('<body name="h">', "<body>")
    with World() as world:
        scene = world.load(write(tmp_path, attach("p-"), child=child))
        rows = [row for row in scene.ignored if "without names" in row.consequence]
        assert [row.element for row in rows] == ["mujoco/keyframe"]
        assert not [row for row in world.load(tmp_path / "child.xml").ignored if "names" in row.consequence]
    assert rows == [row for row in carom.read(tmp_path / "whole.xml").ignored if "key" in row.element]


def test_what_descriptions_lack_of_attached_keys_is_reported(tmp_path):
    child = CHILD.replace('<key name="few" qpos="5"/>', '<key name="few" mpos="1 2 3"/>')
    mine = '<keyframe><key name="mine" mpos="1 2 3"/></keyframe>'
    description = carom.read(write(tmp_path, attach("p-"), child=child, keyframe=mine))
    (row,) = [it for it in description.ignored if "key" in it.element]
    assert (row.element, row.attributes, row.file.name) == ("keyframe/key", ("mpos",), "child.xml")
    # A key of the file itself is kept as it is.
    assert description.keyframes["mine"]["mpos"] == "1 2 3"
    assert [key.name for key in description.keyframes.values()] == ["mine", "p-k", "p-1", "p-few", "p-ctrl"]


def test_two_keys_of_one_name_are_refused(tmp_path):
    keyframe = '<keyframe><key name="p-k"/></keyframe>'
    with World() as world, pytest.raises(DescriptionError, match=r"child.xml.*two keyframes 'p-k'"):
        world.load(write(tmp_path, attach("p-"), keyframe=keyframe))


def test_models_of_attached_models_have_their_keys_too(tmp_path):
    (tmp_path / "inner.xml").write_text(CHILD)
    middle = (
        '<mujoco model="c"><asset><model name="i" file="inner.xml"/></asset><worldbody><body name="b">'
        '<attach model="i" body="b" prefix="i-"/><geom size=".1"/></body></worldbody></mujoco>'
    )
    with World() as world:
        found = states(world.load(write(tmp_path, attach("p-"), child=middle)))
        assert list(found) == ["i-k", "i-1", "i-few", "i-ctrl"]
        assert found["i-k"][0] == {"p-i-j1": 2.0, "p-i-j2": 3.0}
        found = states(world.load(write(tmp_path, attach("p-") + attach("q-"), child=middle)))
        assert found["q-i-k"][0] == {"p-i-j1": 0.0, "p-i-j2": 0.5, "q-i-j1": 2.0, "q-i-j2": 3.0}
