"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot
from pathlib import Path
from typing import TypeVar

from carom.description import Geometry, Plane
from carom.description.pose import Vector3
from carom.formats.robot.context import FileContext, shown
from carom.formats.xml_element import Element

Context = TypeVar("Context", bound=FileContext)

MESH_SUFFIXES = (".obj", ".stl", ".dae")
FIELD_SUFFIXES = (".cdf",)


def read_geometry(
    context: Context, owner: Element, readers: Mapping[str, Callable[[Context, Element], Geometry]]
) -> Geometry:
    """The shape of a `<visual>` or `<collision>`.

    Args:
        context: The reading it belongs to.
        owner: The `<visual>` or `<collision>`.
        readers: The function that reads each shape, by the name of its element.

    Raises:
        DescriptionError: No `<geometry>`, an unknown shape, missing or bad sizes, a mesh that does not exist.
    """
    geometry = owner.first("geometry")
    if geometry is None:
        raise context.error(owner, "<geometry> is missing")
    if not geometry.children:
        raise context.error(geometry, "it holds no shape")
    shape = geometry.children[0]
    reader = readers.get(shape.tag)
    if reader is None:
        raise context.error(shape, f"unknown shape; known are {', '.join(readers)}")
    return reader(context, shape)


def plane(context: FileContext, shape: Element, normal: Vector3) -> Plane:
    """The plane with a normal of any length except zero."""
    x, y, z = normal
    length = hypot(x, y, z)
    if length == 0.0:
        raise context.error(shape, "the normal has no length")
    return Plane((x / length, y / length, z / length))


def shape_file(context: FileContext, shape: Element, key: str, name: str, suffixes: tuple[str, ...]) -> Path:
    """The file of a mesh or distance field.

    Args:
        context: The reading it belongs to.
        shape: The element that names it.
        key: Attribute or child element that contains the file name.
        name: The file name.
        suffixes: Accepted suffixes of file names.

    Raises:
        DescriptionError: The suffix is not accepted, or there is no such file.
    """
    check_suffix(context, shape, key, name, suffixes)
    path = context.find_file(name)
    if path is None:
        raise context.not_found(shape, name)
    return path


def check_suffix(
    context: FileContext, shape: Element, key: str, name: str, suffixes: tuple[str, ...]
) -> None:
    """Raise `DescriptionError` unless a file name has one of these suffixes."""
    if not name.lower().endswith(suffixes):
        raise context.error(shape, f"{key}={shown(name)} must end in {' or '.join(suffixes)}")
