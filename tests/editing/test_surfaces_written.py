"""Shapes that touch in their own ways are written so as MJCF and USD; URDF has one way for a link."""

import pytest

import carom
from carom.cli.convert import convert

SDF = """<sdf version="1.9"><model name="m"><link name="l"><pose>0 0 1 0 0 0</pose>
<inertial><mass>2</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>
<collision name="smooth"><geometry><box><size>.4 .4 .02</size></box></geometry>
<surface><friction><ode><mu>0.1</mu></ode></friction><bounce><restitution_coefficient>.5</restitution_coefficient>
</bounce></surface></collision>
<collision name="rough"><pose>0 0 .06 0 0 0</pose><geometry><box><size>.4 .4 .02</size></box></geometry>
<surface><friction><ode><mu>0.6</mu></ode></friction></surface></collision></link></model></sdf>"""
MJCF = """<mujoco><worldbody><body name="l"><freejoint/><geom name="smooth" size=".1" friction=".1"/>
<geom name="rough" size=".1" pos="0 0 1" friction="{rough}"/></body></worldbody></mujoco>"""


def test_geoms_have_the_friction_of_their_shapes(tmp_path):
    (tmp_path / "m.sdf").write_text(SDF)
    description = carom.read(tmp_path / "m.sdf")
    friction = {name: str(geom["friction"]).split()[0] for name, geom in description.geoms.items()}
    assert friction == {"smooth": "0.1", "rough": "0.6"}
    said = {(it.element, it.attributes) for it in description.ignored}
    assert any(what.endswith("/contact") and "restitution" in names for what, names in said)


@pytest.mark.parametrize("through", ["xml", "usda"])
@pytest.mark.parametrize("rough", [0.6, 0.1])
def test_urdf_has_one_surface_for_a_link(tmp_path, through, rough):
    source = tmp_path / "m.xml"
    source.write_text(MJCF.format(rough=rough))
    if through == "usda":
        pytest.importorskip("pxr")
        convert(source, tmp_path / "m.usda")
        source = tmp_path / "m.usda"
    lost = convert(source, tmp_path / "m.urdf")
    written = (tmp_path / "m.urdf").read_text()
    found = [it for it in lost if it.element == "collision/contact"]
    differs = rough != 0.1
    assert [it.attributes for it in found] == ([("lateral_friction",)] if differs else [])
    assert written.count("<lateral_friction") == 1
    assert '<lateral_friction value="0.1' in written
    if differs:
        assert found[0].consequence == "all shapes of 'l' touch as one of them"
