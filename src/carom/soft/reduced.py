"""Reduced deformable bodies, simulated as full solids with the stiffness of their modes.

Bullet simulates such bodies by a few modes of vibration, which it reads from files beside the mesh. Here all
nodes move, so only the stiffness of the material is taken from these files.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.files.unpacking import appears
from carom.native.products import determinants, inverses, product
from carom.soft.materials import NeoHookean

if TYPE_CHECKING:
    from carom.description.deformable import Deformable

POISSONS_RATIO = 0.3
"""Poisson's ratio of the material, which is not in the files."""
MODULUS = 100.0
"""Young's modulus for each unit of stiffness if there are no files of modes [Pa]."""

# Number of modes used: the lowest ones describe the whole shape best, and depend least on single cells.
_MODES = 10


def solid_of_modes(soft: Deformable) -> NeoHookean:
    """The material of a reduced body.

    With its Young's modulus the lowest modes in `modes.bin` have the strain energy that `K_r_diag_mat.bin`
    specifies. The modulus is then multiplied by the scale of stiffness, and by the ratio of the body's mass
    to that in `M_diag_mat.bin`, so that the mass does not change the frequencies.

    Raises:
        DescriptionError: The mesh or a file of modes cannot be used.
    """
    assert soft.stiffness_scale is not None
    folder = soft.visual.parent
    names = ("K_r_diag_mat.bin", "modes.bin", "M_diag_mat.bin")
    paths = [folder / name for name in names]
    modulus = MODULUS
    if all(appears(path) or path.is_file() for path in paths):
        stiffness, modes, masses = (_numbers(path) for path in paths)
        modulus = _modulus(soft.simulated or soft.visual, stiffness, modes)
        modulus *= soft.mass / float(masses.sum())
    return NeoHookean.of(modulus * soft.stiffness_scale, POISSONS_RATIO, soft.mode_damping)


def _numbers(path: Path) -> NDArray[np.float64]:
    """A count in 32 bits, followed by at least as many doubles."""
    data, _ = read_bounded(path)
    count = int(np.frombuffer(data[:4], "<u4")[0]) if len(data) >= 4 else 0
    if not count or len(data) < 4 + 8 * count:
        raise DescriptionError("it is truncated, or not a file of modes", file=path)
    numbers = np.frombuffer(data, "<f8", count, 4)
    if not np.isfinite(numbers).all():
        raise DescriptionError("a number is not finite", file=path)
    return numbers


def _modulus(mesh: Path, stiffness: NDArray[np.float64], modes: NDArray[np.float64]) -> float:
    from carom.soft.files import mesh_of

    nodes, tetras = mesh_of(mesh)
    if tetras.shape[1] != 4:
        raise DescriptionError("reduced deformable bodies are made of tetrahedra, in VTK files", file=mesh)
    count = min(_MODES, len(stiffness), len(modes) // max(1, nodes.size))
    if not count:
        raise DescriptionError("its modes belong to another mesh", file=mesh)
    edges = np.swapaxes(nodes[tetras][:, 1:] - nodes[tetras][:, :1], 1, 2)
    volume = np.abs(determinants(edges)) / 6.0
    if not volume.min() > 0.0:
        raise DescriptionError(f"tetrahedron {int(volume.argmin())} has no volume", file=mesh)
    inverse = inverses(edges)
    # Lamé parameters of a solid with a Young's modulus of 1 Pa.
    shear = 0.5 / (1.0 + POISSONS_RATIO)
    first = 2.0 * shear * POISSONS_RATIO / (1.0 - 2.0 * POISSONS_RATIO)
    energy = 0.0
    for mode in modes[: count * nodes.size].reshape(count, -1, 3):
        gradient = product(np.swapaxes(mode[tetras][:, 1:] - mode[tetras][:, :1], 1, 2), inverse)
        strain = 0.5 * (gradient + np.swapaxes(gradient, 1, 2))
        traces = np.trace(strain, axis1=1, axis2=2)
        energy += float((volume * (2.0 * shear * (strain**2).sum(axis=(1, 2)) + first * traces**2)).sum())
    if not (energy > 0.0 and stiffness[:count].min() >= 0.0):
        raise DescriptionError("its modes do not deform it, or have negative stiffness", file=mesh)
    return float(stiffness[:count].sum()) / energy
