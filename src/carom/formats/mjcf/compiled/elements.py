"""The elements of bodies: those in `<frame>`, copies by `<replicate>`, and attached models included."""

from __future__ import annotations

from collections.abc import Iterator

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.transform import compose
from carom.formats.budget import GRAIN, BudgetError, check_time, excess, left
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.defaults import Attributes, class_defaults
from carom.formats.mjcf.frames import read_pose
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element
from carom.lazy_dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Scope:
    """What an element takes from those around it.

    Attributes:
        context: The model that it belongs to.
        child_class: Class of defaults that the enclosing bodies and frames set for it.
        into: Pose, in the enclosing body, of the frame in which its own pose is given.
        prefix: Added in front of its name.
        suffix: Added after its name.
    """

    context: CompiledContext
    child_class: str | None = None
    into: Pose = IDENTITY
    prefix: str = ""
    suffix: str = ""

    def name(self, element: Element) -> str:
        """The full name of an element; empty if it has none."""
        own = element.attributes.get("name", "")
        return f"{self.prefix}{own}{self.suffix}" if own else ""

    def attributes(self, element: Element) -> Attributes:
        """The attributes of an element over those of its class of defaults."""
        defaults = class_defaults(self.context, element, self.child_class)
        return self.context.over(defaults, element.attributes)

    def pose(self, element: Element, attributes: Attributes) -> Pose:
        """The pose of an element in the enclosing body."""
        return compose(self.into, read_pose(self.context, element, attributes))

    def point(self, point: Vector3) -> Vector3:
        """A point of an element, in the enclosing body."""
        return point if self.into is IDENTITY else compose(self.into, Pose(point)).position


class Elements:
    """Goes through the elements of a file; counts them, since copies multiply.

    Attributes:
        attached: The scopes of all models that were attached, in order.
    """

    def __init__(self) -> None:
        self.count = 0
        self._left = left("elements")
        self.attached: list[Scope] = []
        self._copied: dict[int, dict[tuple[str, str], Scope]] = {}

    def copied(self, scope: Scope) -> list[Scope]:
        """The scopes of all copies that `<replicate>` made within the file of a scope, in order."""
        copies = self._copied.get(id(scope.context), {})
        return [copy for (prefix, _), copy in copies.items() if prefix == scope.prefix]

    def inside(self, parent: Element, scope: Scope) -> Iterator[tuple[Element, Scope]]:
        """The elements of a body, the world or a frame, and their scopes, in document order."""
        context = scope.context
        for child in parent.children:
            self.take(context, child)
            if child.tag == "frame":
                child.note()
                scope.name(child)
                child_class = child.attributes.get("childclass", scope.child_class)
                into = scope.pose(child, child.attributes)
                yield from self.inside(child, replace(scope, child_class=child_class, into=into))
            elif child.tag == "replicate":
                child.note()
                yield from self._copies(child, scope)
            elif child.tag == "attach":
                yield from self._attached(child, scope)
            else:
                yield child, scope

    def take(self, context: CompiledContext, element: Element) -> None:
        """Count an element or a copy; raises `BudgetError` if they are too many, or take too long."""
        self.count += 1
        if self.count > self._left:
            problem = context.error(element, excess("elements"))
            raise BudgetError(problem.reason, file=problem.file, line=problem.line, element=problem.element)
        if not self.count % GRAIN:
            check_time()

    def _copies(self, element: Element, scope: Scope) -> Iterator[tuple[Element, Scope]]:
        context, attributes = scope.context, element.attributes
        count = int(context.parse_number(element, "count", context.required(element, "count")))
        if count < 1:
            raise context.error(element, f"count={count} must be 1 or more")
        separator = attributes.get("sep", "")
        placing = {"pos": attributes.get("offset", "0 0 0")}
        if "euler" in attributes:
            placing["euler"] = attributes["euler"]
        step = read_pose(context, element, placing)
        into, digits = scope.into, len(str(count - 1))
        child_class = attributes.get("childclass", scope.child_class)
        for number in range(count):
            self.take(context, element)
            suffix = f"{separator}{number:0{digits}d}{scope.suffix}"
            inner = replace(scope, child_class=child_class, into=into, suffix=suffix)
            self._copied.setdefault(id(context), {})[scope.prefix, suffix] = replace(inner, into=IDENTITY)
            yield from self.inside(element, inner)
            into = compose(into, step)

    def _attached(self, element: Element, scope: Scope) -> Iterator[tuple[Element, Scope]]:
        context, attributes = scope.context, element.attributes
        name = context.required(element, "model")
        other = context.attached.get(name)
        if other is None:
            raise context.error(element, f"there is no model {shown(name)}")
        prefix = scope.prefix + attributes.get("prefix", "")
        inner = Scope(other, None, scope.into, prefix, scope.suffix)
        self.attached.append(inner)
        # Its sections are read for each model that is attached, whatever of it is.
        for section in other.root.children:
            for _ in range(1 + len(section.children)):
                self.take(context, element)
        kind = "frame" if "frame" in attributes else "body"
        wanted = attributes.get(kind)
        worlds = list(other.root.all("worldbody"))
        if wanted is None:
            for world in worlds:
                yield from self.inside(world, inner)
            return
        for world in worlds:
            for found, at in self._of_name(world, kind, wanted, inner):
                if kind == "body":
                    yield found, at
                else:
                    yield from self.inside(found, at)
                return
        raise context.error(element, f"model {shown(name)} has no {kind} {shown(wanted)}")

    def _of_name(self, parent: Element, tag: str, name: str, scope: Scope) -> Iterator[tuple[Element, Scope]]:
        """Elements of a name below an element, with the classes that those around them set."""
        for child in parent.children:
            self.take(scope.context, child)
            if child.tag == tag and child.attributes.get("name") == name:
                child.note()
                yield child, scope
            if child.tag in ("body", "frame", "replicate"):
                child_class = child.attributes.get("childclass", scope.child_class)
                yield from self._of_name(child, tag, name, replace(scope, child_class=child_class))
