"""`<pair>` in `<contact>`: geoms that collide whatever their bits and excluded bodies say, and how."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from carom.description.compliance import Compliance, PairContact
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.elements import WORLD, Scope
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel
from carom.formats.mjcf.compiled.names import Names, in_order, resolved, section_attributes
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.robot.context import shown

_PARTS = ("geom1", "geom2")
_REASON = "pairs are of bodies"
_FRICTION = (1.0, 1.0, 0.005, 0.0001, 0.0001)


def paired_geoms(context: CompiledContext) -> set[str]:
    """Names of all geoms in pairs, of a file and those that it attaches, as these state them."""
    names = {
        pair.attributes.get(part, "")
        for contact in context.root.all("contact")
        for pair in contact.all("pair")
        for part in _PARTS
    }
    for other in context.attached.values():
        names |= paired_geoms(other)
    return names - {""}


def read_pairs(
    model: CompiledModel, names: Names, scope: Scope, bodies: dict[str, str], world: CompiledBody
) -> None:
    """Add the pairs of a file and of all that it attaches to a model.

    Args:
        model: The model.
        names: All names in it.
        scope: That of the file.
        bodies: Name of the body of each geom, by name.
        world: The world.

    Raises:
        DescriptionError: A geom is missing.
    """
    shapes = {body.name: len(body.collisions) for body in (world, *names.bodies.values())}
    found: list[tuple[Element, PairContact, str, str]] = []
    scopes: list[Scope] = []
    for element, of in names.sections(scope, "contact"):
        if element.tag != "pair":
            continue
        of.name(element)
        contact = _read_contact(of, element, model.options)
        geoms = [of.context.required(element, part) for part in _PARTS]
        copies = names.copies(of, geoms, set(bodies))
        if not copies:
            names.missing(of, element, geoms, set(bodies), "geom")
        for copy in copies:
            first, second = (bodies[resolved(copy, geom, bodies)] for geom in geoms)
            found.append((element, contact, first, second))
            scopes.append(copy)
    for (element, contact, first, second), scope in zip(
        in_order(found, scopes), in_order(scopes, scopes), strict=True
    ):
        if first != second:
            stated = model.paired.setdefault((min(first, second), max(first, second)), contact)
            if stated != contact:
                scope.context.leave_out(
                    element, "contacts are as the first pair of both bodies has them", _REASON, *_PARTS
                )
        if shapes[first] > 1 or shapes[second] > 1:
            scope.context.leave_out(element, "all geoms of both bodies collide", _REASON, *_PARTS)


def read_excluded(model: CompiledModel, names: Names, scope: Scope) -> None:
    """Add the bodies that do not collide, by `<exclude>` in a file and all that it attaches, to a model.

    Raises:
        DescriptionError: A body is missing.
    """
    known = {*names.bodies, WORLD}
    for element, of in names.sections(scope, "contact"):
        if element.tag != "exclude":
            continue
        element.attributes.get("name")
        bodies = [of.context.required(element, part) for part in ("body1", "body2")]
        if not names.nodes.keys().isdisjoint(bodies):
            of.context.leave_out(element, "they collide", "nodes of flexes collide alike")
            continue
        for copy in names.copies_or_missing(of, element, bodies, known, "body"):
            first, second = (resolved(copy, body, known) for body in bodies)
            model.excluded.append((first, second))


def _read_contact(scope: Scope, element: Element, options: Mapping[str, Any]) -> PairContact:
    """How the contacts of a pair are: defaults are MuJoCo's, whatever its geoms say."""
    context = scope.context
    attributes = section_attributes(scope, element, "pair")
    friction = list(_FRICTION)
    given = context.numbers(element, "friction", attributes.get("friction", ""), 0, len(friction))
    friction[: len(given)] = given
    dimensions = int(context.number(element, attributes, "condim", 3.0))
    if dimensions not in (1, 3, 4, 6):
        raise context.error(element, f"condim={shown(attributes['condim'])} must be 1, 3, 4 or 6")
    compliance = read_compliance(scope, element, attributes)
    lateral = [0.0, 0.0]
    given = context.numbers(element, "solreffriction", attributes.get("solreffriction", ""), 0, 2)
    lateral[: len(given)] = given
    margin = context.number(element, attributes, "margin", 0.0)
    if options.get("flag.override", False):
        friction, margin = list(options["o_friction"]), options["o_margin"]
        compliance = Compliance(*options["o_solref"], *options["o_solimp"])
    if options.get("cone", "pyramidal") != "elliptic":
        lateral = [0.0, 0.0]  # Edges of pyramids have the reference of the normal.
    sliding, across, spinning, rolling, other = friction
    if (dimensions > 1 and across != sliding) or (dimensions > 4 and other != rolling):
        context.leave_out(
            element, "both directions have the first one's", "friction is alike along both", "friction"
        )
    return PairContact(
        compliance,
        (
            sliding if dimensions > 1 else 0.0,
            rolling if dimensions > 4 else 0.0,
            spinning if dimensions > 3 else 0.0,
        ),
        margin,
        (lateral[0], lateral[1]),
    )
