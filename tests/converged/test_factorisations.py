"""How many factorisations the converged laws take: what takes more of them takes more time."""

from __future__ import annotations

import numpy as np
import pytest
from tests.converged.rigid_worlds import rigid_world, tower
from tests.converged.yielding_scenes import SCENES

from carom import World


def _factorisations(world: World, steps: int) -> list[int]:
    """Those of each step, of all islands together."""
    counts: list[int] = []
    for _ in range(steps):
        world.step()
        counts.append(sum(int(island["numIterationsUsed"]) for island in world.analytics()))
    return counts


def test_a_tower_at_rest_takes_one_a_step() -> None:
    world = rigid_world()
    tower(world, 10)
    counts = _factorisations(world, 120)
    # In the first step all contacts are new.
    assert counts[0] <= 40
    assert set(counts[1:]) == {1}


def test_a_box_that_slides_takes_two_a_step() -> None:
    world = rigid_world(np.arctan(0.6))
    world.add_plane(friction=1.0)
    world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=0.5)
    assert max(_factorisations(world, 120)) <= 2


@pytest.mark.parametrize(("kind", "most"), [("boxes", 12500), ("balls", 10500)])
def test_a_heap_that_falls_takes_few(kind: str, most: int) -> None:
    world = rigid_world()
    world.add_plane()
    for i in range(12):
        place = (0.07 * (i % 3), 0.05 * (i % 2), 0.15 + 0.25 * i)
        if kind == "boxes":
            world.add_box((0.1, 0.1, 0.1), place)
        else:
            world.add_sphere(0.1, place)
    assert sum(_factorisations(world, 480)) <= most


@pytest.mark.parametrize(
    ("scene", "most"),
    [
        ("spheres, elliptic, condim 3, impratio 1.0", 240),
        ("spheres, pyramidal, condim 3, impratio 1.0", 235),
        ("box, pyramidal, condim 3, impratio 1.0", 120),
        ("limb, pyramidal, condim 6, impratio 1.0", 40),
    ],
)
def test_contacts_that_yield_take_about_one_a_step(scene: str, most: int, tmp_path) -> None:
    file = tmp_path / "scene.xml"
    file.write_text(SCENES[scene])
    world = World(contact="compliant")
    world.load_mjcf(file)
    assert sum(_factorisations(world, 200)) <= most
