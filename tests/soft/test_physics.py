"""Soft bodies on their own feet: what statics, mechanics and conservation laws say of them."""

from __future__ import annotations

from math import sinh, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from tests.soft.scenes import GRAVITY, kinetic_energy, momentum, spring_energy, world

from carom.scene.soft_body import SoftBody
from carom.soft.build import soft_body
from carom.soft.materials import NeoHookean, Springs
from carom.soft.shapes import box


def settled(soft: SoftBody, seconds: float = 4.0) -> SoftBody:
    """The body after a while in air that slows it."""
    for _ in range(round(240 * seconds)):
        soft.world.step()
        soft.node_velocities[:] *= 0.98
    return soft


def test_free_fall() -> None:
    soft = world().load_cloth(cells=(3, 3), position=(0, 0, 5))
    soft.world.step(240)
    # Small steps are closer to the parabola than one of 1/240 s would be.
    assert soft.nodes[:, 2] == pytest.approx(5.0 - GRAVITY / 2, abs=0.01)
    assert soft.node_velocities[:, 2] == pytest.approx(-GRAVITY, rel=1e-9)
    assert soft.world.position[2] == pytest.approx(soft.nodes[:, 2].mean())


def test_a_hanging_spring_stretches_by_its_load() -> None:
    rope = world().load_rope(1.0, 1, mass=0.4, stiffness=50.0, damping=0.5)
    rope.set_nodes([[0, 0, 0], [0, 0, -1]])
    rope.anchor(0)
    settled(rope)
    assert rope.nodes[0] == pytest.approx([0, 0, 0], abs=1e-12)
    assert rope.nodes[1, 2] == pytest.approx(-1.0 - 0.2 * GRAVITY / 50.0, abs=1e-4)


def test_a_pendulum_keeps_its_period() -> None:
    length, angle = 0.5, 0.1
    rope = world().load_rope(length, 1, mass=0.2, stiffness=1e4, damping=0.0)
    rope.set_nodes([[0, 0, 0], [length * np.sin(angle), 0, -length * np.cos(angle)]])
    rope.anchor(0)
    crossings, last = [], 1.0
    for step in range(1200):
        rope.world.step()
        x = rope.nodes[1, 0]
        if x < 0.0 <= last:
            crossings.append((step + x / (last - x)) / 240.0)
        last = x
    period = np.diff(crossings)
    assert period == pytest.approx(2 * np.pi * sqrt(length / GRAVITY) * (1 + angle**2 / 16), rel=0.005)


def test_a_rope_hangs_as_a_catenary() -> None:
    rope = world().load_rope(1.0, 40, mass=0.2, stiffness=2e4, damping=2.0)
    u = np.linspace(-1.0, 1.0, 41)
    rope.set_nodes(np.stack([0.4 * u, 0.0 * u, -0.2 * (1 - u**2)], axis=1))
    rope.anchor(0)
    rope.anchor(40)
    settled(rope, 10.0)
    length = np.linalg.norm(np.diff(rope.nodes, axis=0), axis=1).sum()
    a: Any = brentq(lambda a: 2 * a * sinh(0.4 / a) - length, 0.1, 5.0)
    shape = a * np.cosh(rope.nodes[:, 0] / a) - a * np.cosh(0.4 / a)
    assert rope.nodes[:, 2] == pytest.approx(shape, abs=0.005)


@pytest.mark.parametrize("youngs_modulus", [5e3, 5e4])
def test_a_bar_stretches_under_its_own_weight(youngs_modulus: float) -> None:
    where = world()
    bar = where.load_soft_solid(
        (0.1, 0.1, 0.8), (2, 2, 16), youngs_modulus=youngs_modulus, poissons_ratio=0.0, mass=0.8, damping=0.05
    )
    for node in np.flatnonzero(bar.nodes[:, 2] > 0.399):
        bar.anchor(int(node))
    settled(bar)
    # Equal masses of all nodes are a little more at the ends than those of a bar.
    density, stress = 100.0, GRAVITY
    sag = density * stress * 0.8**2 / (2 * youngs_modulus)
    assert -0.4 - bar.nodes[:, 2].min() == pytest.approx(sag, rel=0.05)


def test_a_hung_cube_sags_to_where_its_energy_is_least() -> None:
    nodes, tetras = box((0.4, 0.4, 0.4), (3, 3, 3))
    mu, lam, mass = 400.0, 400.0, 4.0
    where = world()
    cube = where.load(soft_body("cube", nodes, tetras, mass=mass, solid=NeoHookean(mu, lam, 0.1)))
    assert isinstance(cube, SoftBody)
    held = nodes[:, 2] > 0.199
    for node in np.flatnonzero(held):
        cube.anchor(int(node))
    settled(cube)

    edges = np.swapaxes(nodes[tetras][:, 1:] - nodes[tetras][:, :1], 1, 2)
    inverse, volume = np.linalg.inv(edges), np.linalg.det(edges) / 6

    def energy(moved: np.ndarray) -> float:
        x = nodes.copy()
        x[~held] = moved.reshape(-1, 3)
        f = np.swapaxes(x[tetras][:, 1:] - x[tetras][:, :1], 1, 2) @ inverse
        squares, stretch = (f**2).sum(axis=(1, 2)), np.linalg.det(f) - 1 - 0.75 * mu / lam
        elastic = mu / 2 * (squares - 3 - np.log(squares + 1)) + lam / 2 * stretch**2
        return float(volume @ elastic + mass / len(nodes) * GRAVITY * x[~held, 2].sum())

    least = minimize(energy, cube.nodes[~held].ravel(), method="L-BFGS-B", options={"ftol": 1e-14})
    assert cube.nodes[~held].ravel() == pytest.approx(least.x, abs=2e-4)
    # What PyBullet 3.2.7 says of the same cube.
    assert 1.0 + cube.nodes[:, 2].min() == pytest.approx(0.7038, abs=2e-4)


