"""`<equality>`: joints and tendons that follow others, and bodies that are connected at a point or welded."""

from __future__ import annotations

from dataclasses import replace
from math import comb
from typing import TypeVar

import numpy as np

from carom.description import Pose
from carom.description.transform import compose, inverse
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import (
    CompiledBody,
    CompiledModel,
    FileConnection,
    FileCoupling,
    world_poses,
)
from carom.formats.mjcf.compiled.names import Names, full, in_order, section_attributes
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown
from carom.native.products import length

_BUILT = ("joint", "tendon", "connect", "weld", "flex")
_WORLD = "world"
_LOST = "this constraint does not hold"
_POWERS = 5
_Found = TypeVar("_Found", FileCoupling, FileConnection)


class EqualityReader:
    """Reads all `<equality>` sections into a model."""

    def __init__(self, model: CompiledModel, names: Names, world: CompiledBody) -> None:
        self.model = model
        self.names = names
        self._kinds = {name: kind for name, _, kind in model.joints if name}
        self._poses: dict[str, Pose] = world_poses(world)
        self._lines: dict[str, int] = {}
        self._scopes: dict[str, Scope] = {}

    def read(self, scope: Scope) -> None:
        """Read the constraints of a file and of all that it attaches; raises `DescriptionError`."""
        for element, of in self.names.sections(scope, "equality"):
            if element.tag not in _BUILT:
                self.model.equality_count += 1
                continue
            attributes = section_attributes(of, element, "equality")
            if element.tag == "flex":
                self._hold_edges(of, element, attributes)
                continue
            if element.tag == "joint":
                parts, known, what = ("joint1", "joint2"), set(self._kinds), "joint"
            elif element.tag == "tendon":
                parts, known, what = ("tendon1", "tendon2"), set(self.model.tendons), "tendon"
            elif "site1" in element.attributes:
                parts, known, what = ("site1", "site2"), set(self.model.sites), "site"
            else:
                parts, known, what = ("body1", "body2"), set(self._poses), "body"
            first, second = (element.attributes.get(part, "") for part in parts)
            if not first or (what == "site" and not second):
                raise of.context.error(element, f"{parts[1] if first else parts[0]} is missing")
            if what == "body" and not {first, second}.isdisjoint(self.names.nodes):
                self.model.equality_count += 1
                self._hold(of, element, attributes, first, second)
                continue
            copies = self.names.copies(of, [first, second], known)
            if not copies:
                self.names.missing(of, element, [first, second], known, what)
            if self.names.crosses(copies, element, [first, second], known):
                self.model.equality_count += 1
                continue
            for copy in copies:
                a, b = full(copy, first), full(copy, second)
                if element.tag == "joint":
                    self._read_coupling(copy, element, attributes, a, b)
                elif element.tag == "tendon":
                    self._read_tendons(copy, element, attributes, a, b)
                elif what == "site":
                    one, other = self.model.sites[a], self.model.sites[b]
                    self._add_connection(
                        copy, element, attributes, (one.body, one.frame), (other.body, other.frame)
                    )
                else:
                    self._read_bodies(copy, element, attributes, a, b or _WORLD)
        model = self.model
        model.couplings[:] = self._in_order(model.couplings)
        model.tendon_couplings[:] = self._in_order(model.tendon_couplings)
        model.connections[:] = self._in_order(model.connections)

    def _in_order(self, found: list[_Found]) -> list[_Found]:
        """Constraints in the order of their elements and copies."""
        return in_order(found, [self._scopes[it.name] for it in found])

    def _read_coupling(
        self, scope: Scope, element: Element, attributes: Attributes, follower: str, leader: str
    ) -> None:
        context = scope.context
        if not {follower, leader} - {""} <= set(self.names.joints) or "spherical" in (
            self._kinds[follower],
            self._kinds.get(leader),
        ):
            context.leave_out(element, _LOST, "free and ball joints are not coupled")
            return
        coefficients = _coefficients(scope, element, attributes)
        start = self.names.joints[follower][1].reference
        if not leader:
            coefficients[1:] = [0.0] * (_POWERS - 1)
        else:
            coefficients = _shifted(coefficients, self.names.joints[leader][1].reference)
        constant, first, second, third, fourth = coefficients
        weight = sum(self.model.joint_weights[name] for name in (follower, leader) if name)
        name, enabled = self._name(scope, element), context.flag(element, attributes, "active", True)
        self.model.couplings.append(
            FileCoupling(
                name,
                follower,
                leader or None,
                (start + constant, first, second, third, fourth),
                enabled,
                replace(read_compliance(scope, element, attributes), inverse_mass=weight),
            )
        )

    def _read_tendons(
        self, scope: Scope, element: Element, attributes: Attributes, follower: str, leader: str
    ) -> None:
        robots = {self.model.tendons[name].robot for name in (follower, leader) if name}
        if len(robots) > 1 or "" in robots:
            scope.context.leave_out(
                element, _LOST, "the tendons are not simulated, or are of different bodies of the world"
            )
            return
        constant, first, second, third, fourth = _coefficients(scope, element, attributes)
        compliances = [self.model.tendons[name].limit_compliance for name in (follower, leader) if name]
        weight = (
            sum(it.inverse_mass for it in compliances) if all(it.inverse_mass for it in compliances) else 0.0
        )
        self.model.tendon_couplings.append(
            FileCoupling(
                self._name(scope, element),
                follower,
                leader or None,
                (constant, first, second, third, fourth),
                scope.context.flag(element, attributes, "active", True),
                replace(read_compliance(scope, element, attributes), inverse_mass=weight),
            )
        )

    def _read_bodies(self, scope: Scope, element: Element, attributes: Attributes, a: str, b: str) -> None:
        """Anchors of a constraint between bodies; where not stated, as the bodies are placed in the file."""
        context = scope.context
        between = compose(inverse(self._poses[a]), self._poses[b])
        text = attributes.get("anchor")
        if text is None and element.tag == "connect":
            raise context.error(element, "attribute 'anchor' is missing")
        x, y, z = (0.0, 0.0, 0.0) if text is None else context.numbers(element, "anchor", text, 3, 3)
        if element.tag == "connect":
            on_a = Pose((x, y, z))
            self._add_connection(scope, element, attributes, (a, on_a), (b, compose(inverse(between), on_a)))
            return
        on_b = Pose((x, y, z))
        on_a = compose(between, on_b)
        text = attributes.get("relpose")
        if text is not None:
            px, py, pz, w, i, j, k = context.numbers(element, "relpose", text, 7, 7)
            size = length(np.array((w, i, j, k)))
            if size > 0.0:
                # As in MuJoCo, the position is that of the anchor, and not of the second body.
                on_a = Pose((px, py, pz), (i / size, j / size, k / size, w / size))
        self._add_connection(scope, element, attributes, (a, on_a), (b, on_b))

    def _hold(self, scope: Scope, element: Element, attributes: Attributes, a: str, b: str) -> None:
        """Let a body hold the node of a flex where it is in the file."""
        context, nodes = scope.context, self.names.nodes
        node, holder = (a, full(scope, b) or _WORLD) if a in nodes else (b, full(scope, a))
        if holder not in self._poses:
            context.leave_out(element, _LOST, "nodes of flexes are not tied to each other")
        elif not context.flag(element, attributes, "active", True):
            context.leave_out(element, _LOST, "nodes of flexes are held from the start or not at all")
        else:
            flex, number = nodes[node]
            flex.pins[number] = holder
            context.leave_out(element, "the body holds the node firmly", "anchors of nodes do not yield")

    def _hold_edges(self, scope: Scope, element: Element, attributes: Attributes) -> None:
        """Hold the lengths of the edges of a flex."""
        context, name = scope.context, scope.context.required(element, "flex")
        self.model.equality_count += 1
        flex = next((flex for flex in self.model.flexes if flex.name == full(scope, name)), None)
        compliance = read_compliance(scope, element, attributes)
        is_active = context.flag(element, attributes, "active", True)
        attributes.get("name")
        if flex is None and not _has_flex(context.root, name):
            raise context.error(element, f"there is no flex {shown(name)}")
        if flex is None:
            context.leave_out(element, _LOST, "the flex is rigid, or not built")
        elif not is_active:
            context.leave_out(element, _LOST, "edges of flexes are held from the start or not at all")
        else:
            flex.edges = compliance

    def _add_connection(
        self,
        scope: Scope,
        element: Element,
        attributes: Attributes,
        first: tuple[str, Pose],
        second: tuple[str, Pose],
    ) -> None:
        name = self._name(scope, element)
        if first[0] == second[0]:
            scope.context.leave_out(element, _LOST, "both ends are on one body")
            return
        if first[0] == _WORLD:
            first, second = second, first
        enabled = scope.context.flag(element, attributes, "active", True)
        weights = [self.model.body_weights.get(body, (0.0, 0.0)) for body in (first[0], second[0])]
        linear, angular = (sum(values) for values in zip(*weights, strict=True))
        compliance = read_compliance(scope, element, attributes)
        is_weld = element.tag == "weld"
        share = abs(scope.context.number(element, attributes, "torquescale", 1.0)) if is_weld else 1.0
        if share > 0.0:
            # A row that is scaled, while what makes it yield is not, yields less by the square.
            angular /= share * share
        else:
            is_weld = False
        compliance = replace(compliance, inverse_mass=linear, inverse_inertia=angular)
        self.model.connections.append(
            FileConnection(name, is_weld, *first, *second, enabled, compliance, share)
        )

    def _name(self, scope: Scope, element: Element) -> str:
        number, name = self.model.equality_count, scope.name(element)
        self.model.equality_count += 1
        if name:
            scope.context.refuse_duplicate(element, name, self._lines)
        else:
            name = f"{element.tag}{number}_{scope.context.next_number()}"
        self._scopes[name] = scope
        return name


def _coefficients(scope: Scope, element: Element, attributes: Attributes) -> list[float]:
    """The coefficients of the polynomial of a coupling, those that are not stated included."""
    stated = scope.context.numbers(element, "polycoef", attributes.get("polycoef", ""), 0, _POWERS)
    return [*stated, *(0.0, 1.0, 0.0, 0.0, 0.0)[len(stated) :]]


def _shifted(coefficients: list[float], start: float) -> list[float]:
    """The coefficients of a polynomial in x - start as those of one in x."""
    if start == 0.0:
        return coefficients
    return [
        sum(
            coefficients[power] * comb(power, own) * (-start) ** (power - own)
            for power in range(own, _POWERS)
        )
        for own in range(_POWERS)
    ]


def _has_flex(root: Element, name: str) -> bool:
    """Whether a document has a flex of a name, be it built or not."""
    pending = [root]
    while pending:
        each = pending.pop()
        if each.tag in ("flex", "flexcomp") and each.attributes.get("name") == name:
            return True
        pending += each.children
    return False


def has_equalities(names: Names, scope: Scope) -> bool:
    """Whether a file, or what it attaches, has equality constraints."""
    return any(True for _ in names.sections(scope, "equality"))
