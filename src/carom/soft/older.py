"""Cloth as in PyBullet without a deformable world: it hardly stretches, whatever its mass."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.model.body_spec import BodySpec
from carom.soft.build import soft_body
from carom.soft.files import is_solid, mesh_of
from carom.soft.materials import Springs
from carom.soft.texture_mapping import mapping_of_file

# Angular frequency of one node on a spring [rad/s]. Bullet projects the springs of such cloth 20 times in a
# step, whatever its mass. With this frequency, 1 m of cloth that hangs from an edge stretches by 0.1 mm;
# PyBullet's stretches by 0.05 mm.
_FREQUENCY = 720.0
# Bullet's friction coefficient for such cloth.
_FRICTION = 0.5
# Damping of a spring, divided by the product of node mass and frequency.
_DAMPING = 0.05


def older_cloth_from_file(path: Path, *, scale: float, mass: float, margin: float) -> BodySpec:
    """The cloth of an OBJ file; its stiffness, along edges and against bending, is proportional to its mass.

    The arguments are those of `soft_body_from_file`.

    Raises:
        DescriptionError: The file is missing or damaged, holds tetrahedra, or its mesh cannot be used.
    """
    if is_solid(path):
        raise DescriptionError(
            "it holds tetrahedra: call resetSimulation(RESET_USE_DEFORMABLE_WORLD) first", file=path
        )
    nodes, triangles = mesh_of(path)
    node_mass = mass / len(nodes) if len(nodes) else mass
    stiffness = node_mass * _FREQUENCY**2
    springs = Springs(stiffness, _DAMPING * node_mass * _FREQUENCY, stiffness)
    return soft_body(
        path.stem,
        nodes * scale,
        triangles,
        mass=mass,
        springs=springs,
        margin=margin,
        friction=_FRICTION,
        textured=mapping_of_file(path, nodes, triangles),
        source=path,
    )
