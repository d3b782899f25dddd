"""`<mesh>` assets: triangles from a file, from numbers in the document or made by name, and their mass."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3
from carom.description.shapes.moments import MassShape
from carom.description.transform import rotation_matrix
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.shapes.builtin_meshes import builtin_mesh
from carom.formats.mjcf.compiled.shapes.mesh_mass import WAYS, mass_of_mesh
from carom.formats.mjcf.compiled.shapes.msh import read_msh
from carom.formats.mjcf.defaults import class_defaults
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import MissingFile, shown
from carom.meshes import read_mesh
from carom.native.products import product

LEGACY = "legacy"


@dataclass(frozen=True, eq=False, slots=True)
class MeshAsset:
    """A mesh as geoms use it.

    Attributes:
        vertices: (n, 3) scaled, and moved by its reference pose [m].
        triangles: (m, 3) indices; none for a cloud of points, of which only the hull counts.
        file: Its file, if that has triangles and `vertices` are those of the file times `scale`.
        scale: Factor along x, y and z.
        is_one_piece: The file has only one part.
        way: How its mass is found, see `carom.formats.mjcf.compiled.shapes.mesh_mass`.
        mass: The distribution of mass in it; None if it has no volume.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    file: Path | None
    scale: Vector3
    is_one_piece: bool
    way: str
    mass: MassShape | None


class Meshes:
    """The meshes of a file, read when a geom first uses them."""

    def __init__(self) -> None:
        self._read: dict[int, MeshAsset] = {}

    def find(self, context: CompiledContext, user: Element, name: str) -> MeshAsset:
        """The mesh of a name, for an element that uses it; raises `DescriptionError` if it can't be had."""
        element = context.named.mesh.get(name)
        if element is None:
            raise context.error(user, f"there is no mesh {shown(name)}")
        if id(element) not in self._read:
            self._read[id(element)] = _read(context, element)
        return self._read[id(element)]


def _read(context: CompiledContext, element: Element) -> MeshAsset:
    element.note()
    attributes = layered(class_defaults(context, element, None), element.attributes)
    scale = (1.0, 1.0, 1.0)
    if "scale" in attributes:
        x, y, z = context.numbers(element, "scale", attributes["scale"], 3, 3)
        scale = (x, y, z)
    way = attributes.get("inertia", LEGACY)
    if way not in WAYS:
        raise context.error(element, f"inertia={shown(way)} must be one of {', '.join(WAYS)}")
    vertices, triangles, file, parts, solid = _triangles(context, element, attributes)
    moved = _to_reference(context, element, attributes, vertices)
    if moved is not vertices:
        file = None
    vertices = moved * np.array(scale)
    if np.prod(scale) < 0.0:
        triangles = triangles[:, ::-1]
    if len(triangles):
        mass = mass_of_mesh(vertices, triangles[:solid], way, context.hull)
    else:
        file = None
        mass = mass_of_mesh(*context.hull(vertices), way, context.hull)
    return MeshAsset(vertices, triangles, file, scale, parts == 1, way, mass)


def _triangles(
    context: CompiledContext, element: Element, attributes: dict[str, str]
) -> tuple[NDArray[np.float64], NDArray[np.int32], Path | None, int, int]:
    """Vertices, triangles, the file, the number of parts in it, and how many triangles bound its mass."""
    if "builtin" in attributes and attributes["builtin"] != "none":
        numbers = context.singles(element, "params", attributes.get("params", ""))
        made = builtin_mesh(attributes["builtin"], numbers)
        if isinstance(made, str):
            raise context.error(element, made)
        return *made, None, 1, len(made[1])
    if "file" in attributes:
        return _from_file(context, element, attributes["file"])
    if "vertex" not in attributes:
        raise context.error(element, "a mesh needs a file, vertices or builtin")
    numbers = context.singles(element, "vertex", attributes["vertex"])
    if len(numbers) % 3 or len(numbers) < 12:
        raise context.error(element, f"vertex has {len(numbers)} numbers; 3 for each of 4 or more are needed")
    vertices = np.array(numbers).reshape(-1, 3)
    faces = context.singles(element, "face", attributes.get("face", ""))
    if len(faces) % 3:
        raise context.error(element, f"face has {len(faces)} numbers; 3 for each triangle are needed")
    # Compared before they are made integers of 32 bits, into which they may not fit.
    if faces and not 0.0 <= min(faces) <= max(faces) < len(vertices):
        raise context.error(element, f"face names a vertex that is not there; there are {len(vertices)}")
    return vertices, np.array(faces, np.int32).reshape(-1, 3), None, 1, len(faces) // 3


def _from_file(
    context: CompiledContext, element: Element, name: str
) -> tuple[NDArray[np.float64], NDArray[np.int32], Path, int, int]:
    path = context.asset_file(element, name, context.compiler.mesh_directory)
    if path is None:
        raise context.not_found(element, name)
    if path.suffix.lower() == ".msh":
        vertices, triangles = read_msh(path)
        return vertices, triangles, path, 1, len(triangles)
    try:
        parts = read_mesh(path, by_ears=True)
    except DescriptionError as problem:
        if path.suffix.lower() in (".obj", ".stl", ".dae"):
            raise
        raise MissingFile(problem.reason, file=context.file, line=element.line, element="mesh") from None
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts])
    triangles = np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)])
    # MuJoCo takes the triangles of the first object of an OBJ file, and the corners of all.
    solid = len(parts[0].triangles) if path.suffix.lower() == ".obj" else len(triangles)
    return vertices, triangles.astype(np.int32), path, len(parts), solid


def _to_reference(
    context: CompiledContext, element: Element, attributes: dict[str, str], vertices: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Vertices in the frame that `refpos` and `refquat` state; the same array if they state none."""
    if "refpos" in attributes:
        vertices = vertices - context.numbers(element, "refpos", attributes["refpos"], 3, 3)
    if "refquat" in attributes:
        w, x, y, z = context.numbers(element, "refquat", attributes["refquat"], 4, 4)
        if w == x == y == z == 0.0:
            raise context.error(element, "refquat has no length, so it is no rotation")
        vertices = product(vertices, np.array(rotation_matrix((x, y, z, w))))
    return vertices
