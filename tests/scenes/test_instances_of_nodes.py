"""COLLADA files that show nodes again by `<instance_node>`: in SDF files these are there."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.description import TriangleMesh
from carom.errors import DescriptionError
from carom.meshes import read_mesh

DAE = """<COLLADA version="1.4.1"><asset><unit meter="1"/></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry>
</library_geometries><library_nodes><node id="n"><translate>5 0 0</translate>
<instance_geometry url="#g"/>{more}
</node></library_nodes><library_visual_scenes><visual_scene id="s"><node id="a">{own}<node>
<translate>0 3 0</translate><instance_node url="#{shown}"/></node></node></visual_scene>
</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
OWN = '<instance_geometry url="#g"/>'
SHAPE = "<geometry><mesh><uri>m.dae</uri><scale>2 1 1</scale></mesh></geometry>"
SDF = f"""<sdf version="1.9"><model name="m"><link name="l"><collision name="c">{SHAPE}</collision>
<visual name="v">{SHAPE}</visual></link></model></sdf>"""


def load(folder, own=OWN, more="", shown="n"):
    (folder / "m.dae").write_text(DAE.format(own=own, more=more, shown=shown))
    (folder / "m.sdf").write_text(SDF)
    return World().load(folder / "m.sdf")[0]


@pytest.mark.parametrize("own", [OWN, ""])
def test_nodes_are_where_they_are_shown(tmp_path, own):
    body = load(tmp_path, own)
    (collision,) = body.spec.base.collisions
    points = collision.geometry.points
    assert_allclose(points.max(axis=0), (12.0, 4.0, 1.0))
    assert_allclose(points.min(axis=0), (0.0, 0.0, 0.0) if own else (10.0, 3.0, 0.0))
    (visual,) = body.spec.base.visuals
    assert isinstance(visual.geometry, TriangleMesh)
    assert len(visual.geometry.triangles) == (8 if own else 4)


def test_the_reading_that_bullet_has_is_without_them(tmp_path):
    load(tmp_path)
    assert sum(len(part.triangles) for part in read_mesh(tmp_path / "m.dae")) == 4


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"shown": "x"}, "there is no node 'x' in the file"),
        ({"shown": "a"}, "node 'a' shows itself"),
        ({"more": '<instance_node url="#n"/>'}, "node 'n' shows itself"),
    ],
)
def test_nodes_that_are_missing_or_show_themselves_are_errors(tmp_path, options, problem):
    with pytest.raises(DescriptionError, match=problem):
        load(tmp_path, **options)


def test_mirrored_triangles_are_turned(tmp_path):
    (tmp_path / "m.dae").write_text(DAE.format(own=OWN, more="", shown="n"))
    (tmp_path / "m.sdf").write_text(SDF.replace("2 1 1", "-2 1 1"))
    geometry = World().load(tmp_path / "m.sdf")[0].spec.base.visuals[0].geometry
    a, b, c = (geometry.vertices[geometry.triangles[:, corner]] for corner in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0
