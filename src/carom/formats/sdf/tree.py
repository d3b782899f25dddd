"""Models of a file that is read as written, with those inside them and those that they include."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext

_PLACED = ("link", "frame", "joint")

Opened = tuple[SdfContext, Element]
"""A `<model>` and the reading of the file that contains it."""

Open = Callable[[SdfContext, Element], Opened | None]
"""Opens the file of an `<include>`; None, which is then reported, if there is none."""


@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """A link, a frame or a joint.

    Attributes:
        context: The reading of its file.
        element: What states it.
        home: The frame of the model that `__model__` means for it, and in which it is placed: empty for that
            of the model itself, else that of a model which was merged into it.
    """

    context: SdfContext
    element: Element
    home: str = ""


@dataclass(eq=False, slots=True)
class ModelTree:
    """A `<model>`, or a `<world>`, which is the outermost one.

    Attributes:
        context: The reading of the file that contains it.
        element: The `<model>` or `<world>`.
        name: Its name in the model around it.
        stated: The `<model>` or `<include>` that states where it is, and the reading of that one's file.
        placement: Name of the frame in it that is placed there; empty for its own.
        static: It cannot move.
        home: As that of a part of the model around it.
        parts: Its links, frames and joints, also those that were merged into it.
        models: Models in it.
        merged: Models that were merged into it, by the names of their frames.
        lacks: A model that it includes is missing.
    """

    context: SdfContext
    element: Element
    name: str
    stated: Opened
    placement: str = ""
    static: bool = False
    home: str = ""
    parts: list[Part] = field(default_factory=list)
    models: list[ModelTree] = field(default_factory=list)
    merged: dict[str, ModelTree] = field(default_factory=dict)
    lacks: bool = False

    def of(self, tag: str) -> list[Part]:
        """Its parts of a kind, in order."""
        return [part for part in self.parts if part.element.tag == tag]


def read_tree(context: SdfContext, element: Element, opener: Open) -> ModelTree:
    """A `<model>` or `<world>` with all in it; raises `DescriptionError`."""
    name = "" if element.tag in ("world", "sdf") else context.required(element, "name")
    tree = ModelTree(context, element, name, (context, element))
    tree.placement = element.attributes.get("placement_frame", "") if name else ""
    tree.static = bool(name) and context.says(element, "static")
    for child in element.children:
        if child.tag in _PLACED:
            tree.parts.append(Part(context, child))
        elif child.tag == "model":
            tree.models.append(read_tree(context, child, opener))
        elif child.tag == "include":
            _include(tree, child, opener)
    _refuse_same_names(tree)
    return tree


def _include(tree: ModelTree, element: Element, opener: Open) -> None:
    """Add the model that an `<include>` names to a tree, or merge it into that."""
    context = tree.context
    opened = opener(context, element)
    if opened is None:
        tree.lacks = True
        return
    inner = read_tree(*opened, opener)
    inner.name = context.text(element, "name") or inner.name
    if element.first("static") is not None:
        inner.static = context.says(element, "static")
    if element.first("pose") is not None:
        inner.stated = (context, element)
        inner.placement = ""
    frame = context.text(element, "placement_frame")
    if frame:
        if element.first("pose") is None:
            raise context.error(element, "<placement_frame> needs a <pose>")
        inner.placement = frame
    if element.attributes.get("merge") in ("1", "true") and tree.name:
        _merge(tree, inner)
    else:
        tree.models.append(inner)
    tree.lacks = tree.lacks or inner.lacks


def _merge(tree: ModelTree, inner: ModelTree) -> None:
    home = f"_merged__{inner.name}__model__"
    tree.merged[home] = inner
    for name, other in inner.merged.items():
        tree.merged.setdefault(name, replace(other, home=other.home or home))
    tree.parts += [replace(part, home=part.home or home) for part in inner.parts]
    tree.models += [replace(model, home=model.home or home) for model in inner.models]


def _refuse_same_names(tree: ModelTree) -> None:
    lines: dict[tuple[str, str], int] = {}
    for part in tree.parts:
        element, context = part.element, part.context
        if element.tag == "frame" and "name" not in element.attributes:
            raise context.error(element, "attribute 'name' is missing")
        key = (element.tag, context.required(element, "name"))
        if key in lines:
            raise context.error(element, f"the name {shown(key[1])} is taken already, on line {lines[key]}")
        lines[key] = element.line
