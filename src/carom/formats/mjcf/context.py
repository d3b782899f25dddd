"""State that all parts of the MJCF reader share: numbers, defaults, compiler options, assets."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path

from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import FileContext, shown
from carom.formats.search import AssetSearch

_FLOAT = struct.Struct("f")
SINGLE_PI = 3.1415927410125732
"""Value of π with which PyBullet converts joint ranges from degrees to radians."""


@dataclass
class CompilerOptions:
    """The options in `<compiler>`.

    Attributes:
        degrees: Angles are in degrees; as in PyBullet, only if there is a `<compiler>`.
        global_frames: Positions and orientations are in world axes.
        euler_sequence: Axes of Euler angles; upper case means fixed axes, lower case rotated axes.
        mesh_directory: Prefix of the file names of meshes.
        auto_limits: Joints with a range are limited.
        inertia_from_geoms: Inertia tensors in the file are ignored.
    """

    degrees: bool = False
    global_frames: bool = False
    euler_sequence: str = "xyz"
    mesh_directory: str = ""
    auto_limits: bool = False
    inertia_from_geoms: bool = True


@dataclass
class Assets:
    """Meshes and materials by name."""

    meshes: dict[str, Element] = field(default_factory=dict)
    materials: dict[str, Element] = field(default_factory=dict)


class MjcfContext(FileContext):
    """State of one reading; its root is the `<mujoco>` element.

    Attributes:
        compiler: Compiler options.
        assets: Meshes and materials.
        classes: Default attributes, by class of defaults and name of the element.
        origins: The file of each included element, by the `id` of the element.
        unnamed: Number of names generated so far.
        colours: Geoms have the colours that the file states.
        implicit: Capsules given by their ends are capsules, not PyBullet's swept spheres.
        as_mujoco: `axisangle` turns bodies, and classes limit joints and have to exist, unlike in PyBullet.
    """

    def __init__(self, file: Path, root: Element, search: AssetSearch) -> None:
        super().__init__(file, root, 1.0, search)
        self.compiler: CompilerOptions = CompilerOptions()
        self.assets: Assets = Assets()
        self.classes: dict[str, dict[str, dict[str, str]]] = {}
        self.origins: dict[int, Path] = {}
        self.unnamed: int = 0
        self.colours = False
        self.implicit = False
        self.as_mujoco = True

    def error(self, element: Element, reason: str) -> DescriptionError:
        """An error at an element, with the file that contains it, its line and its path in the document."""
        error = super().error(element, reason)
        for step in reversed(self.root.path_to(element)):
            if id(step) in self.origins:
                origin = self.origins[id(step)]
                return DescriptionError(reason, file=origin, line=error.line, element=error.element)
        return error

    def next_number(self) -> int:
        """The next number for a generated name."""
        self.unnamed += 1
        return self.unnamed - 1

    def singles(self, element: Element, attribute: str, text: str) -> list[float]:
        """The numbers in a text, rounded to single precision as PyBullet rounds them."""
        return [single(self.parse_number(element, attribute, word)) for word in text.split()]

    def over(self, defaults: Mapping[str, str], attributes: Mapping[str, str]) -> dict[str, str]:
        """The attributes of an element, or of a class of defaults, over the defaults that it inherits."""
        return layered(defaults, attributes)

    def triple(self, element: Element, attribute: str, text: str) -> Vector3:
        """The first three numbers in a text; raises `DescriptionError` where there are fewer."""
        numbers = self.singles(element, attribute, text)
        if len(numbers) < 3:
            raise self.error(element, f"{attribute}={shown(text)} needs three numbers")
        return (numbers[0], numbers[1], numbers[2])

    def angle(self, value: float) -> float:
        """An angle in the file, converted to radians."""
        return value * pi / 180.0 if self.compiler.degrees else value


def single(value: float) -> float:
    """A number rounded to single precision."""
    return _FLOAT.unpack(_FLOAT.pack(value))[0]
