"""Elements of sections that refer to copies and attached models: which there are, and their order.

Expected names are those of MuJoCo 4.0, in its order.
"""

import pytest

from carom import World
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled import compile_mjcf
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.reading.cursor import Cursor
from carom.geometry.hull import hull_triangles

SHAPE = '<geom size=".1"/>'
NESTED = f"""<replicate count="2" offset="0 0 1" sep="_"><body name="a"><joint name="j"/>{SHAPE}
<site name="s"/><replicate count="3" offset="1 0 0" sep="-"><body name="b"><joint name="k"/>
<geom name="gb" size=".1"/><site name="t"/></body></replicate></body></replicate>
<body name="c"><joint name="l"/><geom name="gc" size=".1"/><site name="sc"/></body>
<replicate count="2" sep="+" offset="0 1 0"><body name="d"><joint name="m"/>{SHAPE}</body></replicate>"""
INNER = ["-0_0", "-1_0", "-2_0", "-0_1", "-1_1", "-2_1"]
ATTACHED = f"""<mujoco model="a"><worldbody><body name="r"><joint name="j"/><geom name="gr" size=".1"/>
<replicate count="2" sep="-" offset="1 0 0"><body name="b"><joint name="k"/>{SHAPE}</body></replicate></body>
<body name="z" pos="0 1 0"><joint name="jz"/><geom name="gz" size=".1"/></body></worldbody>
<contact><exclude name="e" body1="r" body2="b"/><exclude name="f" body1="r" body2="z"/>
<exclude body1="r" body2="world"/><pair name="p" geom1="gr" geom2="gz"/></contact>
<equality><joint name="q" joint1="j" joint2="jz"/><weld name="w" body1="r"/></equality>
<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="K" joint="k"/><motor name="J" joint="j"/></actuator>
<sensor><jointpos name="s" joint="j"/></sensor></mujoco>"""
OWN = '<body name="c"><joint name="l"/><geom size=".1"/></body>'


@pytest.fixture
def compiled(tmp_path):
    def compiled(bodies, sections, cursor=None):
        (tmp_path / "a.xml").write_text(ATTACHED)
        asset = '<asset><model name="a" file="a.xml"/></asset>' if "<attach" in bodies else ""
        (tmp_path / "file.xml").write_text(
            f'<mujoco>{asset}<option><flag filterparent="disable"/></option>'
            f"<worldbody>{bodies}</worldbody>{sections}</mujoco>"
        )
        return compile_mjcf(tmp_path / "file.xml", hull=hull_triangles, cursor=cursor)

    return compiled


def names(parts):
    return [part.name for part in parts]


def test_copies_come_after_others_one_after_another(compiled):
    model = compiled(
        NESTED,
        '<tendon><fixed name="T"><joint joint="k" coef="1"/></fixed>'
        '<fixed name="U"><joint joint="l" coef="1"/></fixed>'
        '<fixed name="V"><joint joint="j" coef="1"/></fixed></tendon><actuator><motor name="A" joint="k"/>'
        '<motor name="L" joint="l"/><motor name="B" joint="j"/><motor name="T" tendon="T"/>'
        '<motor name="D" joint="m"/></actuator><sensor><jointpos name="k" joint="k"/>'
        '<jointpos name="l" joint="l"/>'
        '<jointpos name="j" joint="j"/>'
        '<actuatorfrc name="af" actuator="A"/><jointpos name="m" joint="m"/></sensor>'
        '<equality><joint name="q" joint1="k"/><joint name="r" joint1="j"/></equality>',
    )
    first, second = INNER[:3], INNER[3:]
    assert names(model.actuators) == [
        "L", "B_0", *(f"{x}{it}" for it in first for x in "AT"), "B_1",
        *(f"{x}{it}" for it in second for x in "AT"), "D+0", "D+1",
    ]  # fmt: skip
    assert names(model.sensors) == [
        "l", "j_0", *(f"{x}{it}" for it in first for x in ("k", "af")), "j_1",
        *(f"{x}{it}" for it in second for x in ("k", "af")), "m+0", "m+1",
    ]  # fmt: skip
    assert list(model.tendons) == [
        "U", "V_0", *(f"T{it}" for it in first), "V_1", *(f"T{it}" for it in second)
    ]  # fmt: skip
    assert names(model.couplings) == [
        "r_0", *(f"q{it}" for it in first), "r_1", *(f"q{it}" for it in second)
    ]  # fmt: skip


def test_controls_of_keyframes_are_in_that_order(tmp_path):
    (tmp_path / "file.xml").write_text(
        f'<mujoco><worldbody>{NESTED}</worldbody><actuator><motor name="A" joint="m"/>'
        '<motor name="L" joint="l"/></actuator><keyframe><key name="k" ctrl="1 2 3"/></keyframe></mujoco>'
    )
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        scene.reset("k")
        controls = {name: it.control for name, it in scene.actuators.items()}
    assert controls == {"L": 1.0, "A+0": 2.0, "A+1": 3.0}


