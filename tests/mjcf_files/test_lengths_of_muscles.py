"""Muscles without a `lengthrange` have the lengths that MuJoCo finds.

The numbers are `actuator_lengthrange` of `mujoco` 4.0. Limits of joints yield there, by up to 1 mrad, so that
lengths differ by up to 1e-3 of their range.
"""

import pytest

from carom import World

FILE = """<mujoco><compiler autolimits="true"/><worldbody><site name="w" pos=".1 0 .2"/>
<body name="a"><joint name="j" axis="0 1 0" range="-60 90"/><geom size=".05" pos="0 0 -.3"/>
<site name="s" pos="0.02 0 -.2"/><geom name="roll" type="cylinder" size=".04 .1" euler="90 0 0" pos="0 0 -.4"
 contype="0" conaffinity="0"/><site name="side" pos=".1 0 -.4"/><body pos="0 0 -.4"><joint name="k"
 axis="0 1 0" range="0 120"/><geom size=".05" pos="0 0 -.3"/><site name="e" pos="-.03 0 -.1"/><body
 pos="0 0 -.3" euler="0 0 30"><joint name="p" type="slide" axis="1 0 0" ref=".02" range="-.1 .1"/><joint
 name="h" axis="1 0 0" pos="0 .02 0"/><geom size=".04" pos=".02 .05 0"/><site name="f" pos="0 .1 .05"/>
</body></body></body>
<body name="b"><joint name="slide" type="slide"/><joint name="q" axis="1 0 0"/><geom size=".1" pos=".1 0 0"/>
<site name="far" pos="0 .1 0"/><body name="ball" pos="0 0 1"><joint type="ball"/><geom size=".1"/>
<site name="ball" pos="0 0 .1"/></body></body></worldbody>
<tendon>{}</tendon><actuator>{}</actuator>{}</mujoco>"""
MUSCLE = '<muscle tendon="t"/>'
SEVERAL = "there are several ranges"


def path(*parts, more=""):
    made = {"pulley": '<pulley divisor="2"/>', "roll": '<geom geom="roll"/>'}
    sites = (made.get(part, f'<site site="{part}"/>') for part in parts)
    return f'<spatial name="t" {more}>{"".join(sites)}</spatial>'


FIXED = '<fixed name="t"><joint joint="j" coef=".5"/><joint joint="k" coef="-1"/></fixed>'
LIMIT = 'range=".3 .4"'
CASES = {
    "from the world": (path("w", "s"), MUSCLE, (0.294567565, 0.424604017), SEVERAL),
    "over two joints": (path("w", "s", "e"), MUSCLE, (0.448785926, 0.728748622), SEVERAL),
    "over one of two joints": (path("s", "e"), MUSCLE, (0.154114312, 0.304145336), ""),
    "around a cylinder": (path("s", "roll", "e"), MUSCLE, (0.154114312, 0.309505219), ""),
    "of joints": (FIXED, '<muscle tendon="t" gear="3"/>', (-7.85569509, 2.35887662), ""),
    "of a joint": ("", '<muscle joint="k" gear="-2"/>', (-4.19008952, 0.00109795925), ""),
    "of a tendon with a limit": (path("w", "s", more=LIMIT), MUSCLE, (0.299995102, 0.400009598), SEVERAL),
}


def load(folder, tendon, actuator, more=""):
    (folder / "file.xml").write_text(FILE.format(tendon, actuator, more))
    with World() as world:
        scene = world.load(folder / "file.xml")
        muscles = [it.spec.muscle for it in scene.actuators.values()]
        return muscles[0] if muscles else None, list(scene.ignored.that_matter)


def lengths(muscle):
    # Their usual range is from 0.75 to 1.05 of the length of the fibre.
    return 0.75 * muscle.fibre + muscle.tendon, 1.05 * muscle.fibre + muscle.tendon


def assert_lengths(muscle, expected):
    tolerance = 1e-3 * (expected[1] - expected[0])
    assert lengths(muscle) == pytest.approx(expected, abs=tolerance)


@pytest.mark.parametrize("name", CASES)
def test_lengths_are_those_that_mujoco_finds(tmp_path, name):
    tendon, actuator, expected, doubt = CASES[name]
    muscle, lost = load(tmp_path, tendon, actuator)
    assert_lengths(muscle, expected)
    assert [it.attributes for it in lost] == [("lengthrange",)] * bool(doubt)
    assert all(doubt in it.reason for it in lost)


def test_joints_without_limits_turn_all_the_way(tmp_path):
    tendon = path("w", "s")
    (tmp_path / "file.xml").write_text(FILE.format(tendon, MUSCLE, "").replace('range="-60 90"', ""))
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        (actuator,) = scene.actuators.values()
        assert_lengths(actuator.spec.muscle, (0.0226092863, 0.424604017))
        assert not scene.ignored.that_matter


@pytest.mark.parametrize(
    ("tendon", "actuator"),
    [
        (path("w", "far"), MUSCLE),
        (path("far", "ball"), MUSCLE),
        ("", '<muscle joint="h"/>'),
    ],
)
def test_muscles_whose_lengths_have_no_end_are_left_out(tmp_path, tendon, actuator):
    # MuJoCo does not compile the first and the last one.
    muscle, (lost,) = load(tmp_path, tendon, actuator)
    assert muscle is None
    assert lost.consequence == "it does not act"
    assert "state its lengthrange" in lost.reason


def test_limits_of_a_tendon_bound_what_no_search_finds(tmp_path):
    muscle, (lost,) = load(tmp_path, path("far", "ball", more='range=".9 1"'), MUSCLE)
    assert lengths(muscle) == pytest.approx((0.9, 1.0))
    assert "joints that move the tendon" in lost.reason


@pytest.mark.parametrize(("tendon", "actuator"), [(path("s", "e"), MUSCLE), ("", '<muscle joint="k"/>')])
def test_equality_constraints_make_lengths_uncertain(tmp_path, tendon, actuator):
    equality = '<equality><joint joint1="j" joint2="k"/></equality>'
    muscle, (lost,) = load(tmp_path, tendon, actuator, equality)
    assert muscle is not None
    assert lost.attributes == ("lengthrange",)
    assert "equality constraints" in lost.reason


def test_stated_lengths_count(tmp_path):
    for text in ('lengthrange=".1 .7"', 'lengthrange="0 0"'):
        muscle, lost = load(tmp_path, path("s", "e"), f'<muscle tendon="t" {text}/>')
        assert not lost
        assert_lengths(muscle, (0.1, 0.7) if "7" in text else CASES["over one of two joints"][2])
