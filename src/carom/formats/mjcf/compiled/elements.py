"""The elements of bodies: those in `<frame>`, copies by `<replicate>`, and attached models included."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.transform import compose
from carom.files.budget import GRAIN, BudgetError, check_time, excess, left
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.defaults import Attributes, class_defaults
from carom.formats.mjcf.frames import read_pose
from carom.formats.robot.context import shown

WORLD = "world"
# Places have two numbers for each model around, and one for each copy.
_DEEPEST = 120
Place = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Scope:
    """What an element takes from those around it.

    Attributes:
        context: The model that it belongs to.
        child_class: Class of defaults that the enclosing bodies and frames set for it.
        into: Pose, in the enclosing body, of the frame in which its own pose is given.
        prefix: Added in front of its name.
        suffix: Added after its name.
        home: Place of the file that is attached, see `place`; empty for the main one.
        around: The suffixes of copies around it in its file, outermost first.
        place: Where it comes among all scopes of names: elements of sections are in this order, as MuJoCo
            has them. Those of a copy or an attached model come after those around it, in document order.
    """

    context: CompiledContext
    child_class: str | None = None
    into: Pose = IDENTITY
    prefix: str = ""
    suffix: str = ""
    home: Place = ()
    around: tuple[str, ...] = ()
    place: Place = ()

    def name(self, element: Element) -> str:
        """The full name of an element; empty if it has none."""
        own = element.attributes.get("name", "")
        return f"{self.prefix}{own}{self.suffix}" if own else ""

    def attributes(self, element: Element) -> Attributes:
        """The attributes of an element over those of its class of defaults."""
        latest = self.context.latest
        if latest is not None and latest[0] is element and latest[1] == self.child_class:
            return latest[2]
        defaults = class_defaults(self.context, element, self.child_class)
        found = self.context.over(defaults, element.attributes)
        self.context.latest = element, self.child_class, found
        return found

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
        owners: Places of the scopes in which there is something of a full name, for parts of bodies.
    """

    def __init__(self) -> None:
        self.count = 0
        self._left = left("elements")
        self.attached: list[Scope] = []
        self.owners: dict[str, set[Place]] = {}
        self._copied: dict[Place, list[Scope]] = {}
        self._orders: dict[int, dict[int, int]] = {}

    def copied(self, scope: Scope) -> list[Scope]:
        """The scopes of all copies that `<replicate>` made within the file of a scope."""
        return self._copied.get(scope.home, [])

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
                if scope.around:
                    self.owners.setdefault(scope.name(child), set()).add(scope.place)
                yield child, scope

    def take(self, context: CompiledContext, element: Element) -> None:
        """Count an element or a copy; raises `BudgetError` if they are too many, or take too long."""
        self.count += 1
        if self.count > self._left:
            problem = context.error(element, excess("elements"))
            raise BudgetError(problem.reason, file=problem.file, line=problem.line, element=problem.element)
        if not self.count % GRAIN:
            check_time()

    def _order(self, context: CompiledContext, element: Element) -> int:
        """The number of an element in its document."""
        root = context.root
        if id(root) not in self._orders:
            orders: dict[int, int] = {}
            pending = [root]
            while pending:
                each = pending.pop()
                orders[id(each)] = len(orders)
                pending += reversed(each.children)
            self._orders[id(root)] = orders
        return self._orders[id(root)][id(element)]

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
        into, digits, order = scope.into, len(str(count)), self._order(context, element)
        around = (*scope.around, scope.suffix)
        child_class = attributes.get("childclass", scope.child_class)
        for number in range(count):
            self.take(context, element)
            suffix = f"{separator}{number:0{digits}d}{scope.suffix}"
            place = (*scope.place, order, number)
            inner = replace(
                scope, child_class=child_class, into=into, suffix=suffix, around=around, place=place
            )
            self._copied.setdefault(scope.home, []).append(replace(inner, into=IDENTITY))
            yield from self.inside(element, inner)
            into = compose(into, step)

    def _attached(self, element: Element, scope: Scope) -> Iterator[tuple[Element, Scope]]:
        context, attributes = scope.context, element.attributes
        name = attributes.get("model", "")
        other = context.attached.get(name) if name else context
        if other is None:
            raise context.error(element, f"there is no model {shown(name)}")
        if not name and not {"body", "frame"} & {*attributes}:
            raise context.error(element, "it needs a model, or a body or frame of this one")
        if len(scope.place) > _DEEPEST:
            raise context.error(element, "it is attached in itself")
        prefix = scope.prefix + attributes.get("prefix", "")
        place = (*scope.place, self._order(context, element), 0)
        inner = Scope(other, None, scope.into, prefix, scope.suffix, home=place, place=place)
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
                    child_class = found.attributes.get("childclass", at.child_class)
                    into = at.pose(found, found.attributes)
                    yield from self.inside(found, replace(at, child_class=child_class, into=into))
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
