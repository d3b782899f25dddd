"""Flexes of MJCF files as soft bodies, beside what MuJoCo 4.0 makes of them."""

import json
from pathlib import Path
from struct import pack

import numpy as np
import pytest
from tests.each import each
from tests.mjcf_files.cases.flex import KEPT, MADE, RESTING, STEPS

from carom import World
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parents[1] / "mjcf_files" / "cases" / "flex_answers.json").read_text())
# Greatest distance of a node from where it is in MuJoCo, as a share of the sag.
WITHIN = {
    "cable of springs": 1e-4,
    "cable of constraints": 1e-3,
    "cloth of constraints": 0.01,
    "cloth that stretches": 0.07,
    "beam": 0.01,
}


def loaded(world, tmp_path, text):
    (tmp_path / "flex.xml").write_text(text)
    return world.load(tmp_path / "flex.xml")


def flex(text, around="{}"):
    return f"<mujoco><worldbody>{around.format(text)}</worldbody></mujoco>"


CLOTH = '<flexcomp name="f" type="grid" count="3 3 1" spacing=".1 .1 .1" mass=".9" {}>{}</flexcomp>'


@each("name", list(MADE))
def test_nodes_cells_pins_and_masses_are_those_of_mujoco(tmp_path, name):
    answer = ANSWERS["made"][name]
    with World() as world:
        soft = loaded(world, tmp_path, MADE[name])["f"]
        np.testing.assert_allclose(soft.nodes, answer["points"], atol=1e-12)
        pinned = sorted(anchor.node for anchor in soft.anchors)
        assert pinned == sorted(set(range(len(soft.nodes))) - set(answer["moving"]))
        np.testing.assert_allclose(soft.soft_spec.masses, answer["mass"], rtol=1e-12)
        cells = soft.tetrahedra if len(soft.tetrahedra) else soft.faces
        if len(cells) and len(answer["cells"][0]) == cells.shape[1]:
            assert sorted(sorted(row) for row in cells.tolist()) == answer["cells"]


@pytest.mark.parametrize("name", list(RESTING))
def test_flexes_come_to_rest_where_those_of_mujoco_do(tmp_path, name):
    with World() as world:
        soft = loaded(world, tmp_path, RESTING[name])["f"]
        start = soft.nodes.copy()
        for _ in range(STEPS):
            world.step()
            soft.set_node_velocities(KEPT * soft.node_velocities)
        answer = np.array(ANSWERS["rest"][name])
        sag = np.abs(answer - start).max()
        assert sag > 0.002
        assert np.abs(soft.nodes - answer).max() < WITHIN[name] * sag


def test_a_body_that_moves_holds_the_nodes_that_are_pinned_to_it(tmp_path):
    text = flex(
        CLOTH.format("", '<edge equality="true"/><pin id="0 1"/>'),
        '<body name="b" pos="0 0 1"><joint type="slide" axis="1 0 0"/><geom size=".1" mass="9"/>{}</body>',
    )
    with World() as world:
        scene = loaded(world, tmp_path, text)
        soft, body = scene["f"], scene["b"]
        apart = soft.nodes[0] - body.links["b"].pose.position
        body.joints[0].velocity = 0.5
        world.step(200)
        assert body.joints[0].position > 0.1
        np.testing.assert_allclose(soft.nodes[0] - body.links["b"].pose.position, apart, atol=1e-4)


def test_a_connection_lets_a_body_hold_a_node(tmp_path):
    text = (
        '<mujoco><worldbody><body name="b" pos="-.1 -.1 0"><joint type="slide" axis="1 0 0"/>'
        f'<geom size=".01" mass="9"/></body>{CLOTH.format("", "")}</worldbody><equality>'
        '<connect body1="f_0" body2="b" anchor="0 0 0"/></equality></mujoco>'
    )
    with World() as world:
        scene = loaded(world, tmp_path, text)
        scene["b"].joints[0].velocity = 1.0
        world.step(100)
        np.testing.assert_allclose(scene["f"].nodes[0], scene["b"].links["b"].pose.position, atol=1e-9)
        assert scene["f"].nodes[8][2] < -0.1


def test_keyframes_count_the_sliders_of_nodes(tmp_path):
    text = (
        "<mujoco><worldbody>" + CLOTH.format("", '<pin id="0"/>') + '<body name="b"><joint name="j"/>'
        '<geom size=".1" mass="1"/></body></worldbody><keyframe><key name="k" qpos="'
        + "0 " * 24
        + '.5"/></keyframe></mujoco>'
    )
    with World() as world:
        scene = loaded(world, tmp_path, text)
        scene.reset("k")
        assert scene["b"].joints["j"].position == 0.5


@each(
    ("change", "consequence"),
    [
        (('dof="trilinear"', ""), "it is missing"),
        (("", '<edge equality="strain"/>'), "nothing holds its strain"),
        (("", '<elasticity young="1" thickness="1" elastic2d="bend"/>'), "it does not resist bending"),
        (
            ("", '<elasticity young="1" thickness="1" elastic2d="stretch"/>'),
            "Poisson's ratio of the cloth is 1/3",
        ),
        (("", '<contact solref=".1 1"/>'), "its contacts do not yield"),
    ],
)
def test_what_soft_bodies_cannot_do_is_reported(tmp_path, change, consequence):
    with World() as world:
        ignored = loaded(world, tmp_path, flex(CLOTH.format(*change))).ignored
        assert consequence in [it.consequence for it in ignored]


