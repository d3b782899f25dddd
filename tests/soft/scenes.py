"""What tests of soft bodies put into worlds."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from carom import World
from carom.description import Collision, ContactParameters, Geometry
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.inertia import inertia_from_shapes
from carom.scene.body import Body
from carom.scene.soft_body import SoftBody
from carom.soft.shapes import box, grid

GRAVITY = 10.0


def world(gravity: float = GRAVITY) -> World:
    """An empty world."""
    result = World()
    result.gravity = (0.0, 0.0, -gravity)
    return result


def rigid(
    where: World,
    shape: Geometry,
    mass: float = 0.0,
    position: tuple[float, float, float] = (0.0, 0.0, 0.0),
    friction: float = 0.5,
) -> Body:
    """A rigid body without damping; massless ones are fixed."""
    contact = ContactParameters(lateral_friction=friction)
    base = LinkSpec("base", mass=mass, collisions=(Collision(shape),), contact=contact)
    if mass > 0.0:
        base.inertia = inertia_from_shapes(base, implicit_cylinder=True)
    flags = int(LoadFlags.USE_IMPLICIT_CYLINDER)
    body = where.load(BodySpec("rigid", base, fixed_base=mass == 0.0, flags=flags), position)
    body.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0)
    return body


def momentum(soft: SoftBody) -> np.ndarray:
    """Momentum of all nodes [N s]."""
    return soft.soft_spec.masses @ soft.node_velocities


def kinetic_energy(soft: SoftBody) -> float:
    """Of all nodes [J]."""
    return float(0.5 * soft.soft_spec.masses @ (soft.node_velocities**2).sum(axis=1))


def spring_energy(soft: SoftBody) -> float:
    """What is in all springs [J]."""
    spec = soft.soft_spec
    length = np.linalg.norm(soft.nodes[spec.springs[:, 1]] - soft.nodes[spec.springs[:, 0]], axis=1)
    return float(0.5 * spec.spring_terms[:, 1] @ (length - spec.spring_terms[:, 0]) ** 2)


def obj_text(vertices: np.ndarray, triangles: np.ndarray) -> str:
    """An OBJ file."""
    lines = [f"v {x} {y} {z}" for x, y, z in vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles.tolist()]
    return "\n".join(lines) + "\n"


def vtk_text(points: np.ndarray, tetras: np.ndarray) -> str:
    """A VTK file."""
    lines = ["# vtk DataFile Version 2.0", "tetrahedra", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(points)} double", *(f"{x} {y} {z}" for x, y, z in points.tolist())]
    lines += [f"CELLS {len(tetras)} {5 * len(tetras)}"]
    lines += [f"4 {a} {b} {c} {d}" for a, b, c, d in tetras.tolist()]
    lines += [f"CELL_TYPES {len(tetras)}", *["10"] * len(tetras)]
    return "\n".join(lines) + "\n"


def write_grid(path: Path, side: int, size: float = 1.0) -> Path:
    """An OBJ file with a square of so many nodes along each side."""
    path.write_text(obj_text(*grid((size, size), (side - 1, side - 1))))
    return path


def write_cube(path: Path, cells: int, size: float = 0.4) -> Path:
    """A VTK file with a cube of so many cells along each edge."""
    path.write_text(vtk_text(*box((size, size, size), (cells, cells, cells))))
    return path
