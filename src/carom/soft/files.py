"""Soft bodies from mesh files: surfaces as cloth, tetrahedra as solids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.meshes.reader import read_mesh
from carom.meshes.vtk import read_vtk
from carom.model.body_spec import BodySpec
from carom.soft.build import soft_body
from carom.soft.materials import NeoHookean, Springs
from carom.soft.texture_mapping import mapping_of_file

SOLIDS = (".vtk",)
SURFACES = (".obj",)

# Angular frequency of one node on a spring of older cloth [rad/s]. Bullet projects the springs of such cloth
# 20 times in a step, whatever its mass. With this frequency, 1 m of cloth that hangs from an edge stretches
# by 0.1 mm; PyBullet's stretches by 0.05 mm.
_OLDER_FREQUENCY = 720.0
# Bullet's friction coefficient for such cloth.
_OLDER_FRICTION = 0.5
# Damping of a spring, divided by the product of node mass and frequency.
_OLDER_DAMPING = 0.05


def is_solid(path: Path) -> bool:
    """Whether files with this suffix contain tetrahedra."""
    return path.suffix.lower() in SOLIDS


def soft_body_from_file(
    path: Path,
    *,
    scale: float = 1.0,
    mass: float = 1.0,
    springs: Springs | None = None,
    solid: NeoHookean | None = None,
    margin: float = 0.02,
    friction: float = 0.0,
    self_collision: bool = False,
    simulated: Path | None = None,
) -> BodySpec:
    """The soft body of a mesh file, `.obj` or `.vtk`; most arguments are those of `soft_body`.

    Only the first object of an OBJ file is used; its triangles are cloth, and `solid` is ignored. `scale` is
    a factor on all lengths. If there is a file with another mesh to simulate, that of `path`, an OBJ file, is
    only drawn.

    Raises:
        DescriptionError: The file is missing, damaged or of another kind, or its mesh cannot be used.
    """
    nodes, cells = mesh_of(path if simulated is None else simulated)
    seen = textured = None
    if simulated is not None:
        part = read_mesh(path)[0]
        seen = part.vertices * scale, part.triangles
        textured = mapping_of_file(path, part.vertices, part.triangles)
    elif not is_solid(path):
        textured = mapping_of_file(path, nodes, cells)
    return soft_body(
        path.stem,
        nodes * scale,
        cells,
        mass=mass,
        springs=springs,
        solid=solid if cells.shape[1] == 4 else None,
        margin=margin,
        friction=friction,
        self_collision=self_collision,
        seen=seen,
        textured=textured,
        source=path,
    )


def older_cloth_from_file(path: Path, *, scale: float, mass: float, margin: float) -> BodySpec:
    """The cloth of an OBJ file as in PyBullet without a deformable world: it hardly stretches.

    Its stiffness, along edges and against bending, is proportional to its mass; the arguments are those of
    `soft_body_from_file`.

    Raises:
        DescriptionError: The file is missing or damaged, holds tetrahedra, or its mesh cannot be used.
    """
    if is_solid(path):
        raise DescriptionError(
            "it holds tetrahedra: call resetSimulation(RESET_USE_DEFORMABLE_WORLD) first", file=path
        )
    nodes, _ = mesh_of(path)
    node_mass = mass / len(nodes) if len(nodes) else mass
    stiffness = node_mass * _OLDER_FREQUENCY**2
    springs = Springs(stiffness, _OLDER_DAMPING * node_mass * _OLDER_FREQUENCY, stiffness)
    return soft_body_from_file(
        path, scale=scale, mass=mass, springs=springs, margin=margin, friction=_OLDER_FRICTION
    )


def mesh_of(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The nodes of a file, and its triangles or tetrahedra; raises `DescriptionError`."""
    suffix = path.suffix.lower()
    if suffix in SOLIDS:
        mesh = read_vtk(path)
        return mesh.points, mesh.tetras
    if suffix in SURFACES:
        part = read_mesh(path)[0]
        return part.vertices, part.triangles
    known = ", ".join((*SURFACES, *SOLIDS))
    raise DescriptionError(f"soft bodies are read from {known} files, not {suffix or 'this'}", file=path)
