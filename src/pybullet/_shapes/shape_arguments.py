"""Shapes from the arguments of `createCollisionShape` and `createVisualShape`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom import description
from carom.description.pose import Vector3
from carom.formats.shipped import advice
from pybullet._calls.arguments import MAX_MAGNITUDE, moderate, real
from pybullet._calls.errors import fail
from pybullet._calls.nested import nested
from pybullet._calls.optional_vectors import optional_vector3

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pybullet._clients.clients import Client


def is_primitive(kind: int) -> bool:
    """Whether a type of shape is one of those that `primitive` makes."""
    from carom.description.geometry import BY_GEOM

    return kind in BY_GEOM


def primitive(
    kind: int, problem: str, radius: Any, length: Any, half_extents: Any, normal: Any, *, length_name: str
) -> description.Geometry:
    """A sphere, box or another primitive from the arguments of a call; sizes in metres.

    `length` is that of a cylinder, or between the two hemispheres of a capsule. A box needs `half_extents`.

    Raises:
        pybullet.error: A size is missing, negative or not finite.
        TypeError: A size is not a number.
    """
    from carom.description.geometry import BY_GEOM
    from carom.description.shapes.shape import Measure

    shape = BY_GEOM[kind]
    given = {"radius": radius, "height": length, "halfExtents": half_extents, "planeNormal": normal}
    found: list[Any] = []
    for it in shape.parameters:
        value, name = given[it.call], length_name if it.call == "height" else it.call
        if it.measure is Measure.DIRECTION:
            x, y, z = optional_vector3(value, problem, name) or (0.0, 0.0, 1.0)
            norm = (x * x + y * y + z * z) ** 0.5
            if norm == 0.0:
                fail(problem, f"{name} has no length.")
            found.append((x / norm, y / norm, z / norm))
        elif it.measure is Measure.LENGTHS:
            if value is None:
                fail(problem, f"A {shape.tag} needs {name}.")
            x, y, z = optional_vector3(value, problem, name) or (1.0, 1.0, 1.0)
            _check_size(min(x, y, z) >= 0.0, max(x, y, z), problem, f"{name} is {[x, y, z]}.")
            found.append((x, y, z))
        else:
            size = real(value, name, problem)
            if size == 0.0 and it.call == "radius":
                fail(problem, "radius is 0. It has to be greater than 0.")
            _check_size(size >= 0.0, size, problem, f"{name} is {size}.")
            found.append(size)
    return shape(*found)


def _check_size(is_allowed: bool, greatest: float, problem: str, particulars: str) -> None:
    from carom.description.geometry import MAX_SIZE

    if not is_allowed or greatest > MAX_SIZE:
        fail(problem, f"{particulars} It has to be from 0 to {MAX_SIZE:g} m.")


def scale_of(values: Any, problem: str) -> Vector3:
    """The checked `meshScale`; None stands for factors of 1."""
    scale = optional_vector3(values, problem, "meshScale") or (1.0, 1.0, 1.0)
    for factor in scale:
        moderate(factor, problem, "A factor of meshScale")
    return scale


def find_file(client: Client, name: str, problem: str) -> Path:
    """The path of a file named by a script; raises `pybullet.error` if it is not found."""
    search = client.search()
    path = search.find(name)
    if path is None:
        hint = advice(Path(name), search.places)
        fail(problem, f"There is no file {name!r}{hint}{'' if hint.endswith('?') else '.'}")
    return path


def points(values: Any, problem: str, name: str, columns: int = 3) -> NDArray[np.float64]:
    """Rows of finite numbers from any sequence of rows; raises `pybullet.error` for other values."""
    import numpy as np

    try:
        rows = np.array(nested(values, problem, name), dtype=np.float64)
    except (TypeError, ValueError):
        fail(problem, f"{name} has to be a sequence of {columns} numbers each.")
    if rows.size == 0:
        return rows.reshape(0, columns)
    if rows.ndim != 2 or rows.shape[1] != columns:
        fail(problem, f"{name} has to be a sequence of {columns} numbers each.")
    if not np.isfinite(rows).all():
        fail(problem, f"{name} holds a number that is not finite.")
    if np.abs(rows).max() > MAX_MAGNITUDE:
        fail(problem, f"{name} holds a number greater than {MAX_MAGNITUDE:g}.")
    return rows


def triangles(values: Any, vertex_count: int, problem: str) -> NDArray[np.int32]:
    """`indices` as rows of three, one for each triangle; raises `pybullet.error` if they do not fit."""
    import numpy as np

    try:
        flat = np.array(nested(values, problem, "indices"))
    except ValueError:
        fail(problem, "indices has to be a flat sequence of integers.")
    if flat.size == 0:
        return np.empty((0, 3), dtype=np.int32)
    if flat.ndim != 1 or flat.dtype.kind not in "iu":
        fail(problem, "indices has to be a flat sequence of integers.")
    if len(flat) % 3:
        fail(problem, f"indices has {len(flat)} items, which does not make triangles.")
    if flat.min() < 0 or flat.max() >= vertex_count:
        fail(problem, f"indices names a vertex outside 0..{vertex_count - 1}.")
    return flat.reshape(-1, 3).astype(np.int32)
