"""Frames of a model: poses that are stated relative to links, joints, frames and models of it."""

from __future__ import annotations

from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose, inverse
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.tree import ModelTree, Part

_MODEL = "__model__"
WORLD = "world"


class Frames:
    """The frames of one model, in that of the model.

    Source: SDFormat specification, "Pose frame semantics" and "Model composition": a pose is relative to the
    frame that `relative_to` names; without that, for a `<frame>` to what it is attached to, for a joint to
    its child, otherwise to the model, which of a model merged into another one is a frame of that.
    """

    def __init__(self, tree: ModelTree) -> None:
        self.tree = tree
        self._parts: dict[str, Part] = {}
        for part in tree.parts:
            self._parts.setdefault(part.element.attributes["name"], part)
        self._models = {model.name: model for model in reversed(tree.models)}
        self._inner: dict[str, Frames] = {}
        self._known: dict[str, Pose] = {"": IDENTITY, _MODEL: IDENTITY}
        if not tree.name:
            self._known[WORLD] = IDENTITY
        self._open: list[str] = []

    def inside(self, model: ModelTree) -> Frames:
        """The frames of a model in this one."""
        if model.name not in self._inner or self._inner[model.name].tree is not model:
            self._inner[model.name] = Frames(model)
        return self._inner[model.name]

    def of(self, part: Part) -> Pose:
        """The pose of a link, frame or joint in the frame of the model.

        Raises:
            DescriptionError: It is relative to a frame that does not exist, or frames are in a circle.
        """
        context, element = part.context, part.element
        stated = element.first("pose")
        own = context.pose(element)
        base = None if stated is None else stated.attributes.get("relative_to")
        if not base and element.tag == "frame":
            base = element.attributes.get("attached_to")
        elif not base and element.tag == "joint":
            base = context.text(element, "child")
        base = base or part.home
        return own if not base else compose(self.named(part, stated or element, base), own)

    def of_model(self, model: ModelTree) -> Pose:
        """The pose of a model in this one; its placement frame is where the file says."""
        context, element = model.stated
        stated = element.first("pose")
        pose = context.pose(element)
        base = None if stated is None else stated.attributes.get("relative_to")
        base = base or model.home
        if base:
            pose = compose(self.named(Part(context, element, model.home), stated or element, base), pose)
        if model.placement:
            inner = self.inside(model)
            pose = compose(pose, inverse(inner.named(Part(context, element), element, model.placement)))
        return pose

    def named(self, part: Part, element: Element, name: str) -> Pose:
        """The pose of a frame in that of the model; errors are at the element of a part that names it."""
        if name == _MODEL or (name == self.tree.name and name not in self._parts):
            # Some files name a model in it by its own name, which is that of its frame around it.
            name = part.home
        if name not in self._known:
            if name in self._open:
                raise part.context.error(element, f"frames are in a circle: {' -> '.join(self._open)}")
            self._open.append(name)
            self._known[name] = self._find(part, element, name)
            self._open.pop()
        return self._known[name]

    def _find(self, part: Part, element: Element, name: str) -> Pose:
        if name in self.tree.merged:
            return self.of_model(self.tree.merged[name])
        if name in self._parts:
            self._parts[name].element.note()
            return self.of(self._parts[name])
        inner, _, rest = name.partition("::")
        if inner in self._models:
            model = self._models[inner]
            pose = self.of_model(model)
            if not rest:
                return pose
            return compose(pose, self.inside(model).named(Part(part.context, element), element, rest))
        raise self._unknown(part.context, element, name)

    def link(self, part: Part, element: Element, name: str) -> str:
        """The name of the link that a frame, joint or model is attached to, as seen from this model."""
        return self._link(part, element, name, ())

    def _link(self, part: Part, element: Element, name: str, passed: tuple[str, ...]) -> str:
        if name in passed:
            raise part.context.error(element, f"frames are in a circle: {' -> '.join(passed)}")
        passed = (*passed, name)
        if name in ("", _MODEL):
            name = part.home
        if not name:
            return self.canonical(part.context, element)
        if name in self.tree.merged:
            inner = self.tree.merged[name]
            return self.inside(inner).canonical(part.context, element)
        own = self._parts.get(name)
        if own is not None:
            if own.element.tag == "link":
                return name
            own.element.note()
            key = own.context.text(own.element, "child") if own.element.tag == "joint" else None
            key = key or own.element.attributes.get("attached_to", "")
            return self._link(own, own.element, key, passed)
        first, _, rest = name.partition("::")
        if first in self._models:
            inner = self.inside(self._models[first])
            return f"{first}::{inner.link(Part(part.context, element), element, rest)}"
        raise self._unknown(part.context, element, name, what="link")

    def canonical(self, context: SdfContext, element: Element) -> str:
        """The name of the link to which the frame of the model is attached."""
        stated = self.tree.element.attributes.get("canonical_link")
        if stated:
            return stated
        links = self.tree.of("link")
        if links:
            return links[0].element.attributes["name"]
        for model in self.tree.models:
            return f"{model.name}::{self.inside(model).canonical(context, element)}"
        raise context.error(element, "it is attached to a model without links")

    def _unknown(
        self, context: SdfContext, element: Element, name: str, what: str = "frame"
    ) -> DescriptionError:
        known = ", ".join((*self._parts, *self._models)) or "none"
        return context.error(element, f"there is no {what} {shown(name)}; there are {known}")
