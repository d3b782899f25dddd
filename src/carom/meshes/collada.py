"""COLLADA (DAE): the triangles of the scene, one part per geometry shown.

Lengths are converted to metres with the file's unit. The file's up axis is not applied: PyBullet does not
apply it either, and robot files account for that.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.meshes.part import MeshPart, cut_into_fans, make_part
from carom.native.products import length, product
from carom.native.trigonometry import cos, sin

# Most numbers for each vertex in a source, and most indices for each corner in a primitive.
_MAX_COLUMNS = 1000
_MAX_DEPTH = 100


def read_collada(data: bytes, file: Path) -> list[MeshPart]:
    """Reads a DAE file; raises `DescriptionError` if it is broken, or its scene shows no triangles."""
    reader = collada_reader(data, file)
    parts = [reader.part(identifier, placement) for identifier, placement in reader.scene()]
    parts = [part for part in parts if len(part.triangles)]
    if not parts:
        raise DescriptionError("the scene shows no triangles", file=file)
    return parts


def scene_of_instances(data: bytes, file: Path) -> list[MeshPart] | None:
    """As `read_collada`, with the nodes that `<instance_node>` shows again; None if there are none.

    PyBullet leaves these out, and so does `read_collada`.
    """
    if b"instance_node" not in data:
        return None
    reader = ColladaReader(parse_root(data, file, "COLLADA"), file, instances=True)
    parts = [reader.part(identifier, placement) for identifier, placement in reader.scene()]
    return [part for part in parts if len(part.triangles)]


def collada_reader(data: bytes, file: Path) -> ColladaReader:
    """A reader of the content of a DAE file; DescriptionError if it is not COLLADA or broken."""
    return ColladaReader(parse_root(data, file, "COLLADA"), file)


class ColladaReader:
    """Reads the geometries in the scene of a document, from its `<COLLADA>` element."""

    def __init__(self, root: Element, file: Path, *, instances: bool = False) -> None:
        """With `instances`, nodes are shown wherever an `<instance_node>` refers to them."""
        self.root = root
        self.file = file
        self.geometries: dict[str, Element] = {
            element.attributes.get("id", ""): element
            for library in root.all("library_geometries")
            for element in library.all("geometry")
        }
        self._named: dict[str, Element] = {}
        pending = list(root.children) if instances else []
        while pending:
            element = pending.pop()
            pending += element.children
            if element.tag == "node" and "id" in element.attributes:
                self._named[element.attributes["id"]] = element
        self._instances = instances
        self._triangles: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]] = {}

    def error(self, element: Element, reason: str) -> DescriptionError:
        """An error at an element."""
        return DescriptionError(reason, file=self.file, line=element.line, element=f"<{element.tag}>")

    def scene(self) -> Iterator[tuple[str, NDArray[np.float64]]]:
        """Id and 4x4 transform of each geometry in the scene, conversion to metres included."""
        scene = self.root.first("scene")
        instance = None if scene is None else scene.first("instance_visual_scene")
        wanted = "" if instance is None else _target(instance, "url")
        placement = np.diag([self._metres_per_unit()] * 3 + [1.0])
        for library in self.root.all("library_visual_scenes"):
            for candidate in library.all("visual_scene"):
                if candidate.attributes.get("id", "") != wanted:
                    continue
                for node in candidate.all("node"):
                    for item in self._nodes(node, placement):
                        charge("elements", file=self.file, line=candidate.line)
                        yield item

    def _metres_per_unit(self) -> float:
        asset = self.root.first("asset")
        unit = None if asset is None else asset.first("unit")
        if unit is None or "meter" not in unit.attributes:
            return 1.0
        return float(np.float32(self.numbers(unit, unit.attributes["meter"], 1)[0]))

    def _nodes(
        self, node: Element, parent: NDArray[np.float64], around: tuple[Element, ...] = ()
    ) -> Iterator[tuple[str, NDArray[np.float64]]]:
        if self._instances:
            # A few of them may show very many.
            charge("elements", file=self.file, line=node.line)
        placement = product(parent, self._local_transform(node))
        for instance in node.all("instance_geometry"):
            identifier = _target(instance, "url")
            if identifier not in self.geometries:
                raise self.error(instance, f"there is no geometry {identifier!r}")
            yield identifier, placement
        for child in node.all("node"):
            yield from self._nodes(child, placement, (*around, node))
        for instance in node.all("instance_node") if self._instances else ():
            identifier = _target(instance, "url")
            shown = self._named.get(identifier)
            if shown is None:
                raise self.error(instance, f"there is no node {identifier!r} in the file")
            if len(around) >= _MAX_DEPTH or any(shown is each for each in (*around, node)):
                raise self.error(instance, f"node {identifier!r} shows itself, or is nested too deep")
            yield from self._nodes(shown, placement, (*around, node))

    def _local_transform(self, node: Element) -> NDArray[np.float64]:
        total = np.eye(4)
        for step in node.children:
            if step.tag == "matrix":
                total = product(total, self.numbers(step, step.text, 16).reshape(4, 4))
            elif step.tag == "translate":
                translation = np.eye(4)
                translation[:3, 3] = self.numbers(step, step.text, 3)
                total = product(total, translation)
            elif step.tag == "scale":
                total = product(total, np.diag([*self.numbers(step, step.text, 3), 1.0]))
            elif step.tag == "rotate":
                x, y, z, degrees = self.numbers(step, step.text, 4)
                total = product(total, _rotation(np.array([x, y, z]), radians(degrees)))
        return total

    def part(self, identifier: str, placement: NDArray[np.float64]) -> MeshPart:
        """The triangles of a geometry, placed in the scene."""
        if identifier not in self._triangles:
            self._triangles[identifier] = self._read_geometry(self.geometries[identifier])
        positions, corners = self._triangles[identifier]
        charge("vertices", len(positions) + len(corners), file=self.file)
        placed = product(positions, placement[:3, :3].T) + placement[:3, 3]
        return make_part(self.file, placed, corners, identifier)

    def _read_geometry(self, geometry: Element) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        positions: list[NDArray[np.float64]] = []
        corners: list[NDArray[np.int64]] = []
        known = 0
        for mesh, primitive in primitives(geometry):
            source, offset, stride = self.position_input(mesh, primitive)
            charge("vertices", len(source), file=self.file, line=primitive.line)
            indices = self.corner_indices(primitive, offset, stride)
            if len(indices) and not 0 <= indices.min() <= indices.max() < len(source):
                raise self.error(primitive, f"it names a vertex outside 0..{len(source) - 1}")
            positions.append(source)
            corners.append(indices + known)
            known += len(source)
        if not positions:
            return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
        return np.concatenate(positions), np.concatenate(corners)

    def position_input(self, mesh: Element, primitive: Element) -> tuple[NDArray[np.float64], int, int]:
        """Positions (k, 3), the offset of their index in each corner, and the number of indices in each."""
        stride = max((self.offset(entry) + 1 for entry in primitive.all("input")), default=1)
        shared = self.shared_input(mesh, primitive)
        if shared is None:
            raise self.error(primitive, "it has no VERTEX input")
        vertices, offset = shared
        for entry in inputs(vertices, "POSITION"):
            source = referenced(mesh, "source", entry)
            if source is not None:
                return self.source_rows(source, 3), offset, stride
        raise self.error(vertices, "it has no POSITION input with a source in this mesh")

    def shared_input(self, mesh: Element, primitive: Element) -> tuple[Element, int] | None:
        """The `<vertices>` that a primitive refers to and the offset of its index; None without them."""
        entries = list(inputs(primitive, "VERTEX"))
        vertices = referenced(mesh, "vertices", entries[-1]) if entries else None
        return None if vertices is None else (vertices, self.offset(entries[-1]))

    def offset(self, entry: Element) -> int:
        """The offset of an input's index among the indices of a corner."""
        return self._count(entry, "offset", "0", 0)

    def source_rows(self, source: Element, width: int) -> NDArray[np.float64]:
        """(k, width) the first entries of each row of a source."""
        array = source.first("float_array")
        if array is None:
            raise self.error(source, "<float_array> is missing")
        technique = source.first("technique_common")
        accessor = None if technique is None else technique.first("accessor")
        stride = width if accessor is None else self._count(accessor, "stride", str(width), width)
        values = self.numbers(array, array.text)
        if len(values) % stride:
            raise self.error(array, f"{len(values)} numbers do not make rows of {stride}")
        return values.reshape(-1, stride)[:, :width]

    def corner_indices(self, primitive: Element, offset: int, stride: int) -> NDArray[np.int64]:
        """(m, 3) the index at one offset of each corner; polygons are cut into fans."""
        fans: list[NDArray[np.int64]] = []
        counts = primitive.first("vcount")
        for run in primitive.all("p"):
            values = self._integers(run)
            if len(values) % stride:
                raise self.error(run, f"{len(values)} indices do not make corners of {stride}")
            corners = values.reshape(-1, stride)[:, offset]
            if primitive.tag == "triangles":
                sizes = np.full(len(corners) // 3, 3)
            elif primitive.tag == "polygons":
                sizes = np.array([len(corners)])
            else:
                sizes = np.empty(0, dtype=np.int64) if counts is None else self._integers(counts)
            if sizes.sum() != len(corners) or (sizes < 0).any():
                raise self.error(run, f"{len(corners)} corners do not fit the sizes of the polygons")
            fans.append(cut_into_fans(corners, sizes))
        return np.concatenate(fans) if fans else np.empty((0, 3), dtype=np.int64)

    def _count(self, element: Element, name: str, default: str, least: int) -> int:
        """A small whole number in an attribute."""
        value = self.numbers(element, element.attributes.get(name, default), 1)[0]
        if not least <= value <= _MAX_COLUMNS:
            raise self.error(element, f"{name} has to be from {least} to {_MAX_COLUMNS}")
        return int(value)

    def _integers(self, element: Element) -> NDArray[np.int64]:
        try:
            return np.array(list(map(int, element.text.split())), dtype=np.int64)
        except (ValueError, OverflowError):
            raise self.error(element, "it must hold whole numbers") from None

    def numbers(self, element: Element, text: str, count: int | None = None) -> NDArray[np.float64]:
        """The finite numbers in a text of an element, `count` of them if that is given."""
        try:
            values = np.array(list(map(float, text.split())), dtype=np.float64)
        except ValueError:
            raise self.error(element, "it must hold numbers") from None
        if count is not None and len(values) != count:
            raise self.error(element, f"expected {count} numbers, not {len(values)}")
        if not np.isfinite(values).all():
            raise self.error(element, "it must hold finite numbers")
        return values


def primitives(geometry: Element) -> Iterator[tuple[Element, Element]]:
    """All elements of a geometry that hold triangles or polygons, each with its `<mesh>`."""
    for mesh in geometry.all("mesh"):
        for primitive in mesh.children:
            if primitive.tag in ("triangles", "polylist", "polygons"):
                yield mesh, primitive


def inputs(owner: Element, semantic: str) -> Iterator[Element]:
    """The inputs of an element that have this semantic."""
    return (entry for entry in owner.all("input") if entry.attributes.get("semantic") == semantic)


def referenced(mesh: Element, tag: str, entry: Element) -> Element | None:
    """The element of a mesh that an input names as its source."""
    identifier = _target(entry, "source")
    return next((it for it in mesh.all(tag) if it.attributes.get("id", "") == identifier), None)


def _target(element: Element, attribute: str) -> str:
    """The id in a reference `#id`."""
    return element.attributes.get(attribute, "")[1:]


def _rotation(axis: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """4x4 rotation matrix; the identity for an axis without length."""
    total = np.eye(4)
    size = length(axis)
    if size > 0.0:
        x, y, z = axis / size
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        total[:3, :3] += sin(angle) * cross + (1.0 - cos(angle)) * product(cross, cross)
    return total
