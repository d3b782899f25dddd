"""Every file of the data folder can be dropped on a floor."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

DATA = Path(pybullet_data.getDataPath())
SUFFIXES = {".urdf", ".sdf", ".xml"}
FILES = sorted(str(path.relative_to(DATA)) for path in DATA.rglob("*") if path.suffix in SUFFIXES)


def loaded(file: str) -> tuple[int, ...]:
    path = str(DATA / file)
    if file.endswith(".sdf"):
        return p.loadSDF(path)
    if file.endswith(".xml"):
        return p.loadMJCF(path)
    return (p.loadURDF(path, [0, 0, 1]),)


@pytest.mark.parametrize("file", FILES)
def test_it_falls_and_touches_without_trouble(file: str) -> None:
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -9.81)
        p.loadURDF(str(DATA / "plane.urdf"))
        bodies = loaded(file)
        for _ in range(120):
            p.stepSimulation()
        for body in bodies:
            velocity, spin = p.getBaseVelocity(body)
            assert max(map(abs, velocity)) < 6.0
            assert math.isfinite(sum(spin))
    finally:
        p.disconnect(client)


@pytest.mark.parametrize("file", ["tray/tray.urdf", "tray/traybox.urdf"])
def test_things_lie_in_a_tray(file: str) -> None:
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -9.81)
        p.loadURDF(str(DATA / file), useFixedBase=True)
        cube = p.loadURDF(str(DATA / "cube_small.urdf"), [0.05, 0.05, 0.1])
        for _ in range(240):
            p.stepSimulation()
        assert p.getBasePositionAndOrientation(cube)[0] == pytest.approx((0.05, 0.05, 0.032), abs=0.01)
    finally:
        p.disconnect(client)
