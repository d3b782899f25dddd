"""Names that elements outside bodies refer to: of bodies, joints, geoms and sites of the compiled file."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Sequence
from typing import TypeVar

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import WORLD, Elements, Place, Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint
from carom.formats.mjcf.defaults import MAIN, Attributes
from carom.formats.reading.cursor import Recorded
from carom.formats.robot.context import shown

LOST_BETWEEN_COPIES = ("it is missing, as in MuJoCo", "it connects a copy with what is not in that copy")
"""What is lost with an actuator or an equality constraint between a copy and what is around it, and why."""
_T = TypeVar("_T")


class Names:
    """What has been compiled, by name, and the scopes in which the sections of files look names up.

    Attributes:
        joints: Body and joint of each hinge, slide and ball.
        bodies: All bodies.
        elements: The walk through the bodies, which knows copies and attached models.
        nodes: Flex and number of each node that is not pinned, by the name of its body in MuJoCo.
    """

    def __init__(
        self, bodies: list[CompiledBody], elements: Elements, flexes: Sequence[FileFlex] = ()
    ) -> None:
        self.bodies: dict[str, CompiledBody] = {body.name: body for body in bodies}
        self.joints: dict[str, tuple[CompiledBody, CompiledJoint]] = {
            joint.joint.name: (body, joint) for body in bodies for joint in body.joints
        }
        self.elements = elements
        self.nodes: dict[str, tuple[FileFlex, int]] = {
            name: (flex, node) for flex in flexes for name, node in flex.body_names().items()
        }

    def sections(self, scope: Scope, tag: str) -> Iterator[tuple[Element, Scope]]:
        """The elements in the sections of a name: of the file, then of attached models."""
        for each in (scope, *self.elements.attached):
            for section in each.context.root.all(tag):
                for child in section.children:
                    yield child, each

    def copies(self, scope: Scope, names: list[str], known: Container[str]) -> list[Scope]:
        """The scopes of an element by the names that it refers to, see `scopes_of`."""
        return scopes_of(self.elements, scope, names, lambda _, name: name in known)

    def crosses(self, copies: list[Scope], element: Element, names: list[str], known: Container[str]) -> bool:
        """Whether some of the names are those of a copy and others are not, which is reported.

        MuJoCo leaves out such actuators and equality constraints, without a word.
        """
        for copy in copies:
            if all(full(copy, name) in known for name in names if name):
                continue
            copy.context.leave_out(element, *LOST_BETWEEN_COPIES)
            return True
        return False

    def copies_or_missing(
        self, scope: Scope, element: Element, names: list[str], known: Container[str], what: str
    ) -> list[Scope]:
        """As `copies`; raises an error as `missing` does if there are none."""
        copies = self.copies(scope, names, known)
        if not copies:
            self.missing(scope, element, names, known, what)
        return copies

    def missing(
        self, scope: Scope, element: Element, names: list[str], known: Container[str], what: str
    ) -> None:
        """Raise an error about the first unknown one; an attached model may lack it."""
        if scope in self.elements.attached:
            return
        copies = self.elements.copied(scope)
        unknown = [name for name in names if name and full(scope, name) not in known]
        for name in unknown:
            if not any(_resolved(copy, name, known.__contains__) for copy in copies):
                raise scope.context.error(element, f"there is no {what} {shown(name)}")
        if unknown:
            those = " and ".join(shown(name) for name in names if name)
            raise scope.context.error(element, f"no copy by <replicate> has {what} {those}")


def full(scope: Scope, name: str) -> str:
    """A name with the prefix and the suffix of a scope; that of the world has none."""
    return name if name in ("", WORLD) else f"{scope.prefix}{name}{scope.suffix}"


def resolved(scope: Scope, name: str, known: Container[str]) -> str:
    """The full name of what an element in a copy refers to: in that copy or else around it.

    If it is not known at all, it is the name in the copy.
    """
    return resolved_by(scope, name, known.__contains__)


def resolved_by(scope: Scope, name: str, is_known: Callable[[str], bool]) -> str:
    """As `resolved`, with a function that says whether a full name is known."""
    return _resolved(scope, name, is_known) or full(scope, name)


def _own(scope: Scope, name: str, is_known: Callable[[str], bool]) -> str:
    """As `full`; something else than a body may be called `world`, too."""
    found = full(scope, name)
    return f"{scope.prefix}{name}{scope.suffix}" if name == WORLD and not is_known(found) else found


def _resolved(scope: Scope, name: str, is_known: Callable[[str], bool]) -> str:
    found = _own(scope, name, is_known)
    if is_known(found):
        return found
    for suffix in reversed(scope.around):
        if is_known(found := f"{scope.prefix}{name}{suffix}"):
            return found
    return ""


def scopes_of(
    elements: Elements, scope: Scope, names: list[str], is_known: Callable[[int, str], bool]
) -> list[Scope]:
    """The scopes in which an element of a section is there, by the names that it refers to.

    That is its file, or the copies that `<replicate>` made of what it refers to; names may be those of
    elements around these. An element of an attached model whose parts are not attached has none.

    Args:
        elements: The walk through the bodies.
        scope: The scope of the file.
        names: What it refers to; empty names do not count.
        is_known: Whether there is something with a full name, by the place in `names`.
    """
    wanted = [(place, name) for place, name in enumerate(names) if name]

    def own(copy: Scope, place: int, name: str) -> str:
        return _own(copy, name, lambda whole: is_known(place, whole))

    if all(is_known(place, own(scope, place, name)) for place, name in wanted):
        return [scope]

    def is_own(copy: Scope, place: int, name: str) -> bool:
        whole = own(copy, place, name)
        return is_known(place, whole) and copy.place in elements.owners.get(whole, (copy.place,))

    found: list[Scope] = []
    suffixes: set[str] = set()
    for copy in elements.copied(scope):
        # Copies by several elements may have the same suffix.
        if copy.suffix in suffixes or not any(is_own(copy, *it) for it in wanted if it[1] != WORLD):
            continue
        if all(
            _resolved(copy, name, lambda full_name, place=place: is_known(place, full_name))
            for place, name in wanted
        ):
            found.append(copy)
            suffixes.add(copy.suffix)
    return found


def in_order(items: Sequence[_T], scopes: Sequence[Scope]) -> list[_T]:
    """What elements of sections have become, in MuJoCo's order; `scopes` are theirs."""
    places: list[Place] = [scope.place for scope in scopes]
    order = sorted(range(len(items)), key=places.__getitem__)
    return [items[number] for number in order]


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
