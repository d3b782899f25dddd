"""Inertia of bodies from their geoms, and what the compiler's options make of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.description.eigen import principal_axes
from carom.description.pose import IDENTITY, Pose
from carom.description.shapes.moments import MassShape
from carom.description.transform import matrix_product, matrix_vector, rotation_matrix, transposed
from carom.formats.mjcf.compiled.context import Compiler
from carom.native.products import turned_tensor

Matrix = NDArray[np.float64]
_ROUNDING = 1e-12


@dataclass(eq=False, slots=True)
class BodyInertia:
    """Mass and inertia of a body.

    Attributes:
        mass: [kg].
        centre: Centre of mass in the frame of the body [m].
        tensor: (3, 3) inertia about it along the axes of the body [kg m²].
        axes: (3, 3) its principal axes as columns, if the file states them. Of equal moments any would do,
            but not for the box that a fluid sees.
    """

    mass: float
    centre: Matrix
    tensor: Matrix
    axes: Matrix | None = None

    @classmethod
    def none(cls) -> BodyInertia:
        """No mass."""
        return cls(0.0, np.zeros(3), np.zeros((3, 3)))


@dataclass(frozen=True, slots=True)
class GeomMass:
    """Mass of a geom, its distribution, and the pose of its frame in the body."""

    mass: float
    shape: MassShape
    frame: Pose = IDENTITY


def inertia_of(geoms: Iterable[GeomMass], without: BodyInertia) -> BodyInertia:
    """The inertia of all geoms of a body together; `without` if they have no mass."""
    parts = []
    whole = list(geoms)
    for geom in whole:
        turn = rotation_matrix(geom.frame.orientation)
        centre = np.array(geom.frame.position) + np.array(matrix_vector(turn, geom.shape.centre.tolist()))
        turned = matrix_product(matrix_product(turn, geom.shape.tensor.tolist()), transposed(turn))
        parts.append((geom.mass, centre, geom.mass * np.array(turned)))
    mass = sum(part[0] for part in parts)
    if mass == 0.0:
        return without
    axes = np.array(rotation_matrix(whole[0].frame.orientation)) if len(whole) == 1 else None
    if axes is not None and not _is_diagonal(whole[0].shape.tensor):
        axes = None
    middle = np.asarray(sum(m * centre for m, centre, _ in parts)) / mass
    tensor = np.zeros((3, 3))
    for m, centre, own in parts:
        x, y, z = (centre - middle).tolist()
        square = x * x + y * y + z * z
        tensor += own + m * np.array(
            [
                [square - x * x, -x * y, -x * z],
                [-y * x, square - y * y, -y * z],
                [-z * x, -z * y, square - z * z],
            ]
        )
    return BodyInertia(mass, middle, tensor, axes)


def _is_diagonal(tensor: Matrix) -> bool:
    (_, a, b), (c, _, d), (e, f, _) = tensor.tolist()
    return not any((a, b, c, d, e, f))


def bounded(inertia: BodyInertia, compiler: Compiler) -> str | None:
    """Apply the compiler's bounds to a body in place, and its balance of moments.

    Returns:
        What is wrong with moments that no body has; None if nothing is.
    """
    inertia.mass = max(inertia.mass, compiler.least_mass)
    moments, axes = principal_axes(inertia.tensor)
    least, middle, greatest = moments.tolist()
    whole = least + middle + greatest
    if compiler.least_inertia <= least and 2.0 * greatest <= whole * (1.0 + _ROUNDING) + _ROUNDING**2:
        return None
    changed = np.maximum(moments, compiler.least_inertia) if compiler.least_inertia > 0.0 else moments
    if changed.max(initial=0.0) * 2.0 > changed.sum() * (1.0 + _ROUNDING) + _ROUNDING**2:
        if not compiler.balance:
            x, y, z = changed
            return f"no body has the moments of inertia {x:g}, {y:g} and {z:g}"
        changed = np.full(3, changed.mean())
    if (changed != moments).any():
        inertia.tensor = turned_tensor(axes, np.diag(changed))
    return None


def scaled_to_total(inertias: list[BodyInertia], total: float) -> None:
    """Scale masses and inertia of bodies in place, so that their masses add up to `total` [kg]."""
    mass = sum(inertia.mass for inertia in inertias)
    if mass <= 0.0:
        return
    for inertia in inertias:
        inertia.mass *= total / mass
        inertia.tensor = inertia.tensor * (total / mass)
