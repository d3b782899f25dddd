"""Names that elements outside bodies refer to: of bodies, joints, geoms and sites of the compiled file."""

from __future__ import annotations

from collections.abc import Iterator

from carom.formats.mjcf.compiled.elements import Elements, Scope
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint
from carom.formats.mjcf.defaults import MAIN, Attributes
from carom.formats.reading.cursor import Recorded
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element


class Names:
    """What has been compiled, by name, and the scopes in which the sections of files look names up.

    Attributes:
        joints: Body and joint of each hinge, slide and ball.
        bodies: All bodies.
        elements: The walk through the bodies, which knows copies and attached models.
    """

    def __init__(self, bodies: list[CompiledBody], elements: Elements) -> None:
        self.bodies: dict[str, CompiledBody] = {body.name: body for body in bodies}
        self.joints: dict[str, tuple[CompiledBody, CompiledJoint]] = {
            joint.joint.name: (body, joint) for body in bodies for joint in body.joints
        }
        self.elements = elements

    def sections(self, scope: Scope, tag: str) -> Iterator[tuple[Element, Scope]]:
        """The elements in the sections of a name: of attached models in their order, then of the file."""
        for each in (*self.elements.attached, scope):
            for section in each.context.root.all(tag):
                for child in section.children:
                    yield child, each

    def copies(self, scope: Scope, names: list[str], known: set[str]) -> list[Scope]:
        """The scopes in which the names that an element refers to are known.

        That is its own, or those of the copies that `<replicate>` made of what it refers to. An element of an
        attached model whose parts are not attached has none.
        """
        wanted = [name for name in names if name]

        def fits(each: Scope) -> bool:
            return all(full(each, name) in known for name in wanted)

        if fits(scope):
            return [scope]
        return [each for each in self.elements.copied(scope) if fits(each)]

    def copies_or_missing(
        self, scope: Scope, element: Element, names: list[str], known: set[str], what: str
    ) -> list[Scope]:
        """As `copies`; raises an error as `missing` does if there are none."""
        copies = self.copies(scope, names, known)
        if not copies:
            self.missing(scope, element, names, known, what)
        return copies

    def missing(self, scope: Scope, element: Element, names: list[str], known: set[str], what: str) -> None:
        """Raise an error about the first unknown one; an attached model may lack it."""
        for name in names:
            if name and full(scope, name) not in known and scope not in self.elements.attached:
                raise scope.context.error(element, f"there is no {what} {shown(name)}")


def full(scope: Scope, name: str) -> str:
    """A name with the prefix and the suffix of a scope; that of the world has none."""
    return name if name in ("", "world") else f"{scope.prefix}{name}{scope.suffix}"


def section_attributes(scope: Scope, element: Element, kind: str) -> Attributes:
    """The attributes of an element of a section over those of its class of defaults for a kind."""
    context = scope.context
    name = element.attributes.get("class") or MAIN
    if name not in context.classes and name != MAIN:
        raise context.error(element, f"there is no default class {shown(name)}")
    defaults = context.classes.get(name, {}).get(kind, {})
    if isinstance(defaults, Recorded):
        defaults.note_use()
    return context.over(defaults, element.attributes)
