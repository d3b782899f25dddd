"""Every file of the data folder can be dropped on a floor."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from tests.rings import few

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


@pytest.mark.parametrize("file", few(FILES, 30))
def test_it_falls_and_touches_without_trouble(file: str) -> None:
    client = p.connect(p.DIRECT)
    try:
        # Some bodies are soft; rigid ones are the same there.
        p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
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


@pytest.mark.parametrize("file", ["tray/tray.urdf", "tray/traybox.urdf", "tray/tray_textured2.urdf"])
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


@pytest.mark.parametrize(
    ("file", "start", "rest"),
    [
        ("objects/mug_col.obj", (0.0, 0.0, 0.15), (0.0, 0.0, 0.017)),
        ("toys/concave_box.urdf", (0.3, 0.2, 0.3), (0.3, 0.2, 0.01)),
    ],
)
def test_a_ball_goes_into_what_is_hollow(
    file: str, start: tuple[float, ...], rest: tuple[float, ...]
) -> None:
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -9.81)
        if file.endswith(".urdf"):
            p.loadURDF(str(DATA / file))
        else:
            p.createMultiBody(0.0, p.createCollisionShape(p.GEOM_MESH, fileName=str(DATA / file)))
        ball = p.createMultiBody(0.1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.01), -1, start)
        for _ in range(240):
            p.stepSimulation()
        assert p.getBasePositionAndOrientation(ball)[0] == pytest.approx(rest, abs=0.015)
    finally:
        p.disconnect(client)


@pytest.mark.parametrize("file", ["duck.obj", "duck.dae"])
def test_the_duck_is_as_large_in_either_format(file: str) -> None:
    client = p.connect(p.DIRECT)
    try:
        duck = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_MESH, fileName=str(DATA / file)))
        low, high = p.getAABB(duck)
        assert low == pytest.approx((-1.011, 0.053, -0.636), abs=2e-3)
        assert high == pytest.approx((0.746, 1.68, 0.713), abs=2e-3)
    finally:
        p.disconnect(client)


def test_fingers_in_stl_files_span_the_bounds_of_the_originals() -> None:
    client = p.connect(p.DIRECT)
    try:
        finger = p.createCollisionShape(p.GEOM_MESH, fileName=str(DATA / "l_finger.stl"))
        low, high = p.getAABB(p.createMultiBody(1.0, finger))
        assert low == pytest.approx((-0.0092, -0.009, -0.0278), abs=3e-3)
        assert high == pytest.approx((0.0954, 0.0458, 0.0278), abs=3e-3)
    finally:
        p.disconnect(client)


@pytest.mark.parametrize("name", ["ground0.txt", "ground1.txt", "ground2.txt", "Maze.png", "Image8x4.png"])
def test_height_maps_are_grounds_to_roll_on(name: str) -> None:
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -9.81)
        field = p.createCollisionShape(
            p.GEOM_HEIGHTFIELD, meshScale=[0.5, 0.5, 0.5], fileName=str(DATA / "heightmaps" / name)
        )
        ground = p.createMultiBody(0.0, field)
        top = p.getAABB(ground)[1][2]
        ball = p.createMultiBody(
            1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.3), -1, (0.2, 0.2, top + 0.5)
        )
        for _ in range(240):
            p.stepSimulation()
        assert p.getBasePositionAndOrientation(ball)[0][2] > -top
        assert p.getContactPoints(ball, ground)
    finally:
        p.disconnect(client)


@pytest.mark.parametrize(
    ("name", "height", "half"),
    [
        ("wm_height_out.png", 0.4392, 0.992 / 2),
        ("Maze.png", 0.0, 0.5),
        ("ground0.txt", 4.504, 5.008),
        ("ground1.txt", 6.008, 4.63),
        ("ground2.txt", 3.003, 4.771),
    ],
)
def test_robots_can_be_put_in_the_middle_of_a_height_map(name: str, height: float, half: float) -> None:
    """Reach and height in the middle are the originals'; scripts know from which height to start."""
    client = p.connect(p.DIRECT)
    try:
        field = p.createCollisionShape(p.GEOM_HEIGHTFIELD, fileName=str(DATA / "heightmaps" / name))
        ground = p.createMultiBody(0.0, field)
        assert p.getAABB(ground)[1][2] == pytest.approx(half, abs=0.01)
        for x, y in ((0.0, 0.0), (0.3, 0.2), (-0.4, 0.3)):
            hit = p.rayTest((x, y, 10), (x, y, -10))[0]
            assert hit[0] == ground
            assert hit[3][2] + half == pytest.approx(height, abs=0.02)
    finally:
        p.disconnect(client)


def test_the_middle_of_a_cubes_face_has_the_colour_it_is_given() -> None:
    """Like the original's, whose picture is white there: scripts look for the colours they gave."""
    client = p.connect(p.DIRECT)
    try:
        cube = p.loadURDF(str(DATA / "cube.urdf"))
        bare = p.createMultiBody(0, -1, p.createVisualShape(p.GEOM_BOX, halfExtents=[0.5] * 3), [4, 0, 0])
        view = p.computeProjectionMatrixFOV(30, 1, 0.01, 10)
        images = []
        for body, x in ((cube, 0), (bare, 4)):
            p.changeVisualShape(body, -1, rgbaColor=[1, 0.5, 0, 1])
            eye = p.computeViewMatrix([x, -0.7, 0], [x, 0, 0], [0, 0, 1])
            images.append(p.getCameraImage(16, 16, eye, view)[2])
        assert (images[0] == images[1]).all()
    finally:
        p.disconnect(client)
