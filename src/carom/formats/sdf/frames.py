"""Frames of a `<model>`: poses that are stated relative to links, joints and `<frame>`s of it."""

from __future__ import annotations

from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext
from carom.formats.xml_element import Element

_MODEL = "__model__"
_PLACED = ("link", "frame", "joint", "model")


class Frames:
    """The frames of one model, in that of the model.

    Source: SDFormat specification, "Pose frame semantics": a pose is relative to the frame that
    `relative_to` names; without that, for a `<frame>` to what it is attached to, for a joint to its child
    link, otherwise to the model.
    """

    def __init__(self, context: SdfContext, model: Element) -> None:
        self._context = context
        self._elements: dict[str, Element] = {}
        for element in model.children:
            name = element.attributes.get("name")
            if element.tag in _PLACED and name is not None:
                self._elements.setdefault(name, element)
        self._known: dict[str, Pose] = {_MODEL: IDENTITY, "": IDENTITY}
        self._open: list[str] = []

    def of(self, element: Element) -> Pose:
        """The pose of an element in the frame of the model.

        Raises:
            DescriptionError: It is relative to a frame that does not exist, or frames are in a circle.
        """
        stated = element.first("pose")
        own = self._context.pose(element)
        base = None if stated is None else stated.attributes.get("relative_to")
        if not base and element.tag == "frame":
            base = element.attributes.get("attached_to")
        elif not base and element.tag == "joint":
            base = self._context.text(element, "child")
        return own if not base else compose(self.named(stated or element, base), own)

    def named(self, element: Element, name: str) -> Pose:
        """The pose of a frame in that of the model; errors are at the element that names it."""
        if name not in self._known:
            inner, _, rest = name.partition("::")
            if rest and inner in self._elements and self._elements[inner].tag == "model":
                pose = Frames(self._context, self._elements[inner]).named(element, rest)
                self._known[name] = compose(self.named(element, inner), pose)
                return self._known[name]
            if name not in self._elements:
                known = ", ".join(self._elements)
                raise self._context.error(element, f"there is no frame {shown(name)}; there are {known}")
            if name in self._open:
                raise self._context.error(element, f"frames are in a circle: {' -> '.join(self._open)}")
            self._open.append(name)
            self._elements[name].note()
            self._known[name] = self.of(self._elements[name])
            self._open.pop()
        return self._known[name]
