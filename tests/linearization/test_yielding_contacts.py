"""Linearised steps with contacts of MJCF files, which yield, beside central differences."""

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, statuses, tighten

from carom import World

SOFT = 'solref="0.05 0.7" solimp="0.7 0.9 0.004 0.3 3"'
STEEP = 'solref="0.05 0.7" solimp="0.3 0.9 0.004 0.5 1"'
PARAMETERS = ["masses", "friction"]


def of_file(folder: Path, bodies: str, *, floor: str = "", rest: str = "", option: str = "") -> World:
    """A world of a file with a floor."""
    file = folder / "file.xml"
    file.write_text(
        f'<mujoco><option timestep="0.002" {option}/><worldbody>'
        f'<geom name="floor" type="plane" size="5 5 1" friction=".03 .005 .0001" {floor}/>'
        f"{bodies}</worldbody>{rest}</mujoco>"
    )
    world = World(contact="bullet")
    world.load(file).apply_options()
    tighten(world)
    return world


def a_ball(place: str, attributes: str, friction: float = 0.7) -> str:
    """A free ball."""
    ball = f'type="sphere" size=".1" density="900" friction="{friction}"'
    return f'<body pos="{place}"><freejoint/><geom {ball} {attributes}/></body>'


@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
@pytest.mark.parametrize(
    "soft", ["", SOFT, 'solref="-900 -40"', 'solimp=".8 .95 0"', 'solimp=".8 .95 1e-5"', 'margin=".004"']
)
def test_a_ball_sinks_in(tmp_path, soft, cone):
    world = of_file(tmp_path, a_ball(".01 .02 .0987", soft), floor=soft, option=f'cone="{cone}"')
    world.velocity[6:12] = 0.0, 1.5, 0.2, 0.15, 0.1, -0.02
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    assert found["contact 0 of sphere and plane"] == ["holds"]
    assert found["friction of contact 0 of sphere and plane"] == ["holds", "holds"]


@pytest.mark.parametrize(("soft", "friction"), [(SOFT, 0.05), (STEEP, 0.3)])
@pytest.mark.parametrize("kind", ["cone", "pyramid", "isotropic"])
def test_a_tilted_box_slides_on_its_corner(tmp_path, kind, soft, friction):
    box = f'<freejoint/><geom type="box" size=".1 .12 .14" friction="{friction}" {soft}/>'
    floor = soft if soft == STEEP else ""
    world = of_file(tmp_path, f'<body pos="0 0 .168" euler="20 30 0">{box}</body>', floor=floor)
    world.parameters.cone_friction = kind == "cone"
    world.parameters.isotropic_friction = kind == "isotropic"
    world.apply_parameters()
    # The greater the friction, the faster it must be to slide.
    world.velocity[6:12] = 0.1, 0.2, 0.3, 26.0 * friction, 18.0 * friction, -0.1
    while not world.linearize().rows:
        world.step()
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    (sliding,) = (status for name, status in found.items() if name.startswith("friction"))
    assert sliding != ["holds", "holds"]


@pytest.mark.parametrize(
    "weights", [("", ""), ('solmix="3"', 'solmix="1"'), ('priority="1"', ""), ('solref="-2000 -30"', "")]
)
def test_two_balls_with_parameters_of_both(tmp_path, weights):
    one, other = a_ball("0 0 1", weights[0] or SOFT), a_ball(".05 .06 1.18", weights[1], 0.5)
    world = of_file(tmp_path, one + other, option='gravity="0 0 0"')
    world.velocity[12:18] = 0.1, 0.2, 0.3, 0.1, -0.2, -0.6
    assert_exact(world, parameters=PARAMETERS)


def test_friction_of_two_bodies_with_the_same_one_is_shared(tmp_path):
    bodies = a_ball("0 0 1", SOFT) + a_ball(".05 .06 1.18", SOFT)
    world = of_file(tmp_path, bodies, option='gravity="0 0 0"')
    world.velocity[12:18] = 3.0, 2.0, 0.3, 0.1, -0.2, -0.6
    step = assert_exact(world, parameters=["friction"])
    of_balls = step.E[:, -2:]
    assert np.abs(of_balls).max() > 1e-4
    assert (of_balls[:, 0] == of_balls[:, 1]).all()


def test_a_pair_states_friction_and_softness(tmp_path):
    ball = '<body pos="0 0 .0985"><freejoint/><geom name="ball" type="sphere" size=".1"/></body>'
    pair = f'<pair geom1="ball" geom2="floor" {SOFT} friction=".3 .3" solreffriction=".1 1" condim="3"/>'
    world = of_file(tmp_path, ball, rest=f"<contact>{pair}</contact>")
    world.velocity[6:12] = 0.0, 0.0, 0.0, 0.01, 0.003, 0.0
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    assert found["friction of contact 0 of sphere and plane"] == ["holds", "holds"]
    world.velocity[9:12] = 2.0, 1.0, 0.0
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    assert "holds" not in found["friction of contact 0 of sphere and plane"]


def test_an_arm_pushes_on_a_body(tmp_path):
    arm = (
        '<body pos="0 0 .4"><joint name="a" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .3 0 -.1"'
        ' size=".02" contype="0" conaffinity="0"/><body pos=".3 0 -.1"><joint name="b" axis="0 1 0"/>'
        '<geom type="capsule" fromto="0 0 0 .1 0 -.27" size=".02" margin=".02" condim="6"/></body></body>'
    )
    world = of_file(tmp_path, arm, floor='margin=".03"')
    world.velocity[-2:] = 0.3, 0.2
    while not world.linearize().rows:
        world.step()
    step = assert_exact(world, parameters=["masses", "friction"], steps=3)
    assert any(name.startswith("contact") for name, _ in step.rows)


@pytest.mark.parametrize("kind", ["cone", "pyramid"])
def test_a_rod_that_slides_on_its_end_softens_with_depth(tmp_path, kind):
    # Far from equal effective masses along both directions, of which softness is a great part.
    soft = 'solref="0.05 0.7" solimp="0.1 0.9 0.02 0.5 1"'
    rod = f'<freejoint/><geom type="box" size=".01 .012 .4" density="3000" friction=".4" {soft}/>'
    world = of_file(tmp_path, f'<body pos="0 0 .31" euler="25 35 0">{rod}</body>', floor=soft)
    world.parameters.cone_friction = kind == "cone"
    world.apply_parameters()
    world.velocity[6:12] = 0.4, -0.3, 0.2, 3.0, 2.0, -0.6
    while not world.linearize().rows:
        world.step()
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    (sliding,) = (status for name, status in found.items() if name.startswith("friction"))
    assert sliding == (["slides"] * 2 if kind == "cone" else sliding)
