"""Meshes collide at their surfaces where files are read as written; PyBullet's margin is the drop-in's."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.converged.masonry import QUADS

from carom import World
from carom.scene.body import Body

HALF = 0.1
_CORNERS = [(x, y, z) for x in (-HALF, HALF) for y in (-HALF, HALF) for z in (-HALF, HALF)]
OBJ = "".join(
    [*(f"v {x} {y} {z}\n" for x, y, z in _CORNERS), *(f"f {a} {b} {c} {d}\n" for a, b, c, d in QUADS)]
)
DAE = """<COLLADA><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{numbers}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4 4 4 4 4 4</vcount><p>{quads}</p>
</polylist></mesh></geometry></library_geometries>
<library_nodes><node id="n"><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node><instance_node url="#n"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".format(
    numbers=" ".join(str(number) for corner in _CORNERS for number in corner),
    quads=" ".join(str(corner - 1) for quad in QUADS for corner in quad),
)
URDF = """<robot name="it"><link name="it"><inertial><mass value="1"/>
<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><mesh filename="it.obj"/></geometry></collision></link></robot>"""
SDF = """<sdf version="1.6"><model name="it"><link name="it"><inertial><mass>1</mass></inertial>
<collision name="c">
<geometry><mesh><uri>it.{suffix}</uri></mesh></geometry></collision></link></model></sdf>"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {"it.obj": OBJ, "it.dae": DAE, "it.urdf": URDF}
    files |= {f"{suffix}.sdf": SDF.format(suffix=suffix) for suffix in ("obj", "dae")}
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def height_at_rest(world: World, body: Body) -> float:
    body.pose = (0.0, 0.0, HALF), (0.0, 0.0, 0.0, 1.0)
    world.step(240)
    return body.pose.position[2]


@pytest.mark.parametrize("name", ["it.obj", "it.urdf", "obj.sdf", "dae.sdf"])
def test_a_mesh_rests_on_its_surface(folder: Path, name: str) -> None:
    world = World(gravity=(0.0, 0.0, -9.81), contact="rigid")
    world.add_plane()
    if name == "it.obj":
        body = world.add_mesh(folder / name)
    else:
        world.load(folder / name)
        body = world["it"]
    assert height_at_rest(world, body) == pytest.approx(HALF, abs=1e-5)


def test_it_has_pybullets_margin_where_it_is_read_as_there(folder: Path) -> None:
    world = World(gravity=(0.0, 0.0, -9.81), contact="rigid")
    world.add_plane()
    body = world.load_urdf(folder / "it.urdf", as_pybullet=True)
    assert height_at_rest(world, body) == pytest.approx(HALF + 1e-3, abs=1e-5)


def test_a_saved_world_keeps_it(folder: Path, tmp_path: Path) -> None:
    world = World(gravity=(0.0, 0.0, -9.81), contact="rigid")
    world.add_plane()
    world.add_mesh(folder / "it.obj", name="it")
    world.save(tmp_path / "saved.carom")
    again = World()
    again.load(tmp_path / "saved.carom")
    assert height_at_rest(again, again["it"]) == pytest.approx(HALF, abs=1e-5)