@each(
    ("text", "says"),
    [
        (CLOTH.format("", '<pin id="9"/>'), "there is no point 9"),
        (CLOTH.format("", '<pin grid="0 3"/>'), "there is no point"),
        (CLOTH.format('dim="4"', ""), "dim=4"),
        ('<flexcomp name="f" type="direct" dim="2" point="0 0 0" element="0 1 2"/>', "a point that is not"),
        ('<flexcomp name="f" type="blob"/>', "type='blob'"),
        ('<flexcomp name="f" type="mesh" file="none.obj"/>', "was found"),
    ],
)
def test_broken_flexes_are_errors_that_say_what_is_wrong(tmp_path, text, says):
    with World() as world:
        with pytest.raises(DescriptionError, match=says):
            loaded(world, tmp_path, flex(text))
        assert len(world.bodies) == 0


MSH = {
    "2.2": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n4 0 1 0\n7 0 0 1\n9 1 1 1\n"
    "$EndNodes\n$Elements\n3\n1 15 2 0 1 1\n2 2 2 0 1 1 2 4\n3 4 2 0 1 1 2 4 7\n$EndElements\n",
    "4.1": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 5 1 9\n3 1 0 4\n1\n2\n4\n7\n0 0 0\n1 0 0\n0 1 0\n"
    "0 0 1\n2 1 0 1\n9\n1 1 1\n$EndNodes\n$Elements\n3 3 1 3\n0 1 15 1\n3 1\n2 1 2 1\n1 1 2 4\n3 1 4 1\n"
    "2 1 2 4 7\n"
    "$EndElements\n",
}


POINTS = ((1, 0, 0, 0), (2, 1, 0, 0), (4, 0, 1, 0), (7, 0, 0, 1), (9, 1, 1, 1))
BINARY = {
    "2.2": b"$MeshFormat\n2.2 1 8\n" + pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n5\n"
    + b"".join(pack("<i3d", *point) for point in POINTS) + b"\n$EndNodes\n$Elements\n3\n"
    + pack("<3i3i", 15, 1, 1, 3, 0, 1)
    + pack("<3i5i", 2, 1, 1, 1, 0, 1, 2, 4) + pack("<3i6i", 4, 1, 1, 2, 0, 1, 2, 4, 7) + b"\n$EndElements\n",
    "4.1": b"$MeshFormat\n4.1 1 8\n" + pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n"
    + pack("<4q3iq", 1, 5, 1, 9, 3, 1, 0, 5) + pack("<5q", *(point[0] for point in POINTS))
    + b"".join(pack("<3d", *point[1:]) for point in POINTS) + b"\n$EndNodes\n$Elements\n"
    + pack("<4q", 3, 3, 1, 3) + pack("<3iq2q", 0, 1, 15, 1, 3, 1) + pack("<3iq4q", 2, 1, 2, 1, 1, 1, 2, 4)
    + pack("<3iq5q", 3, 1, 4, 1, 2, 1, 2, 4, 7)
    + b"\n$EndElements\n",
}  # fmt: skip
FILES = {f"{name} text": text.encode() for name, text in MSH.items()}
FILES |= {f"{name} binary": data for name, data in BINARY.items()}


@pytest.mark.parametrize("version", list(FILES))
def test_tetrahedra_of_gmsh_are_read(tmp_path, version):
    (tmp_path / "solid.msh").write_bytes(FILES[version])
    text = '<flexcomp name="f" type="gmsh" file="solid.msh" mass="4"><elasticity young="9"/></flexcomp>'
    with World() as world:
        soft = loaded(world, tmp_path, flex(text))["f"]
        np.testing.assert_allclose(soft.nodes, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], atol=1e-12)
        assert len(soft.tetrahedra) == 1
        np.testing.assert_allclose(soft.mass, 4.0)


@each("version", list(MSH))
def test_points_alone_are_nothing_to_make_a_body_of(tmp_path, version):
    text = MSH[version]
    begin = text.index("$Elements")
    points = {"2.2": "1\n1 15 2 0 1 1\n", "4.1": "1 1 1 1\n0 1 15 1\n1 1\n"}[version]
    (tmp_path / "solid.msh").write_text(f"{text[:begin]}$Elements\n{points}$EndElements\n")
    with World() as world, pytest.raises(DescriptionError, match="no edges, triangles or tetrahedra"):
        loaded(world, tmp_path, flex('<flexcomp name="f" type="gmsh" dim="3" file="solid.msh"/>'))


@each("length", range(0, 280, 7))
def test_binary_files_of_gmsh_that_are_cut_off_are_errors(tmp_path, length):
    for data in BINARY.values():
        (tmp_path / "solid.msh").write_bytes(data[:length] + b"\n$EndElements\n" * (length % 2))
        with World() as world, pytest.raises(DescriptionError, match=r"solid\.msh"):
            loaded(world, tmp_path, flex('<flexcomp name="f" type="gmsh" dim="3" file="solid.msh"/>'))


@each("cut", ["$Elements", "4 7\n", "0 8"])
def test_broken_files_of_gmsh_are_errors(tmp_path, cut):
    (tmp_path / "solid.msh").write_text(MSH["2.2"].replace(cut, "", 1))
    with World() as world, pytest.raises(DescriptionError, match=r"solid\.msh"):
        loaded(world, tmp_path, flex('<flexcomp name="f" type="gmsh" dim="3" file="solid.msh"/>'))


def test_options_with_an_integrator_that_has_no_soft_bodies_hold_without_it(tmp_path, caplog):
    text = flex(CLOTH.format("", '<edge equality="true"/>')).replace(
        "<mujoco>", '<mujoco><option integrator="RK4" timestep=".003"/>'
    )
    with World() as world:
        scene = loaded(world, tmp_path, text)
        scene.apply_options()
        assert (world.integrator, world.time_step) == ("discrete", 0.003)
        assert "cannot have soft bodies" in caplog.text
        world.step(3)
