"""Descriptions have sections of copies and attached models in the order of MuJoCo, and load as files do."""

import pytest
from tests.mjcf_files.test_copies import ATTACH, ATTACHED, BODY, COPIES, NESTED, OWN

import carom
from carom import World

FILES = {
    "nested": f"""<mujoco><worldbody>{NESTED}</worldbody><contact><exclude body1="b" body2="a"/>
<pair geom1="gb" geom2="gc"/></contact>
<equality><joint joint1="k" joint2="l"/><joint name="r" joint1="j"/></equality>
<tendon><spatial name="S"><site site="t"/><site site="s"/></spatial></tendon>
<actuator><motor name="A" joint="k"/><motor name="L" joint="l"/><motor name="T" tendon="S"/></actuator>
<sensor><actuatorfrc name="af" actuator="A"/><jointpos name="jp" joint="l"/></sensor></mujoco>""",
    "attached": f"""<mujoco><asset><model name="a" file="a.xml"/></asset><worldbody>{OWN}
{COPIES.format(BODY % ATTACH)}</worldbody>
<actuator><motor name="M" joint="k"/><motor name="L" joint="l"/></actuator>
</mujoco>""",
}


@pytest.mark.parametrize("name", FILES)
def test_a_description_loads_as_its_file(tmp_path, name):
    (tmp_path / "a.xml").write_text(ATTACHED)
    (tmp_path / "file.xml").write_text(FILES[name])
    with World() as world, World() as other:
        description = carom.read(tmp_path / "file.xml")
        stated, described = world.load(tmp_path / "file.xml"), other.load(description)
        assert list(stated.actuators) == list(described.actuators)
        assert list(stated.sensors) == list(described.sensors)
        assert len(stated.constraints) == len(described.constraints)
        assert set(stated.tendons) == set(described.tendons)
    said = [it.reason for it in description.ignored]
    assert said == (["it connects a copy with what is not in that copy"] if name == "nested" else [])
