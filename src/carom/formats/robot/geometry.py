"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from pathlib import Path

from carom.description.geometry import BY_TAG
from carom.description.pose import Vector3
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, MissingFile, shown

MESH_SUFFIXES = (".obj", ".stl", ".dae")
WRITTEN_MESH_SUFFIXES = (*MESH_SUFFIXES, ".glb", ".gltf", ".ply")
"""Kinds of meshes in files that are read as written; PyBullet knows fewer."""

FIELD_SUFFIXES = (".cdf",)
_SHAPES = (*BY_TAG, "mesh", "cdf")
OF_DRAKE = "drake:"
"""What Drake writes in front of elements of its own, as that of capsules."""
_DRAKES = f"{OF_DRAKE}capsule"


def shape_element(context: FileContext, owner: Element, known: Sequence[str] = _SHAPES) -> Element:
    """The element of a shape in a `<visual>` or `<collision>`; `DescriptionError` unless it is known."""
    geometry = owner.first("geometry")
    if geometry is None:
        raise context.error(owner, "<geometry> is missing")
    if not geometry.children:
        raise context.error(geometry, "it holds no shape")
    shape = geometry.children[0]
    is_drakes = known is _SHAPES and shape.tag == _DRAKES and context.written is not None
    if shape.tag not in known and not is_drakes:
        raise context.error(shape, f"unknown shape; known are {', '.join(known)}")
    return shape


def mesh_suffixes(context: FileContext) -> tuple[str, ...]:
    """The kinds of meshes that a file may refer to, in the way it is read."""
    return MESH_SUFFIXES if context.written is None else WRITTEN_MESH_SUFFIXES


def direction(context: FileContext, shape: Element, normal: Vector3) -> Vector3:
    """The unit vector along a normal of any length except zero."""
    x, y, z = normal
    length = hypot(x, y, z)
    if length == 0.0:
        raise context.error(shape, "the normal has no length")
    return (x / length, y / length, z / length)


def shape_file(context: FileContext, shape: Element, key: str, name: str, suffixes: tuple[str, ...]) -> Path:
    """The file of a mesh or distance field; `key` is the attribute or child element that contains its name.

    Raises:
        DescriptionError: The suffix of the name is not one of `suffixes`, or there is no such file.
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
        problem = context.error(shape, f"{key}={shown(name)} must end in {' or '.join(suffixes)}")
        raise MissingFile(problem.reason, file=problem.file, line=problem.line, element=problem.element)
