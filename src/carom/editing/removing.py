"""Removing parts of a description, with all that needs them."""

from __future__ import annotations

from carom.editing.elements import pairs, walk
from carom.editing.references import MATERIAL, TEXTURE, kind_of, named, references
from carom.files.xml_element import Element

_LOOKS = (MATERIAL, TEXTURE)


def remove_elements(root: Element, elements: list[Element]) -> list[str]:
    """Remove elements, what is in them, and what needs something that they are or hold.

    What names a material or a texture only loses its look.

    Returns:
        What went with them, as `actuator 'motor'` or `<exclude> in <contact>`, without they themselves.
    """
    listed: list[str] = []
    pending = list(elements)
    chosen = {id(it) for it in elements}
    while pending:
        before = named(root)
        gone = {id(it): it for each in pending for it in walk(each)}
        for parent, element in list(pairs(root)):
            if id(element) in gone and id(element) not in chosen:
                name, kind = element.attributes.get("name", ""), kind_of(element, parent)
                listed.append(
                    f"{kind or element.tag} {name!r}" if name else f"<{element.tag}> in <{parent.tag}>"
                )
        for each in pending:
            for parent, element in list(pairs(root)):
                if element is each:
                    parent.children.remove(element)
        after = named(root)
        lost = set(before) - set(after)
        wholes: dict[int, Element] = {}
        for reference in list(references(root)):
            if (reference.kind, reference.name) not in lost:
                continue
            if reference.kind in _LOOKS:
                del reference.owner.attributes[reference.attribute]
            else:
                wholes[id(reference.whole)] = reference.whole
        pending = list(wholes.values())
    return listed
