"""Convex decomposition of mesh files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from carom.errors import CaromError
from pybullet._calls.arguments import integer, real, text
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail, logger

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["vhacd"]

_FAILED = "vhacd failed."

# V-HACD's default options, and the CoACD options that correspond to them.
_DEFAULT_CONCAVITY, _DEFAULT_THRESHOLD = 0.001, 0.05
_DEFAULT_RESOLUTION, _DEFAULT_GRID = 1_000_000, 50
_DEFAULT_VERTICES = 64
_THRESHOLDS, _GRIDS, _MIN_VERTICES = (0.01, 1.0), (20, 100), 4
# Arguments without effect.
_NUMBERS_OF_VHACD = ("alpha", "beta", "gamma", "minVolumePerCH")
_INTEGERS_OF_VHACD = (
    "depth",
    "planeDownsampling",
    "convexhullDownsampling",
    "mode",
    "convexhullApproximation",
)


@exported
def vhacd(
    fileNameIn: str,
    fileNameOut: str,
    fileNameLogging: str,
    concavity: float = -1,
    alpha: float = -1,
    beta: float = -1,
    gamma: float = -1,
    minVolumePerCH: float = -1,
    resolution: int = -1,
    maxNumVerticesPerCH: int = -1,
    depth: int = -1,
    planeDownsampling: int = -1,
    convexhullDownsampling: int = -1,
    pca: int = -1,
    mode: int = -1,
    convexhullApproximation: int = -1,
    physicsClientId: int = 0,
) -> None:
    """Decomposes the mesh of an OBJ file into convex pieces, each a group of another OBJ file.

    `createCollisionShape` then creates a convex hull for each piece. `vhacd` needs no connection, but it does
    need the library CoACD: `pip install 'carom[decompose]'`. CoACD's method differs from V-HACD's and usually
    yields fewer pieces. Arguments that CoACD has no option for are checked, but have no effect.

    Args:
        fileNameIn: The OBJ file.
        fileNameOut: The OBJ file to write.
        fileNameLogging: A log file to write.
        concavity: Maximum concavity; default 0.001, which stands for CoACD's threshold 0.05.
        alpha: For V-HACD only.
        beta: For V-HACD only.
        gamma: For V-HACD only.
        minVolumePerCH: For V-HACD only.
        resolution: Number of voxels; default 1000000, which stands for 50 cells along a side in CoACD.
        maxNumVerticesPerCH: Maximum number of vertices of a piece; default 64.
        depth: For V-HACD only.
        planeDownsampling: For V-HACD only.
        convexhullDownsampling: For V-HACD only.
        pca: 1 rotates the mesh to its principal axes first.
        mode: For V-HACD only.
        convexhullApproximation: For V-HACD only.
        physicsClientId: No effect.

    Raises:
        pybullet.error: CoACD is not installed, or a file cannot be read or written.

    Examples:
        >>> import pybullet_data
        >>> duck = pybullet_data.getDataPath() + "/duck.obj"
        >>> p.vhacd(duck, folder + "/pieces.obj", folder + "/log.txt")  # doctest: +SKIP
    """
    given = locals()
    source, target = text(fileNameIn, "fileNameIn"), text(fileNameOut, "fileNameOut")
    log = text(fileNameLogging, "fileNameLogging")
    softness, voxels = real(concavity, "concavity"), integer(resolution, "resolution")
    corners, aligned = integer(maxNumVerticesPerCH, "maxNumVerticesPerCH"), integer(pca, "pca")
    without_effect = {name: real(given[name], name) for name in _NUMBERS_OF_VHACD}
    without_effect |= {name: integer(given[name], name) for name in _INTEGERS_OF_VHACD}
    integer(physicsClientId, "physicsClientId")
    named = [name for name, value in without_effect.items() if value >= 0]
    if named:
        logger.warning("vhacd: %s: no effect with CoACD.", ", ".join(named))

    from carom.geometry.decomposition import DecompositionOptions, decompose
    from carom.meshes import read_mesh
    from carom.model.shape_pieces import joined_parts
    from carom.writing import write_text

    options = DecompositionOptions(
        threshold=_DEFAULT_THRESHOLD
        if softness < 0.0
        else _within(softness / _DEFAULT_CONCAVITY * _DEFAULT_THRESHOLD, _THRESHOLDS),
        grid=_DEFAULT_GRID
        if voxels < 0
        else round(_within((voxels / _DEFAULT_RESOLUTION) ** (1 / 3) * _DEFAULT_GRID, _GRIDS)),
        most_vertices=_DEFAULT_VERTICES if corners < 0 else max(corners, _MIN_VERTICES),
        align=aligned > 0,
    )
    try:
        vertices, triangles = joined_parts(read_mesh(Path(source)), (1.0, 1.0, 1.0))
        pieces = decompose(vertices, triangles, options)
        write_text(target, _obj(pieces))
        report = f"{source}: {len(vertices)} vertices, {len(triangles)} triangles\n{options}\n"
        report += "".join(
            f"{_name(number)}: {len(points)} vertices, {len(faces)} triangles\n"
            for number, (points, faces) in enumerate(pieces)
        )
        write_text(log, report)
    except (CaromError, OSError) as problem:
        fail(_FAILED, str(problem))


def _within(value: float, bounds: tuple[float, float]) -> float:
    return min(max(value, bounds[0]), bounds[1])


def _name(number: int) -> str:
    return f"convex_{number}"


def _obj(pieces: list[tuple[NDArray[np.float64], NDArray[np.int32]]]) -> str:
    """An OBJ file with a group for each piece."""
    lines = []
    known = 0
    for number, (points, faces) in enumerate(pieces):
        lines.append(f"o {_name(number)}")
        lines.extend(f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points.tolist())
        first = known + 1
        lines.extend(f"f {first + a} {first + b} {first + c}" for a, b, c in faces.tolist())
        known += len(points)
    return "\n".join(lines) + "\n"