def test_what_connects_a_copy_with_what_is_around_it(compiled):
    model = compiled(
        f'<geom name="floor" type="plane" size="1 1 1"/>{NESTED}',
        '<contact><exclude body1="b" body2="a"/><exclude body1="c" body2="d"/>'
        '<exclude body1="world" body2="a"/>'
        '<pair geom1="floor" geom2="gb"/><pair geom1="gb" geom2="gc"/></contact>'
        '<tendon><spatial name="S"><site site="t"/><site site="s"/></spatial></tendon>'
        '<sensor><framepos name="F" objtype="site" objname="t" reftype="site" refname="sc"/></sensor>',
    )
    assert model.excluded == [
        *((f"b{it}", f"a{it[2:]}") for it in INNER), ("c", "d+0"), ("c", "d+1"),
        ("world", "a_0"), ("world", "a_1"),
    ]  # fmt: skip
    assert [*model.paired] == [pair for it in INNER for pair in ((f"b{it}", "world"), (f"b{it}", "c"))]
    assert [*model.tendons] == [f"S{it}" for it in INNER]
    assert [part.on for part in model.tendons["S-1_1"].parts] == ["b-1_1", "a_1"]
    assert [(it.object, it.reference) for it in model.sensors] == [(f"t{it}", "sc") for it in INNER]


@pytest.mark.parametrize(
    "section",
    [
        '<equality><joint joint1="k" joint2="l"/></equality>',
        '<equality><joint joint1="j" joint2="k"/></equality>',
        '<equality><weld site1="t" site2="s"/></equality>',
        '<actuator><general site="t" refsite="sc" gear="1"/></actuator>',
        '<actuator><general cranksite="t" slidersite="sc" cranklength="1"/></actuator>',
    ],
)
def test_constraints_and_actuators_across_are_left_out_as_in_mujoco(compiled, section):
    cursor = Cursor(MJCF_RULES)
    model = compiled(NESTED, section, cursor)
    assert not model.actuators
    assert not model.couplings + model.connections
    assert any("not in that copy" in it.reason for it in cursor.ignored().that_matter)


def test_copies_by_several_elements_with_the_same_names_after_them(compiled):
    model = compiled(
        f'{OWN}<replicate count="2" offset="1 0 0"><body name="b"><joint name="k"/>{SHAPE}</body></replicate>'
        f'<replicate count="2" offset="1 0 0"><body name="d"><joint name="m"/>{SHAPE}</body></replicate>',
        '<actuator><motor name="A" joint="k"/><motor name="B" joint="m"/>'
        '<motor name="C" joint="k"/></actuator>',
    )
    assert names(model.actuators) == ["A0", "C0", "A1", "C1", "B0", "B1"]


def test_a_name_that_is_nowhere_is_an_error(compiled):
    with pytest.raises(DescriptionError, match="there is no body 'x'"):
        compiled(NESTED, '<contact><exclude body1="b" body2="x"/></contact>')
    with pytest.raises(DescriptionError, match="no copy by <replicate> has body 'b' and 'd'"):
        compiled(NESTED, '<contact><exclude body1="b" body2="d"/></contact>')


COPIES = '<replicate count="2" sep="_" offset="1 0 0">{}</replicate>'
ATTACH = '<attach model="a" body="r" prefix="p_"/>'
BODY = f'<body name="b"><joint name="k"/>{SHAPE}%s</body>'


@pytest.mark.parametrize(
    ("bodies", "expected"),
    [
        (OWN + COPIES.format(BODY % "") + ATTACH, "L M_0 M_1 p_J p_K-0 p_K-1"),
        (OWN + ATTACH + COPIES.format(BODY % ""), "L p_J p_K-0 p_K-1 M_0 M_1"),
        (OWN + COPIES.format(BODY % ATTACH), "L M_0 p_J_0 p_K-0_0 p_K-1_0 M_1 p_J_1 p_K-0_1 p_K-1_1"),
    ],
)
def test_order_of_attached_models(compiled, bodies, expected):
    model = compiled(bodies, '<actuator><motor name="M" joint="k"/><motor name="L" joint="l"/></actuator>')
    assert names(model.actuators) == expected.split()


def test_sections_of_attached_models_count(compiled):
    model = compiled(
        OWN + '<frame pos="0 0 1"><attach model="a" prefix="p_"/></frame>',
        '<actuator><motor name="L" joint="p_j"/></actuator>'
        '<contact><exclude body1="c" body2="p_r"/></contact>',
    )
    assert model.excluded == [
        ("c", "p_r"), ("p_r", "p_b-0"), ("p_r", "p_b-1"), ("p_r", "p_z"), ("p_r", "world")
    ]  # fmt: skip
    assert [*model.paired] == [("p_r", "p_z")]
    assert names(model.couplings) == ["p_q"]
    assert names(model.connections) == ["p_w"]
    assert [*model.tendons] == ["p_t"]
    assert names(model.sensors) == ["p_s"]
    assert names(model.actuators) == ["L", "p_J", "p_K-0", "p_K-1"]


def test_a_site_of_an_attached_model_may_be_called_world(tmp_path):
    (tmp_path / "b.xml").write_text(
        f'<mujoco model="b"><worldbody><site name="world"/><body name="r"><joint/>{SHAPE}'
        '<site name="s"/></body></worldbody><tendon><spatial name="t"><site site="world"/>'
        '<site site="s"/></spatial></tendon></mujoco>'
    )
    (tmp_path / "file.xml").write_text(
        '<mujoco><asset><model name="b" file="b.xml"/></asset><worldbody><frame pos="0 0 1">'
        '<attach model="b" prefix="p_"/></frame></worldbody></mujoco>'
    )
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        assert [*scene.tendons] == ["p_t"]


def test_what_of_an_attached_model_is_not_attached_is_not_missed(compiled):
    model = compiled(f'{OWN}<attach model="a" body="z" prefix="p_"/>', "")
    assert not model.excluded + model.actuators + model.connections
    assert not model.paired
