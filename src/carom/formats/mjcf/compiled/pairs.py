"""`<pair>` in `<contact>`: geoms that collide whatever their bits and excluded bodies say."""

from __future__ import annotations

from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel
from carom.formats.mjcf.compiled.names import Names, full
from carom.formats.mjcf.defaults import MAIN
from carom.formats.reading.cursor import Recorded

_PARTS = ("geom1", "geom2")


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
    for element, of in names.sections(scope, "contact"):
        if element.tag != "pair":
            continue
        defaults = of.context.classes.get(element.attributes.get("class") or MAIN, {}).get("pair", {})
        if isinstance(defaults, Recorded):
            defaults.note_use()
        of.name(element)
        geoms = [of.context.required(element, part) for part in _PARTS]
        copies = names.copies(of, geoms, set(bodies))
        if not copies:
            names.missing(of, element, geoms, set(bodies), "geom")
        for copy in copies:
            first, second = (bodies[full(copy, geom)] for geom in geoms)
            if first != second:
                model.paired.append((first, second))
            if shapes[first] > 1 or shapes[second] > 1:
                consequence = "all geoms of both bodies collide"
                copy.context.leave_out(element, consequence, "pairs are of bodies", *_PARTS)
