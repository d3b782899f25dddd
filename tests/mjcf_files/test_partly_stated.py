"""Of attributes of several numbers a file may state the first ones: the others are those of the class.

Expected numbers are those of MuJoCo 4.0.
"""

import pytest
from numpy.testing import assert_allclose

from carom.formats.mjcf.compiled import compile_mjcf
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.reading.cursor import Cursor
from carom.geometry.hull import hull_triangles

FILE = """<mujoco><compiler angle="radian"/><default>{usual}</default><worldbody>
<body name="a"><joint name="j" limited="true" range="-1 1" {joint}/><geom name="g" {geom}/>
<site name="s" {site}/></body><body name="b" pos="1 0 0"><joint name="k"/>
<geom name="h" size=".1" type="sphere"/></body></worldbody>
{others}</mujoco>"""


def compiled(folder, usual, cursor=None, **stated):
    texts = {"joint": "", "geom": 'size=".1"', "site": "", "others": ""} | stated
    if "size" not in texts["geom"]:
        texts["geom"] += ' size=".1"'
    (folder / "file.xml").write_text(FILE.format(usual=usual, **texts))
    return compile_mjcf(folder / "file.xml", hull=hull_triangles, cursor=cursor)


def robot(model, name):
    return next(placed.robot for placed in model.robots if placed.robot.name == name)


def shape(model):
    (link,) = (link for link in robot(model, "a").links if link.name == "a")
    return link.collisions[0]


def contact(model):
    (link,) = (link for link in robot(model, "a").links if link.name == "a")
    return link.collisions[0].contact or link.contact


def softness(compliance):
    return [*compliance.reference, *compliance.impedance[:3]]


@pytest.mark.parametrize(
    ("own", "expected"), [(".9", (0.9, 0.2, 0.3)), (".9 .8", (0.9, 0.8, 0.3)), ("4 5 6", (4, 5, 6))]
)
def test_friction_keeps_that_of_the_class(tmp_path, own, expected):
    found = contact(
        compiled(tmp_path, '<geom friction=".7 .2 .3" condim="6"/>', geom=f'friction="{own}" size=".1"')
    )
    numbers = found.lateral_friction, found.spinning_friction, found.rolling_friction
    assert_allclose(numbers, expected)


def test_a_class_keeps_numbers_of_the_class_around_it(tmp_path):
    usual = '<geom friction=".7 .2 .3" condim="6"/><default class="c"><geom friction=".5 .4"/></default>'
    found = contact(compiled(tmp_path, usual, geom='class="c" friction=".9" size=".1"'))
    assert (found.lateral_friction, found.spinning_friction, found.rolling_friction) == (0.9, 0.4, 0.3)


@pytest.mark.parametrize(("own", "half"), [(".1", (0.1, 0.8, 0.3)), (".1 .2", (0.1, 0.2, 0.3))])
def test_sizes(tmp_path, own, half):
    model = compiled(
        tmp_path, '<geom type="box" size=".7 .8 .3"/><site size=".4 .5 .6"/>', geom=f'size="{own}"',
        site=f'type="box" size="{own}"',
    )  # fmt: skip
    assert shape(model).geometry.half_extents == half
    assert model.sites["s"].size == ((0.1, 0.5, 0.6) if own == ".1" else (0.1, 0.2, 0.6))


def test_how_contacts_limits_friction_and_tendons_yield(tmp_path):
    names = ("solref", "solimp")
    first, others = (".9", ".6"), (".02 3", ".7 .8 .3 .4 2.5")

    def stated(texts, of=""):
        return " ".join(f'{name}{of}="{text}"' for name, text in zip(names, texts, strict=True))

    usual = (
        f"<geom {stated(others)}/>"
        f"<joint frictionloss='1' {stated(others, 'limit')} {stated(others, 'friction')}/>"
        f"<pair {stated(others)}/><equality {stated(others)}/><tendon {stated(others, 'limit')}/>"
    )
    model = compiled(
        tmp_path,
        usual,
        geom=stated(first),
        joint=f"{stated(first, 'limit')} {stated(first, 'friction')}",
        others=f"<contact><pair geom1='g' geom2='h' {stated(first)}/></contact>"
        f"<equality><joint joint1='j' joint2='k' {stated(first)}/></equality>"
        f"<tendon><fixed name='t' range='0 1' {stated(first, 'limit')}>"
        "<joint joint='j' coef='1'/></fixed></tendon>",
    )
    (joint,) = (it for it in robot(model, "a").joints if it.name == "j")
    (paired,) = model.paired.values()
    for each in (
        contact(model).compliance.compliance,
        joint.limit_compliance,
        joint.friction_compliance,
        paired.compliance,
        model.couplings[0].compliance,
        model.tendons["t"].limit_compliance,
    ):
        assert softness(each) == [0.9, 3.0, 0.4, 2.5, 0.6, 0.8, 0.3]


