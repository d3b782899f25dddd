"""Derivatives of rows of connects and welds that turn with links that move, of which J̇ v is a part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.converged.turning_scenes import SCENES
from tests.linearization.scenes import assert_exact, statuses

from carom import World, Worlds
from carom.linearization import linearized_step

_CHAIN = """<mujoco><option timestep="0.002"><flag contact="disable"/></option><worldbody>
<body name="a" pos="0 0 1">{base}<geom type="box" size=".1 .05 .02" mass="1"/>
<body name="b" pos="0.2 0 0"><joint axis="0 1 0" pos="-.1 0 0"/>
<geom type="box" size=".1 .03 .02" mass=".5"/>
<body name="c" pos="0.2 0 0"><joint type="ball" pos="-.1 0 0"/>
<geom type="box" size=".1 .03 .02" mass=".5"/>
<body name="d" pos="0.2 0.1 0"><joint type="slide" axis="1 .3 0" pos="-.1 0 0"/>
<joint axis="0 0.3 1" pos="-.1 0 0"/><geom type="box" size=".1 .03 .02" mass=".5"/></body></body></body>
</body>
<body name="t" pos="0.7 0.3 1"><freejoint/><geom type="box" size=".05 .1 .2" mass="2"/></body></worldbody>
<equality>{held}</equality></mujoco>"""
_BASES = {"free": "<freejoint/>", "fixed": "", "turning": '<joint axis="1 1 0"/>'}
_HELD = {
    "world": '<connect body1="d" anchor=".05 .1 .02"/>',
    "another": '<connect body1="d" body2="t" anchor=".05 .1 .02"/>',
    "itself": '<connect body1="a" body2="d" anchor=".5 .1 .02"/>',
    "world, welded": '<weld body1="d"/>',
    "another, welded": '<weld body1="t" body2="d"/>',
    "itself, welded": '<weld body1="d" body2="a"/>',
}
_INTEGRATORS = "euler", "discrete", "implicitfast", "implicit", "rk4"


@pytest.fixture(autouse=True)
def _larger_differences(monkeypatch: pytest.MonkeyPatch) -> None:  # pyright: ignore[reportUnusedFunction]
    """The solver ends at a precision that smaller ones would show."""
    monkeypatch.setattr(linearized_step, "_SIZE", 1e-5)


def moving(folder: Path, text: str, integrator: str = "euler") -> World:
    """A world of a file whose dofs have random velocities, some steps later."""
    (folder / "scene.xml").write_text(text)
    world = World(contact="compliant")
    world.load(folder / "scene.xml").apply_options()
    world.integrator = integrator
    rng = np.random.default_rng(3)
    for body in world.bodies.values():
        first = body.first_velocity + (6 if body.fixed_base else 0)
        count = sum(body.velocity_count) + (0 if body.fixed_base else 6)
        world.velocity[first : first + count] = rng.uniform(-2.0, 2.0, count)
    world.step(7)
    return world


@pytest.mark.parametrize("integrator", _INTEGRATORS)
@pytest.mark.parametrize("name", [it for it in SCENES if "capsule" not in it])
def test_free_bodies_that_are_held(name: str, integrator: str, tmp_path: Path) -> None:
    step = assert_exact(moving(tmp_path, SCENES[name], integrator))
    assert any("constraint" in it for it in statuses(step))


@pytest.mark.parametrize("held", _HELD)
@pytest.mark.parametrize("base", _BASES)
def test_chains_that_are_held(base: str, held: str, tmp_path: Path) -> None:
    world = moving(tmp_path, _CHAIN.format(base=_BASES[base], held=_HELD[held]))
    step = assert_exact(world, controls=["torques"], parameters=["masses"])
    assert not step.measured


@pytest.mark.parametrize("integrator", _INTEGRATORS)
def test_all_integrators_have_them(integrator: str, tmp_path: Path) -> None:
    text = _CHAIN.format(base=_BASES["free"], held=_HELD["another, welded"])
    assert_exact(moving(tmp_path, text, integrator))


def test_many_worlds_and_cotangents(tmp_path: Path) -> None:
    world = moving(tmp_path, SCENES["weld of two"])
    worlds = Worlds(world, 3, threads=1)
    worlds.step(5)
    found = worlds.linearize()
    for number in range(3):
        np.testing.assert_array_equal(found.A[number], worlds.extract(number).linearize(method="exact").A)
    given = np.random.default_rng(1).normal(size=len(found.states))
    np.testing.assert_allclose(worlds.step_vjp(np.tile(given, (3, 1)))[0][1], given @ found.A[1], atol=1e-9)
    world.step(5)
    exact = world.linearize(method="exact").A
    np.testing.assert_allclose(world.step_vjp(given)[0], given @ exact, atol=1e-9)


def test_a_fixed_base_with_a_velocity_is_refused(tmp_path: Path) -> None:
    world = moving(tmp_path, _CHAIN.format(base="", held=_HELD["another"]))
    body = next(it for it in world.bodies.values() if it.fixed_base and it.joint_count)
    world.velocity[body.first_velocity + 3] = 0.1
    with pytest.raises(NotImplementedError, match=r'constraint 0 holds a fixed base.*method="differences"'):
        world.linearize(method="exact")
