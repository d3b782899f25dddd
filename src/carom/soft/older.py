"""Cloth as in PyBullet without a deformable world: it hardly stretches, for any mass."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.model.body_spec import BodySpec
from carom.soft.build import soft_body
from carom.soft.files import is_solid, mesh_of
from carom.soft.materials import Springs
from carom.soft.paint import paint_of_file

# Bullet projects the springs of such cloth 20 times in a step, whatever its mass. At this frequency of a
# spring between two nodes, 1 m of cloth that hangs from an edge stretches by 0.1 mm; PyBullet's by 0.05 mm.
_FREQUENCY = 720.0
# Bullet's coefficient for it.
_FRICTION = 0.5
# Share of critical damping of two nodes.
_DAMPING = 0.05


def older_cloth_from_file(path: Path, *, scale: float, mass: float, margin: float) -> BodySpec:
    """The cloth that an OBJ file describes: as stiff along edges and against bending as its mass allows.

    Args:
        path: The file.
        scale: Factor on all lengths.
        mass: Of all nodes together [kg].
        margin: Distance at which nodes rest on other surfaces [m].

    Raises:
        DescriptionError: The file is missing or broken, holds tetrahedra, or its mesh cannot be used.
    """
    if is_solid(path):
        raise DescriptionError(
            "it holds tetrahedra: call resetSimulation(RESET_USE_DEFORMABLE_WORLD) before", file=path
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
        paint=paint_of_file(path, nodes, triangles),
        source=path,
    )
