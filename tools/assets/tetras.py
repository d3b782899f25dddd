"""Solids of tetrahedra to be soft: balls, rings and cubes, with the size and resolution of Bullet's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.soft.shapes import box, oriented

_DECIMALS = 4


@dataclass(frozen=True, slots=True, eq=False)
class TetraMesh:
    """Tetrahedra.

    Attributes:
        nodes: (n, 3) places [m].
        tetras: (t, 4) nodes.
    """

    nodes: NDArray[np.float64]
    tetras: NDArray[np.int32]

    def text(self) -> str:
        """A legacy VTK file."""
        lines = ["# vtk DataFile Version 2.0", "tetrahedra", "ASCII", "DATASET UNSTRUCTURED_GRID"]
        lines.append(f"POINTS {len(self.nodes)} double")
        # Adding 0 turns -0 into 0.
        for x, y, z in (np.round(self.nodes, _DECIMALS) + 0.0).tolist():
            lines.append(f"{x:g} {y:g} {z:g}")
        lines.append(f"CELLS {len(self.tetras)} {5 * len(self.tetras)}")
        lines += [f"4 {a} {b} {c} {d}" for a, b, c, d in self.tetras.tolist()]
        lines += [f"CELL_TYPES {len(self.tetras)}", *["10"] * len(self.tetras)]
        return "\n".join(lines) + "\n"


def cube(size: float, cells: int) -> TetraMesh:
    """A cube around the origin."""
    return TetraMesh(*box((size, size, size), (cells, cells, cells)))


def ball(radius: float, cells: int) -> TetraMesh:
    """A ball around the origin: a cube of so many cells along each edge, made round.

    The map is that of Nowell (2005), which keeps cells of about the same size throughout.
    """
    nodes, tetras = box((2.0, 2.0, 2.0), (cells, cells, cells))
    x, y, z = (nodes**2).T
    factors = np.stack(
        [1 - (y + z) / 2 + y * z / 3, 1 - (z + x) / 2 + z * x / 3, 1 - (x + y) / 2 + x * y / 3], axis=1
    )
    round_nodes = radius * nodes * np.sqrt(factors)
    return TetraMesh(round_nodes, oriented(round_nodes, tetras))


def rod(radius: float, length: float, cells: int, layers: int) -> TetraMesh:
    """A round rod along the y axis, around the origin: cells across it, layers along it."""
    nodes, tetras = box((2.0, length, 2.0), (cells, layers, cells))
    across = nodes[:, [0, 2]] ** 2
    # A square becomes a disc.
    x = radius * nodes[:, 0] * np.sqrt(1.0 - across[:, 1] / 2.0)
    z = radius * nodes[:, 2] * np.sqrt(1.0 - across[:, 0] / 2.0)
    places = np.stack([x, nodes[:, 1], z], axis=1)
    return TetraMesh(places, oriented(places, tetras))


def torus(radius: float, thickness: float, cells: int, segments: int) -> TetraMesh:
    """A ring around the y axis.

    Args:
        radius: Of the circle in the middle of it [m].
        thickness: Radius of the ring itself [m].
        cells: Cells across it.
        segments: How many around it.
    """
    nodes, tetras = box((2.0, 2.0, 1.0), (cells, cells, segments))
    across, along = nodes[:, :2] ** 2, nodes[:, 2] + 0.5
    # A square becomes a disc.
    x = nodes[:, 0] * np.sqrt(1.0 - across[:, 1] / 2.0)
    y = nodes[:, 1] * np.sqrt(1.0 - across[:, 0] / 2.0)
    reach, angle = radius + thickness * x, 2.0 * np.pi * along
    places = np.stack([reach * np.cos(angle), thickness * y, reach * np.sin(angle)], axis=1)
    # The last layer is the first one.
    count = (cells + 1) ** 2 * segments
    return TetraMesh(places[:count], oriented(places[:count], (tetras % count).astype(np.int32)))


def deformable(name: str, mesh: str, mass: float) -> str:
    """A URDF file with a solid as soft as Bullet's examples have it."""
    return f"""<?xml version="1.0"?>
<robot name="{name}">
  <deformable name="{name}">
    <inertial>
      <mass value="{mass:g}"/>
      <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>
    </inertial>
    <collision_margin value="0.006"/>
    <repulsion_stiffness value="800"/>
    <friction value="0.5"/>
    <neohookean mu="180" lambda="600" damping="0.01"/>
    <visual filename="{mesh}"/>
  </deformable>
</robot>
"""


def reduced(name: str, seen: str, simulated: str | None, stiffness: float, damping: float) -> str:
    """A URDF file with a reduced solid of 10 kg."""
    collision = "" if simulated is None else f'    <collision filename="{simulated}"/>\n'
    return f"""<?xml version="1.0"?>
<robot name="{name}">
  <reduced_deformable name="{name}">
    <num_modes value="20"/>
    <mass value="10"/>
    <stiffness_scale value="{stiffness:g}"/>
    <collision_margin value="0.01"/>
    <erp value="0.2"/>
    <cfm value="0.2"/>
    <friction value="0.5"/>
    <damping_coefficient value="{damping:g}"/>
    <visual filename="{seen}"/>
{collision}  </reduced_deformable>
</robot>
"""


SOLIDS: dict[str, Callable[[], TetraMesh]] = {
    "ball.vtk": lambda: ball(1.0, 7),
    "reduced_cube/cube_mesh.vtk": lambda: cube(1.0, 5),
    "torus.vtk": lambda: torus(0.5, 0.25, 5, 28),
    "tube.vtk": lambda: rod(0.418, 1.2375, 6, 11),
}
"""Tetrahedra by the file they are written to."""
SOFT_ROBOTS: dict[str, Callable[[], str]] = {
    "reduced_cube/deform_cube.urdf": lambda: deformable("cube", "cube_mesh.vtk", 10.0),
    "reduced_cube/reduced_cube.urdf": lambda: reduced("reduced_cube", "cube_mesh.vtk", None, 100.0, 0.0),
    "reduced_torus/reduced_torus.urdf": lambda: reduced(
        "reduced_cube", "../torus/torus_textured.obj", "../torus.vtk", 10.0, 1e-5
    ),
    "torus_deform.urdf": lambda: deformable("torus", "torus.vtk", 3.0),
}
"""Texts of URDF files with soft bodies."""
