"""A stage as it is read: values, frames in metres with z up, and a record of what was read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import copysign, inf
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Pose
from carom.description.transform import Matrix3, quaternion_from_matrix, rotation_matrix
from carom.errors import DescriptionError
from carom.files.bounded import open_regular
from carom.files.budget import charge
from carom.formats.reading.ignored import Ignored
from carom.formats.usd.exact import PREFIX, is_rounded
from carom.formats.usd.library import Library, library

Matrix = NDArray[np.float64]
Points = NDArray[np.float64]
Triangles = NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class Solids:
    """Geometry that the reader needs.

    Attributes:
        hull: Vertices and triangles of the convex hull of points.
        pieces: Points of the convex pieces of a solid; raises `CaromError` where what cuts it is missing.
    """

    hull: Callable[[Points], tuple[Points, Triangles]]
    pieces: Callable[[Points, Triangles], list[Points]]


_Z_UP: Matrix = np.eye(3)
# What turns the axis that is up to z.
_UP: dict[str, Matrix] = {
    "Y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "X": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
}
_SHEAR = 1e-6
_GREATEST = 3.4e38


class Stage:
    """A USD stage.

    Attributes:
        file: Its root layer.
        solids: Geometry that readers need.
        pxr: The library.
        stage: The `Usd.Stage`.
        unit: Metres per unit of length.
        mass_unit: Kilograms per unit of mass.
        turn: (3, 3) rotation that makes z the axis that is up.
        left_out: What was reported.
        read: Properties that were read: path of the prim, and name.
    """

    def __init__(self, file: Path, solids: Solids) -> None:
        # A pipe or a device is refused before the library waits for it.
        open_regular(file)[0].close()
        self.file: Path = file
        self.solids: Solids = solids
        self.pxr: Library = library(file)
        self.stage: Any = self._open()
        self.unit: float = float(self.pxr.UsdGeom.GetStageMetersPerUnit(self.stage))
        self.mass_unit: float = float(self.pxr.UsdPhysics.GetStageKilogramsPerUnit(self.stage))
        self.turn: Matrix = _UP.get(str(self.pxr.UsdGeom.GetStageUpAxis(self.stage)), _Z_UP)
        self.left_out: list[Ignored] = []
        self.read: set[tuple[str, str]] = set()
        if not (0.0 < self.unit < np.inf and 0.0 < self.mass_unit < np.inf):
            raise self.error(None, f"a unit of {self.unit} m or {self.mass_unit} kg has no meaning")
        self._time = self.pxr.Usd.TimeCode.EarliestTime()
        self._frames = self.pxr.UsdGeom.XformCache(self._time)
        self._world = np.eye(4)
        self._world[:3, :3] = self.turn * self.unit
        self._all: list[Any] | None = None

    def _open(self) -> Any:
        try:
            return self.pxr.Usd.Stage.Open(str(self.file))
        except self.pxr.Tf.ErrorException as problem:
            lines = [line.strip() for line in str(problem).splitlines() if line.strip()]
            # Where in the library the error was found does not matter to users.
            said = lines[0].rpartition(" : ")[2].strip("'") if lines else "no reason is given"
            raise DescriptionError(f"USD cannot open it: {said}", file=self.file) from None

    def prims(self) -> list[Any]:
        """All prims that count, also those in instances, each after the one around it."""
        if self._all is None:
            usd = self.pxr.Usd
            root = self.stage.GetPseudoRoot()
            self._all = []
            for prim in usd.PrimRange(root, usd.TraverseInstanceProxies()):
                if prim != root:
                    charge("elements", file=self.file)
                    self._all.append(prim)
        return self._all

    def above(self, prim: Any) -> Iterator[Any]:
        """A prim and those around it, the innermost first."""
        while prim and not prim.IsPseudoRoot():
            yield prim
            prim = prim.GetParent()

    def note(self, prim: Any, name: str) -> None:
        """Note that a property was read."""
        self.read.add((str(prim.GetPath()), name))

    def value(self, prim: Any, name: str, default: Any = None) -> Any:
        """The value of an attribute at the earliest time, in double precision where the file has that."""
        self.note(prim, name)
        attribute = prim.GetAttribute(name)
        found = attribute.Get(self._time) if attribute else None
        if found is None:
            return default
        twin = prim.GetAttribute(PREFIX + name)
        if twin:
            self.note(prim, PREFIX + name)
            exact = twin.Get(self._time)
            if exact is not None and is_rounded(exact, found):
                return exact
        return found

    def number(self, prim: Any, name: str, default: float) -> float:
        """A number; raises `DescriptionError` if it is none."""
        value = self.value(prim, name, default)
        try:
            result = float(value)
        except (TypeError, ValueError):
            raise self.error(prim, f"{name} is {value!r}; expected a number") from None
        if result != result:
            raise self.error(prim, f"{name} is not a number")
        # The greatest float stands for infinity in many files.
        return copysign(inf, result) if abs(result) >= _GREATEST else result

    def is_stated(self, prim: Any, name: str) -> bool:
        """Whether the file has a value for an attribute."""
        attribute = prim.GetAttribute(name)
        return bool(attribute) and attribute.HasAuthoredValue()

    def targets(self, prim: Any, name: str) -> list[Any]:
        """The prims that a relationship names."""
        self.note(prim, name)
        relationship = prim.GetRelationship(name)
        if not relationship:
            return []
        found = []
        for path in relationship.GetForwardedTargets():
            target = self.stage.GetPrimAtPath(path)
            if not target:
                self.leave_out(prim, f"{name} names {path}, which is not there", "a path leads nowhere", name)
            else:
                found.append(target)
        return found

    def matrix(self, prim: Any) -> Matrix:
        """(4, 4): the frame of a prim, with its scale, in the world in metres with z up."""
        self._note_moves(prim)
        row_major = self._frames.GetLocalToWorldTransform(prim)
        return self._world @ np.array(row_major, np.float64).reshape(4, 4).T

    def world_matrix(self) -> Matrix:
        """(4, 4): the frame of the stage in the world in metres with z up."""
        return self._world

    def _note_moves(self, prim: Any) -> None:
        for it in self.above(prim):
            if ("transform", str(it.GetPath())) in self.read:
                return
            self.read.add(("transform", str(it.GetPath())))
            shown = self.pxr.UsdGeom.Xformable(it)
            if shown and shown.TransformMightBeTimeVarying():
                self.leave_out(
                    it, "it does not move along its samples in time", "poses are those at the start"
                )

    def name_of(self, prim: Any) -> str:
        """The name of what a prim stands for: its own, or the one that Carom has written beside it."""
        return str(self.value(prim, "carom:name") or prim.GetName())

    def leave_out(self, prim: Any, consequence: str, reason: str, *attributes: str) -> None:
        """Report something that the simulation lacks."""
        kind = str(prim.GetTypeName()) or "prim"
        self.left_out.append(Ignored(kind, self.file, 1, attributes, 1, consequence, reason))

    def error(self, prim: Any, reason: str) -> DescriptionError:
        """An error about a prim, or about the stage."""
        element = None if prim is None else f"<{prim.GetPath()}>"
        return DescriptionError(reason, file=self.file, element=element)


def rigid(matrix: Matrix) -> tuple[Pose, Matrix]:
    """The pose of a frame without its scale, and the (3, 3) rest: matrix = pose · rest.

    The rest is diagonal if the frame has no shear; a frame that mirrors has a negative scale along x.
    """
    linear = matrix[:3, :3]
    lengths = np.linalg.norm(linear, axis=0)
    turned = linear / np.where(lengths > 0.0, lengths, 1.0)
    if np.min(lengths) == 0.0 or np.max(np.abs(turned.T @ turned - np.eye(3))) > _SHEAR:
        turned, _ = np.linalg.qr(linear)
        turned = turned * np.where(np.sum(turned * linear, axis=0) < 0.0, -1.0, 1.0)
    if np.linalg.det(turned) < 0.0:
        turned = turned * np.array([-1.0, 1.0, 1.0])
    rest = turned.T @ linear
    # So that frames without scale have none, whatever rounding leaves.
    rest[np.abs(rest - 1.0) < 1e-14] = 1.0
    rest[np.abs(rest) < 1e-12 * max(1e-300, float(np.abs(rest).max()))] = 0.0
    x, y, z = matrix[:3, 3].tolist()
    return Pose((x, y, z), quaternion_from_matrix(as_matrix(turned))), rest


def as_matrix(rotation: Matrix) -> Matrix3:
    """A (3, 3) array as tuples."""
    a, b, c = (tuple(row) for row in rotation.tolist())
    return (a, b, c)


def homogeneous(pose: Pose) -> Matrix:
    """The (4, 4) matrix of a pose."""
    result = np.eye(4)
    result[:3, :3] = rotation_matrix(pose.orientation)
    result[:3, 3] = pose.position
    return result
