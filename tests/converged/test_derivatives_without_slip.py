"""Derivatives of steps with passes without slip, beside central differences of these steps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.converged.yielding_scenes import WITHOUT_SLIP

from carom import World, Worlds
from carom.linearization import LinearizedStep, linearized_step

_FRICTION = "friction of contact"
# A limb with dry friction, and damping that some integrators have implicitly.
_DAMPED = WITHOUT_SLIP["limb, pyramidal, condim 3, no slip"].replace(
    'frictionloss=".3"', 'frictionloss=".3" damping=".2" armature=".01"'
)


def _moving(text: str, folder: Path, seed: int, steps: int) -> World:
    path = folder / "scene.xml"
    path.write_text(text)
    world = World(contact="compliant")
    world.load(path).apply_options()
    world.parameters.contact_warm_starting = 0.0
    world.apply_parameters()
    rng = np.random.default_rng(seed)
    for body in world.bodies.values():
        first = body.first_velocity + (6 if body.fixed_base else 0)
        own = slice(first, body.first_velocity + 6 + sum(body.velocity_count))
        world.velocity[own] += rng.uniform(-0.3, 0.3, own.stop - own.start)
    world.step(steps)
    return world


def _differences(world: World, size: float) -> list[np.ndarray]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(linearized_step, "_SIZE", size)
        near = world.linearize(tight=True, method="differences")
    return [near.A, near.B]


def _error(world: World) -> tuple[LinearizedStep, float]:
    """The exact derivatives, and by how much they differ from differences, relative to the greatest entry.

    Passes find cones to 1e-12 only: where friction turns fast, differences of fourth order with a greater
    size are more precise.
    """
    exact = world.linearize(tight=True, method="exact")
    coarse, finer = _differences(world, 1e-5), _differences(world, 5e-6)
    fourth = [(4.0 * fine - near) / 3.0 for near, fine in zip(coarse, finer, strict=True)]
    return exact, min(_off(exact, _differences(world, 1e-6)), _off(exact, fourth))


def _off(exact: LinearizedStep, near: list[np.ndarray]) -> float:
    pairs = zip((exact.A, exact.B), near, strict=True)
    return max(float(np.abs(own - other).max() / np.abs(other).max()) for own, other in pairs if own.size)


@pytest.mark.parametrize("name", [it for it in WITHOUT_SLIP if not it.startswith("box")])
@pytest.mark.parametrize("seed", [0, 1])
def test_derivatives_are_those_of_passes_that_have_ended(name: str, seed: int, tmp_path: Path) -> None:
    exact, error = _error(_moving(WITHOUT_SLIP[name], tmp_path, seed, 30 + 20 * seed))
    assert error < (2e-5 if "elliptic, condim 6" in name else 2e-6)
    assert exact.method == "exact"
    assert any(row.startswith(_FRICTION) for row, _ in exact.rows)


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize("condim", [3, 4, 6])
def test_a_box_that_slides_has_them(cone: str, condim: int, tmp_path: Path) -> None:
    world = _moving(WITHOUT_SLIP[f"box, {cone}, condim {condim}, no slip"], tmp_path, 0, 30)
    exact, error = _error(world)
    assert error < 2e-6
    status = {status for row, status in exact.rows if row.startswith(_FRICTION)}
    assert status == {"slides"}


def test_passes_change_derivatives(tmp_path: Path) -> None:
    world = _moving(WITHOUT_SLIP["limb, pyramidal, condim 3, no slip"], tmp_path, 0, 30)
    exact = world.linearize(tight=True, method="exact")
    assert {"slides", "holds"} == {status for row, status in exact.rows if row.startswith(_FRICTION)}
    world.change_parameters(noslip_iterations=0)
    without = world.linearize(tight=True, method="exact")
    assert np.abs(exact.A - without.A).max() > 1e-2


@pytest.mark.parametrize("integrator", ["euler", "implicitfast", "implicit", "explicit", "discrete"])
def test_integrators_end_such_steps(integrator: str, tmp_path: Path) -> None:
    world = _moving(_DAMPED, tmp_path, 0, 30)
    world.change_parameters(integrator=integrator)
    world.step(3)
    assert _error(world)[1] < 2e-6


def test_derivatives_go_backwards(tmp_path: Path) -> None:
    world = _moving(WITHOUT_SLIP["limb, elliptic, condim 3, no slip"], tmp_path, 0, 30)
    exact = world.linearize(method="exact", steps=3)
    cotangent = np.arange(1.0, 1.0 + len(exact.states))
    by_state, by_controls, _ = world.step_vjp(cotangent, controls=["torques"], steps=3)
    assert by_state == pytest.approx(cotangent @ exact.A, rel=1e-9, abs=1e-9)
    assert by_controls == pytest.approx(cotangent @ exact.B, rel=1e-9, abs=1e-9)


def test_passes_that_have_not_ended_are_refused(tmp_path: Path) -> None:
    text = WITHOUT_SLIP["spheres, elliptic, condim 3, no slip"].replace("1000", "1")
    world = _moving(text, tmp_path, 0, 30)
    with pytest.raises(
        NotImplementedError, match="the 1 passes of noslip_iterations have not ended at a solution"
    ):
        world.linearize(method="exact")
    assert world.linearize().method == "differences"


def test_parameters_and_worlds_are_refused(tmp_path: Path) -> None:
    world = _moving(WITHOUT_SLIP["limb, pyramidal, condim 3, no slip"], tmp_path, 0, 30)
    with pytest.raises(
        NotImplementedError, match="derivatives by masses are not exact with noslip_iterations"
    ):
        world.linearize(parameters=["masses"], method="exact")
    with pytest.raises(NotImplementedError, match="smoothed"):
        world.linearize(smoothing=0.1)
    with pytest.raises(NotImplementedError, match="several worlds with noslip_iterations"):
        Worlds(world, 2).linearize()