def test_a_pulled_bar_narrows_by_poissons_ratio() -> None:
    where = world(0.0)
    bar = where.load_soft_solid(
        (0.1, 0.1, 0.4), (2, 2, 8), youngs_modulus=1e4, poissons_ratio=0.4, damping=0.05, mass=0.5
    )
    rest = bar.nodes.copy()
    top, bottom = rest[:, 2] > 0.199, rest[:, 2] < -0.199
    for _ in range(1500):
        bar.node_forces[top, 2], bar.node_forces[bottom, 2] = 5.0 / top.sum(), -5.0 / bottom.sum()
        where.step()
    # In the middle, where it does not matter how the ends are pulled.
    upper, lower = np.abs(rest[:, 2] - 0.1) < 1e-9, np.abs(rest[:, 2] + 0.1) < 1e-9
    stretch = (bar.nodes[upper, 2].mean() - bar.nodes[lower, 2].mean()) / 0.2 - 1
    middle = np.abs(rest[:, 2]) < 1e-9
    right, left = middle & (rest[:, 0] > 0.04), middle & (rest[:, 0] < -0.04)
    narrowing = 1 - (bar.nodes[right, 0].mean() - bar.nodes[left, 0].mean()) / 0.1
    assert stretch == pytest.approx(5.0 / 0.01 / 1e4, rel=0.1)
    assert narrowing / stretch == pytest.approx(0.4, rel=0.15)


def test_momentum_is_kept_and_energy_does_not_grow() -> None:
    where = world(0.0)
    cloth = where.load_cloth(cells=(8, 8), stiffness=200.0, bending=5.0, damping=0.0)
    random = np.random.default_rng(1)
    cloth.set_node_velocities(random.normal(0.0, 1.0, cloth.nodes.shape))
    before, first = momentum(cloth), kinetic_energy(cloth)
    energies = []
    for _ in range(20):
        where.step(24)
        energies.append(kinetic_energy(cloth) + spring_energy(cloth))
    assert momentum(cloth) == pytest.approx(before, abs=1e-9)
    assert max(energies) < 1.05 * first


def test_damping_takes_energy_and_no_momentum() -> None:
    where = world(0.0)
    solid = where.load_soft_solid(0.1, 4, damping=0.05)
    solid.set_base_velocity((1.0, 2.0, 3.0), (0.0, 0.0, 5.0))
    energy, start = kinetic_energy(solid), momentum(solid)
    where.step(240)
    assert momentum(solid) == pytest.approx(start, rel=1e-9)
    # It turns on: that is no change of shape.
    assert 0.97 * energy < kinetic_energy(solid) <= energy
    assert where.velocity[solid.first_velocity + 2] == pytest.approx(5.0, rel=0.03)


@pytest.mark.parametrize("cells", [4, 8, 16, 32])
def test_sag_does_not_depend_on_resolution(cells: int) -> None:
    """Springs that are as much stiffer as they are shorter are the same rope."""
    rope = world().load_rope(1.0, cells, mass=0.4, stiffness=40.0 * cells, damping=0.5 * cells)
    rope.set_nodes([[0, 0, -k / cells] for k in range(cells + 1)])
    rope.anchor(0)
    settled(rope, 8.0)
    assert -rope.nodes[:, 2].min() - 1.0 == pytest.approx(0.4 * GRAVITY / 40.0 / 2, rel=0.005)


@pytest.mark.parametrize("stiffness", [1e2, 1e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7, 1e8])
def test_no_stiffness_makes_it_explode(stiffness: float) -> None:
    where = world()
    nodes, tetras = box((0.2, 0.2, 0.2), (2, 2, 2))
    springs = Springs(stiffness, 0.0, stiffness)
    where.load(soft_body("springs", nodes, tetras, mass=0.1, springs=springs))
    solid = soft_body("solid", nodes, tetras, mass=0.1, solid=NeoHookean(stiffness, stiffness))
    where.load(solid, (1.0, 0.0, 0.0))
    where.step(480)
    for body in where.bodies.values():
        assert isinstance(body, SoftBody)
        assert np.abs(body.node_velocities).max() < 25.0


def test_turned_inside_out_it_comes_back() -> None:
    where = world(0.0)
    solid = where.load_soft_solid((0.2, 0.2, 0.2), (2, 2, 2), damping=0.05)
    rest = np.ptp(solid.nodes, axis=0)
    solid.set_nodes(solid.nodes * [1.0, 1.0, 0.0])
    where.step(960)
    assert np.isfinite(solid.nodes).all()
    assert np.abs(solid.node_velocities).max() < 1.0
    assert np.linalg.norm(np.ptp(solid.nodes, axis=0)) == pytest.approx(np.linalg.norm(rest), rel=0.6)