def test_friction_of_pairs(tmp_path):
    model = compiled(
        tmp_path,
        '<pair friction="1 1 3 4 4" condim="6" solreffriction=".1 2"/>',
        others='<option cone="elliptic"/><contact><pair geom1="g" geom2="h" friction="9 9" '
        'solreffriction="7"/></contact>',
    )
    (paired,) = model.paired.values()
    assert (paired.friction, paired.lateral_reference) == ((9.0, 4.0, 3.0), (7.0, 2.0))


def test_laws_and_gears_of_actuators(tmp_path):
    usual = (
        '<general gaintype="affine" biastype="affine" dyntype="filter" gainprm="1 2 3" biasprm="4 5 6" '
        'dynprm=".5" gear="1 2 3 4 5 6"/>'
    )
    model = compiled(
        tmp_path,
        usual,
        others='<actuator><general joint="j" gainprm="9" biasprm="8 7"/>'
        '<motor site="s" gear="9 8"/></actuator>',
    )
    general, motor = (it.spec for it in model.actuators)
    assert general is not None
    assert motor is not None
    assert (general.gain, general.bias, general.gear) == ((9, 2, 3), (8, 7, 6), 1)
    assert motor.wrench == (9, 8, 3, 4, 5, 6)


def test_coefficients_of_the_fluid(tmp_path):
    usual = '<geom fluidshape="ellipsoid" fluidcoef="1 2 3 4 5"/>'
    model = compiled(tmp_path, usual, geom='fluidcoef=".6 .5"')
    (fluid,) = (it.fluid for it in robot(model, "a").links if "@fluid" in it.name)
    assert fluid is not None
    assert (fluid.blunt_drag, fluid.slender_drag, fluid.angular_drag) == (0.6, 0.5, 3.0)
    assert (fluid.kutta_lift, fluid.magnus_lift) == (4.0, 5.0)


def test_terms_of_a_class_that_count_are_reported(tmp_path):
    cursor = Cursor(MJCF_RULES)
    compiled(tmp_path, '<joint damping="1 .2" frictionloss="1"/>', cursor, joint='damping="9"')
    assert [it.attributes for it in cursor.ignored().that_matter if "damping" in it.attributes] == [
        ("damping",)
    ]
    whole = Cursor(MJCF_RULES)
    compiled(tmp_path, '<geom friction=".7 .2 .3" condim="6"/>', whole, geom='friction="9"')
    assert not whole.ignored()


def test_a_spring_length_is_stated_as_a_whole(tmp_path):
    model = compiled(
        tmp_path,
        '<tendon springlength="1 2"/>',
        others='<tendon><fixed name="t" springlength=".9"><joint joint="j" coef="1"/></fixed></tendon>',
    )
    assert model.tendons["t"].spring_range == (0.9, 0.9)


SERVO, DAMPED = '<position kp="100" kv="5"/>', '<velocity kv="3"/>'
MUSCLE = '<muscle range=".65 1.1"/>'
FILTERED = '<general gainprm="7 8 9" biasprm="4 5 6" dynprm=".3" dyntype="filter" biastype="affine"/>'


@pytest.mark.parametrize(
    ("usual", "own", "gain", "bias"),
    [
        # Of the last kind, and of no other one.
        (DAMPED + SERVO, '<position joint="j"/>', (100, 0, 0), (0, -100, -5)),
        (SERVO + DAMPED, '<position joint="j"/>', (1, 0, 0), (0, -1, 0)),
        (SERVO + DAMPED, '<velocity joint="j"/>', (3, 0, 0), (0, 0, -3)),
        (SERVO + '<motor gear="2"/>', '<position joint="j"/>', (1, 0, 0), (0, -1, 0)),
        (FILTERED + "<motor/>", '<position joint="j"/>', (1, 0, 0), (0, -1, 0)),
        ('<cylinder area="3" timeconst=".4"/>' + SERVO, '<cylinder joint="j"/>', (1, 0, 0), (0, 0, 0)),
        # General ones go on from the last kind.
        (SERVO + DAMPED, '<general joint="j"/>', (3, 0, 0), (0, 0, -3)),
        (DAMPED + SERVO, '<general joint="j"/>', (100, 0, 0), (0, -100, -5)),
    ],
)
def test_a_class_has_one_law_for_actuators_of_all_kinds(tmp_path, usual, own, gain, bias):
    model = compiled(tmp_path, usual, others=f"<actuator>{own}</actuator>")
    spec = model.actuators[0].spec
    assert spec is not None
    assert (spec.gain, spec.bias) == (gain, bias)


@pytest.mark.parametrize(
    ("usual", "fibre"), [('<motor gear="2"/>' + MUSCLE, 1 / 0.45), (MUSCLE + '<motor gear="2"/>', 1 / 0.3)]
)
def test_muscles_keep_the_range_of_the_class_unless_another_kind_follows(tmp_path, usual, fibre):
    others = '<actuator><muscle joint="j" lengthrange="0 1" force="9"/></actuator>'
    spec = compiled(tmp_path, usual, others=others).actuators[0].spec
    assert spec is not None
    assert spec.muscle is not None
    # The gear is that of all kinds.
    assert (spec.muscle.fibre, spec.gear) == (pytest.approx(fibre), 2)
