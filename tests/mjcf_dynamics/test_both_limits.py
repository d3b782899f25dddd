"""Both limits of a joint or tendon act at once where their margins overlap, as in MuJoCo.

The numbers are those of `mujoco` 4.0, of the joint and of the tendon: velocities after one step and
after 20, and positions then.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from carom import World, Worlds

FILE = """<mujoco><option timestep="0.002" gravity="0 0 0"/><worldbody><body name="a">
<joint name="j" axis="0 1 0" range="{range}" limited="true" margin="{margin}" {soft}/>
<geom size=".05" pos="0 0 -.3" mass="1"/></body><body name="b" pos="0 3 0">
<joint name="k" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body></worldbody>
<tendon><fixed name="t" range="{range}" limited="true" margin="{margin}" {friction} {soft}><joint joint="k"
 coef="1"/></fixed></tendon><keyframe><key qpos="{at} {at}" qvel="{rate} {rate}"/></keyframe></mujoco>"""
CASES: dict[str, tuple[dict[str, str], list[float], list[float], list[float]]] = {
    "in the middle": (
        {"range": "-.05 .05", "margin": ".1", "at": "0", "rate": "1"},
        [0.79487179, 0.79487179],
        [-0.10899831, -0.10899831],
        [0.0040071022, 0.0040071022],
    ),
    "wide": (
        {"range": "-.5 .5", "margin": "1", "at": ".03", "rate": "-1"},
        [-0.94871795, -0.94871795],
        [-0.27878577, -0.27878577],
        [0.0074587437, 0.0074587437],
    ),
    "soft": (
        {
            "range": "-.05 .05",
            "margin": ".08",
            "at": "-.045",
            "rate": "2",
            "soft": 'solreflimit=".05 .7" solimplimit=".5 .9 .1"',
        },
        [2.009414, 2.0],
        [0.48551126, 0.71838546],
        [0.013082075, 0.012371116],
    ),
    "beyond one": (
        {
            "range": "-.05 .05",
            "margin": ".2",
            "at": ".06",
            "rate": "0",
            "soft": 'solreflimit=".05 .7" solimplimit=".5 .9 .1"',
        },
        [-0.10311493, -0.11457788],
        [-0.79881807, -0.80236292],
        [0.035862538, 0.034889243],
    ),
    "one after the other": (
        {"range": "-.05 .05", "margin": ".06", "at": ".03", "rate": "-1"},
        [-0.94871795, -1.0],
        [-0.27878577, -0.17527485],
        [0.0074587437, 0.0010497772],
    ),
    "not at once": (
        {"range": "-.05 .05", "margin": ".02", "at": "-.045", "rate": "2"},
        [2.0, 2.0],
        [0.1453444, 1.595],
        [0.00085254192, 0.03419],
    ),
}


def load(world, folder, name, friction=""):
    given = {"soft": "", "friction": friction, **CASES[name][0]}
    (folder / "file.xml").write_text(FILE.format(**given))
    scene = world.load(folder / "file.xml")
    assert not scene.ignored.that_matter
    scene.apply_options()
    scene.reset("0")
    world.parameters.solver_residual_threshold = 0.0
    world.parameters.solver_iterations = 1000
    world.apply_parameters()
    return scene


def velocities(scene):
    return [scene[name].joints[0].velocity for name in "ab"]


@pytest.mark.parametrize("name", CASES)
def test_motion_is_that_of_mujoco(tmp_path, name):
    _, first, last, positions = CASES[name]
    with World() as world:
        scene = load(world, tmp_path, name)
        worlds = Worlds(world, 9)
        world.step()
        assert_allclose(velocities(scene), first, atol=1e-6)
        world.step(19)
        assert_allclose(velocities(scene), last, atol=1e-6)
        assert_allclose([scene[it].joints[0].position for it in "ab"], positions, atol=1e-7)
        worlds.step(20)
        assert_array_equal(worlds[scene["b"]].joints.velocities, np.tile(velocities(scene)[1], (9, 1)))


def test_the_force_of_a_limit_is_what_both_leave(tmp_path):
    with World() as world:
        scene = load(world, tmp_path, "in the middle")
        tendon = scene.tendons["t"]
        for _ in range(5):
            before = velocities(scene)[1]
            world.step()
            change = (velocities(scene)[1] - before) / 0.002
            assert abs(change) > 1.0
            assert tendon.force == pytest.approx(change, rel=1e-9)
            assert tendon.limit_force == pytest.approx(abs(change), rel=1e-6)


def test_tendons_keep_their_margin_when_they_are_changed(tmp_path):
    found = []
    for stated in (True, False):
        with World() as world:
            text = 'frictionloss="3"' if stated else ""
            scene = load(world, tmp_path, "in the middle", text)
            tendon = scene.tendons["t"]
            if not stated:
                tendon.friction = 3.0
                tendon.range = (-0.05, 0.05)
            world.step(20)
            found.append(velocities(scene)[1])
    assert found[0] == found[1]
    # Friction of tendons does not yield here, so this is not quite what `mujoco` has.
    assert found[0] == pytest.approx(-0.10856834, abs=1e-3)


@pytest.mark.parametrize("name", ["soft", "not at once"])
def test_derivatives_are_exact_of_tendons_and_joints(tmp_path, name):
    with World() as world:
        load(world, tmp_path, name)
        exact, close = (world.linearize(method=it) for it in ("exact", "differences"))
        assert_allclose(exact.A, close.A, atol=1e-6)
