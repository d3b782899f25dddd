"""OBJ files of polygons with many corners, as of robots; `record_polygons.py` asks MuJoCo about them."""

from collections.abc import Sequence

import numpy as np


def polygons() -> list[list[list[float]]]:
    """Star-shaped polygons somewhere in space, most of them concave."""
    rng, made = np.random.default_rng(1), []
    for number in range(60):
        count = int(rng.integers(4, 10))
        angles, radii = np.sort(rng.uniform(0.0, 2.0 * np.pi, count)), rng.uniform(0.2, 1.0, count)
        flat = np.stack([radii * np.cos(angles), radii * np.sin(angles), 0.0 * angles], axis=1)
        turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
        if number % 3 == 0:
            turn = np.roll(np.eye(3), number // 3, axis=1)
        points = flat @ turn + rng.uniform(-2.0, 2.0, 3)
        made.append(np.round(points, 1 if number % 5 == 0 else 4).tolist())
    return made


def obj(faces: list[list[list[float]]]) -> str:
    """An OBJ file of polygons."""
    lines, ends, first = [], [], 1
    for face in faces:
        lines += [f"v {x} {y} {z}" for x, y, z in face]
        ends.append("f " + " ".join(str(first + corner) for corner in range(len(face))))
        first += len(face)
    return "\n".join([*lines, *ends]) + "\n"


def prism(base: Sequence[tuple[float, float]], at: float, first: int, name: str) -> str:
    """An object of an OBJ file: a prism of height 1 over a polygon, moved along x."""
    count = len(base)
    lines = [f"o {name}", *(f"v {x + at} {y} {z}" for z in (0.0, 1.0) for x, y in base)]
    low, high = range(first, first + count), range(first + count, first + 2 * count)
    faces = [list(reversed(low)), list(high)]
    for corner in range(count):
        after = (corner + 1) % count
        faces.append([low[corner], low[after], high[after], high[corner]])
    return "\n".join([*lines, *("f " + " ".join(map(str, face)) for face in faces)]) + "\n"


# An arrow, a star and a comb.
_ARROW = [(0.0, 0.0), (1.0, 0.5), (0.0, 1.0), (0.4, 0.5), (-0.3, 0.45)]
_STAR = [(2, 0), (0.5, 0.4), (0, 2), (-0.5, 0.4), (-2, 0), (-0.4, -0.5), (0, -2), (0.4, -0.5)]
_COMB = [(0, 0), (5, 0), (5, 2), (4, 2), (4, 1), (3, 1), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
PRISMS = {
    "arrow": prism(_ARROW, 0.3, 1, "a"),
    "star": prism(_STAR, 3.0, 1, "a"),
    "comb": prism(_COMB, -7.0, 1, "a"),
    "two objects": prism(_STAR, 3.0, 1, "a") + prism(_ARROW, -1.0, 17, "b"),
}
# A box with a point inside, without faces: a cloud of points.
CLOUD = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 2)) + "v 0.5 0.5 0.7\n"
PRISMS["cloud"] = CLOUD
WAYS = ("legacy", "exact", "convex", "shell")


def model(name: str, way: str) -> str:
    """A file with a body whose mass is that of a prism."""
    return (
        f'<mujoco><asset><mesh name="m" file="{name}.obj" inertia="{way}"/></asset><worldbody><body name="b">'
        '<freejoint/><geom type="mesh" mesh="m" density="10"/></body></worldbody></mujoco>'
    )
