"""Pairs of shapes at rest by the rigid law: heights in closed form, and points that stay where they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.converged.masonry import QUADS
from tests.converged.rigid_worlds import rigid_world

from carom import World
from carom.scene.body import Body

SIZE, SIDE = 0.1, 0.2
LYING = (0.5**0.5, 0.0, 0.0, 0.5**0.5)
UPPER: dict[str, Callable[[World, Path, tuple[float, float, float]], Body]] = {
    "sphere": lambda world, _, at: world.add_sphere(SIZE, at),
    "box": lambda world, _, at: world.add_box((SIZE, SIZE, SIZE), at),
    "capsule that lies": lambda world, _, at: world.add_capsule(SIZE, 0.3, at, LYING),
    "cylinder": lambda world, _, at: world.add_cylinder(SIDE, 2.0 * SIZE, at),
    "cylinder that lies": lambda world, _, at: world.add_cylinder(SIZE, SIDE, at, LYING),
    "hull": lambda world, folder, at: world.add_mesh(block(folder, SIDE), at),
}
"""What rests with its centre `SIZE` above what it rests on."""
LOWER: dict[str, Callable[[World, Path], Body]] = {
    "plane": lambda world, _: world.add_plane((0.0, 0.0, SIZE)),
    "box": lambda world, _: world.add_box((1.0, 1.0, SIZE), mass=0.0),
    "hull": lambda world, folder: world.add_mesh(block(folder, 1.0), mass=0.0),
    "triangles": lambda world, folder: world.add_mesh(block(folder, 1.0), mass=0.0, concave=True),
    "heightfield": lambda world, _: world.add_heightfield(np.zeros((9, 9)), (0.25, 0.25), (0.0, 0.0, SIZE)),
    "cylinder": lambda world, _: world.add_cylinder(1.0, 2.0 * SIZE, mass=0.0),
}
"""What has its upper side at the height `SIZE`."""


def block(folder: Path, side: float) -> Path:
    """Write a block that is `2 SIZE` high."""
    corners = [(x, y, z) for x in (-side, side) for y in (-side, side) for z in (-SIZE, SIZE)]
    file = folder / f"block{side}.obj"
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a} {b} {c} {d}" for a, b, c, d in QUADS]
    file.write_text("\n".join(lines) + "\n")
    return file


@pytest.mark.parametrize("below", LOWER)
def test_shapes_rest_at_their_height_and_their_points_stay(tmp_path: Path, below: str) -> None:
    wrong = []
    for above, add in UPPER.items():
        world = rigid_world()
        LOWER[below](world, tmp_path)
        body = add(world, tmp_path, (0.03, 0.02, 2.0 * SIZE))
        world.step(240)
        place, points = np.array(body.pose.position), points_of(world)
        jumps = 0
        for _ in range(60):
            world.step()
            now = points_of(world)
            jumps += now.shape != points.shape or not np.allclose(now, points, atol=1e-6)
        world.step(420)
        drift = np.abs(np.array(body.pose.position) - place).max()
        if abs(place[2] - 2.0 * SIZE) > 1e-6 or drift > 1e-9 or jumps:
            wrong.append(
                f"{above} on {below}: {place[2] - 2.0 * SIZE:.1e} m off, {drift:.1e} m, {jumps} jumps"
            )
    assert not wrong


def points_of(world: World) -> np.ndarray:
    """Where contacts touch, (n, 3) [m], sorted: points of the same depth take turns in the list."""
    return np.array(sorted(contact.point_on_a.round(6).tolist() for contact in world.contacts()))
