"""Linearised steps with tendons along paths, actuators of sites and couplings, beside central differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, statuses
from tests.linearization.test_yielding_rows import of_file

from carom import World, Worlds

# An arm, a free body, and what a path may go around: a ball on the arm, and a cylinder of the world.
SCENE = """
<option timestep="0.004"/><default><geom contype="0" conaffinity="0"/></default><worldbody>
<site name="post" pos="-.3 .15 1.1"/>
<geom name="pole" type="cylinder" size=".06" fromto="-.05 -.3 1.02 -.06 .3 1.05"/>
<site name="over" pos="-.05 0 1.3"/>
<body pos="0 0 1"><joint name="a" axis="0 1 .2" damping=".1"/>
<geom type="capsule" fromto="0 0 0 .3 0 -.1" size=".03"/><site name="upper" pos=".12 .02 .06"/>
<body pos=".3 0 -.1"><joint name="b" axis="1 1 0"/><site name="beside" pos="0 .2 .2"/>
<site name="within" pos=".01 .01 0"/><geom name="knee" type="sphere" size=".05"/>
<geom type="capsule" fromto="0 0 0 .1 .2 -.27" size=".03"/>
<body pos=".1 .2 -.27"><joint name="c" type="{kind}" axis="0 .6 .8"/>
<site name="hand" pos=".05 -.12 .04" euler="20 30 5"/>
<geom type="box" size=".1 .05 .03" pos=".1 0 0"/></body></body></body>
<body name="ball" pos=".5 .3 1.2"><freejoint/><geom type="box" size=".1 .06 .04"/>
<site name="far" pos=".05 .02 .03" euler="10 -20 40"/></body>
</worldbody>
<tendon>{tendon}</tendon><actuator>{actuator}</actuator><equality>{equality}</equality>
"""
SITES = '<site site="post"/><site site="upper"/><site site="hand"/>'
KNEE = '<site site="post"/><site site="upper"/><geom geom="knee"{}/><site site="hand"/>'
POLE = '<site site="post"/><geom geom="pole" sidesite="over"/><site site="upper"/>'
PATHS = {
    "sites": SITES,
    "sphere": KNEE.format(""),
    "sphere by its side": KNEE.format(' sidesite="beside"'),
    "within a sphere": KNEE.format(' sidesite="within"'),
    "cylinder": POLE,
    "cylinder and sphere": POLE + '<geom geom="knee" sidesite="beside"/><site site="hand"/>',
    "pulley": f'{SITES}<pulley divisor="2"/><site site="post"/><site site="hand"/>',
}
STIFF = 'stiffness="400" springlength=".1"'
TERMS = {
    "spring": f'{STIFF} damping="6"',
    "friction": 'frictionloss="300"',
    "sliding": 'frictionloss=".01"',
    "limit": 'limited="true" range="0 .1"',
    "armature": 'armature="3" stiffness="30" damping=".4"',
    "far below": 'limited="true" range="2 3" margin=".05" solreflimit=".06 .8" solimplimit=".4 .95 .3 .5 2"',
}


def scene(
    folder: Path,
    tendon: str = "",
    actuator: str = "",
    *,
    equality: str = "",
    kind: str = "hinge",
    seed: int = 0,
    contents: str = SCENE,
) -> World:
    """The scene in a random state near that of the file."""
    world = of_file(folder, contents.format(tendon=tendon, actuator=actuator, equality=equality, kind=kind))
    rng = np.random.default_rng(seed)
    for body in world.bodies.values():
        first = body.first_velocity + (6 if body.fixed_base else 0)
        last = body.first_velocity + 6 + sum(body.velocity_count)
        world.velocity[first:last] = rng.uniform(-1.0, 1.0, last - first)
        for joint in body.joints.movable:
            q, count = body.position_index[joint.index], body.position_count[joint.index]
            if count == 4:
                turn = np.array([0.0, 0.0, 0.0, 1.0]) + 0.4 * rng.normal(size=4)
                world.position[q : q + 4] = turn / np.linalg.norm(turn)
            else:
                world.position[q : q + count] = rng.uniform(-0.3, 0.3, count)
        if body.actuators:
            for it in body.actuators:
                it.control = 0.3
    return world


def along(path: str, terms: str = "") -> str:
    """A tendon along a path."""
    return f'<spatial name="t" {terms}>{path}</spatial>'


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("terms", TERMS.values(), ids=TERMS)
@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
def test_tendons_along_paths(tmp_path, path, terms, seed):
    step = assert_exact(scene(tmp_path, along(path, terms), seed=seed), parameters=["masses"])
    (status,) = (it for name, it in statuses(step).items() if "tendon" in name)
    assert status == ["holds"] or "frictionloss" in terms


def test_a_limit_that_yields_for_its_own_inverse_mass(tmp_path):
    world = scene(tmp_path, along(PATHS["sphere by its side"], TERMS["far below"]))
    world.contact_arrays.users.numpy["user_impedance"][:, 3] = 0.0
    assert_exact(world, parameters=["masses", "inertias"])


@pytest.mark.parametrize("name", ["sphere by its side", "cylinder and sphere", "pulley"])
@pytest.mark.parametrize(
    "actuator",
    [
        '<motor name="u" tendon="t" gear="30"/>',
        '<position name="u" tendon="t" kp="600" kv="20"/>',
        '<general name="u" tendon="t" gainprm="40 3 2" gaintype="affine" biastype="affine"'
        ' biasprm="1 3 .5"/>',
        '<general name="u" tendon="t" dyntype="filter" dynprm=".1" gainprm="90"/>',
        '<muscle name="u" tendon="t" lengthrange=".2 1" force="80"/>',
    ],
)
def test_actuators_of_paths(tmp_path, name, actuator):
    world = scene(tmp_path, along(PATHS[name]), actuator)
    for body in world.bodies.values():
        for it in body.actuators:
            if it.spec.dynamics:
                it.activation = 0.4
    step = assert_exact(world, controls=["actuators"], parameters=["masses"])
    assert np.abs(step.B).max() > 0.0


@pytest.mark.parametrize("number", ["0", "2"])
@pytest.mark.parametrize("equality", [True, False])
def test_couplings_of_tendons(tmp_path, number, equality):
    tendons = (
        along(PATHS["sphere by its side"])
        + '<spatial name="s"><site site="post"/><site site="hand"/></spatial>'
    )
    second = 'tendon2="s"' if equality else ""
    text = f'<tendon tendon1="t" {second} polycoef=".02 1.5 {number} -.4 .2"/>'
    step = assert_exact(scene(tmp_path, tendons, equality=text), parameters=["masses"])
    assert [it for name, it in statuses(step).items() if "coupling" in name] == [["holds"]]


def test_the_impedance_of_a_coupling_follows_its_error(tmp_path):
    tendons = (
        along(PATHS["sphere by its side"])
        + '<spatial name="s"><site site="post"/><site site="hand"/></spatial>'
    )
    # It grows over two metres, so that it is steep at any error.
    text = '<tendon tendon1="t" tendon2="s" polycoef=".02 1.5 2 -.4 .2" solimp=".2 .9 2 .5 2"/>'
    assert_exact(scene(tmp_path, tendons, equality=text), parameters=["masses"])


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(
    "transmission",
    [
        'site="hand" gear="3 -1 2 .4 -.2 .3"',
        'site="hand" refsite="post" gear="3 -1 2 .4 -.2 .3"',
        'site="hand" refsite="upper" gear="3 -1 2 .4 -.2 .3"',
        'site="far" gear="3 -1 2 .4 -.2 .3"',
    ],
)
@pytest.mark.parametrize("law", ["motor", "position"])
def test_actuators_of_sites(tmp_path, transmission, law, seed):
    gains = 'kp="30" kv="2"' if law == "position" else ""
    world = scene(tmp_path, actuator=f'<{law} name="u" {transmission} {gains}/>', seed=seed)
    step = assert_exact(world, controls=["actuators"], parameters=["masses"])
    assert np.abs(step.B).max() > 0.0


def test_slider_cranks(tmp_path):
    text = '<{} name="u" slidersite="hand" cranksite="post" cranklength="{}" gear="2" {}/>'
    for length in ("2", ".1"):
        for law, gains in (("motor", ""), ("position", 'kp="30" kv="2"')):
            world = scene(tmp_path, actuator=text.format(law, length, gains))
            step = assert_exact(world, controls=["actuators"])
            assert np.abs(step.B).max() > 0.0


def test_the_angle_of_a_spherical_joint(tmp_path):
    contents = SCENE.replace('name="c" type', 'name="c" limited="true" range="0 .2" type')
    world = scene(tmp_path, kind="ball", contents=contents)
    step = assert_exact(world, parameters=["masses"])
    assert any("tendon" in name for name in statuses(step))


def test_many_worlds_and_steps(tmp_path):
    world = scene(tmp_path, along(KNEE.format(""), TERMS["spring"]), '<motor name="u" tendon="t" gear="30"/>')
    assert_exact(world, controls=["actuators"], steps=3, atol=3e-6)
    lone = world.linearize(["actuators"])
    steps = Worlds(world, 3).linearize(["actuators"])
    assert (steps.A == lone.A).all()


@pytest.mark.parametrize("seed", range(3))
def test_armature_of_a_tendon_on_a_free_body(tmp_path, seed):
    path = '<site site="post"/><site site="far"/>'
    world = scene(tmp_path, along(path, 'armature="2"'), seed=seed)
    assert_exact(world, parameters=["masses"])
    steps = Worlds(world, 2).linearize()
    assert (steps.A[1] == world.linearize().A).all()
