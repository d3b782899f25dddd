"""Putting one description into another: names, assets, sections and keys."""

from __future__ import annotations

from carom.description import Pose
from carom.editing.elements import copied, error, pairs, section
from carom.editing.keys import Keys
from carom.editing.losses import Losses
from carom.editing.moving import put_into
from carom.editing.references import (
    CLASS,
    HFIELD,
    KEY,
    MATERIAL,
    MESH,
    TEXTURE,
    kind_of,
    named,
    references,
)
from carom.editing.removing import remove_elements
from carom.files.xml_element import Element

_ASSETS = (MESH, MATERIAL, TEXTURE, HFIELD)
_TAKEN = (
    "extension", "custom", "deformable", "contact", "equality", "tendon", "actuator", "sensor", "default",
)  # fmt: skip
_OF_FILE = ("option", "size", "visual", "statistic", "compiler")
_MAX_NAMES = 5


def join(
    host: Element, guest: Element, body: Element, pose: Pose, prefix: str, losses: Losses, *, is_world: bool
) -> None:
    """Put all of a description into a body of another one, or into its world.

    Args:
        host: The root of the other.
        guest: The root of the description, which is not changed.
        body: The body, or the world of the host.
        pose: Of the world of the guest, in the body.
        prefix: Added in front of all names of the guest.
        losses: Gets what of the guest does not count.
        is_world: The body is the world; otherwise its bodies lose free joints.

    Raises:
        DescriptionError: Both have something of the same name, or it cannot be put there.
    """
    guest = copied(guest)
    add_prefix(guest, prefix)
    _check_names(host, guest, prefix)
    _check_fits(host, guest)
    if not is_world:
        _fix(guest, losses)
    keys = Keys(host, guest)
    keys.move(guest, pose)
    moved = [element for world in guest.all("worldbody") for element in world.children]
    for element in moved:
        put_into(element, pose)
    # Nothing fails from here on.
    body.children += moved
    _join_assets(host, guest)
    for tag in _TAKEN:
        for stated in guest.all(tag):
            if stated.children:
                section(host, tag).children += stated.children
    for stated in guest.children:
        if stated.tag in _OF_FILE:
            _compare(host, stated, losses)
    for stated in guest.all("keyframe"):
        section(host, "keyframe").children += stated.children
    for key in keys.united(host):
        section(host, "keyframe").children.remove(key)
    keys.write(host)


def add_prefix(root: Element, prefix: str) -> None:
    """Add a prefix in front of all names."""
    if not prefix:
        return
    for reference in references(root):
        reference.restate(prefix + reference.name)
    for parent, element in pairs(root):
        if element.tag == "default":
            if "class" in element.attributes:
                element.attributes["class"] = prefix + element.attributes["class"]
        elif element.attributes.get("name") and kind_of(element, parent):
            element.attributes["name"] = prefix + element.attributes["name"]


def _check_names(host: Element, guest: Element, prefix: str) -> None:
    own, other = named(host), named(guest)
    both = [
        (kind, name)
        for kind, name in other
        if (kind, name) in own and kind != KEY and not _is_same(kind, own[kind, name], other[kind, name])
    ]
    if both:
        listed = ", ".join(f"{kind} {name!r}" for kind, name in both[:_MAX_NAMES])
        more = f" and {len(both) - _MAX_NAMES} more" if len(both) > _MAX_NAMES else ""
        cure = f"with another prefix than {prefix!r}" if prefix else 'with a prefix, such as prefix="left_"'
        kind, name = both[0]
        raise error(other[kind, name], f"both descriptions have {listed}{more}; put it there {cure}")


def _is_same(kind: str, one: Element, other: Element) -> bool:
    """Whether an asset or a class is the same in both, which is then there once."""
    if kind not in (*_ASSETS, CLASS) or one.attributes != other.attributes:
        return False
    children = zip(one.children, other.children, strict=False)
    return len(one.children) == len(other.children) and all(
        (a.tag, a.attributes) == (b.tag, b.attributes) for a, b in children
    )


def _check_fits(host: Element, guest: Element) -> None:
    """Fitting of shapes to meshes is an option of a whole description."""
    fits = [
        {it.attributes.get("fitaabb", "false") for it in root.all("compiler")} or {"false"}
        for root in (host, guest)
    ]
    if fits[0] != fits[1]:
        for _, element in pairs(guest):
            if (
                element.tag == "geom"
                and "mesh" in element.attributes
                and element.attributes.get("type") != "mesh"
            ):
                raise error(
                    element,
                    "it is fitted to a mesh by fitaabb of its file; the other one says otherwise: "
                    "state its size instead of the mesh",
                )


def _fix(guest: Element, losses: Losses) -> None:
    """Take out the free joints of what is to be in a body."""
    free: list[Element] = []
    for world in guest.all("worldbody"):
        for body in world.all("body"):
            if body.attributes.get("mocap") == "true":
                raise error(
                    body, "it is moved by users (mocap), which only bodies of the world are; merge it"
                )
            free += [
                it
                for it in body.children
                if it.tag == "freejoint" or (it.tag == "joint" and it.attributes.get("type") == "free")
            ]
    for joint in free:
        losses.add(
            f"body/{joint.tag}",
            "it is fixed where it is attached",
            "only bodies of the world are free",
            of=joint,
        )
    if free:
        keys = Keys(guest)
        for gone in remove_elements(guest, free):
            losses.add(gone, "it is lost with the free joint", "it is of that joint")
        keys.write(guest)


def _join_assets(host: Element, guest: Element) -> None:
    own = named(host)
    for stated in guest.all("asset"):
        for element in stated.children:
            kind = kind_of(element, stated)
            if (kind, element.attributes.get("name", "")) not in own:
                section(host, "asset").children.append(element)
    for stated in guest.all("default"):
        stated.children = [it for it in stated.children if (CLASS, it.attributes.get("class", "")) not in own]


def _compare(host: Element, stated: Element, losses: Losses) -> None:
    """Note what a section of the guest that states options says and that of the host does not."""
    own: dict[str, str] = {}
    children: list[Element] = []
    for section_of_host in host.all(stated.tag):
        own.update(section_of_host.attributes)
        children += section_of_host.children
    differ = [name for name, text in stated.attributes.items() if own.get(name) != text]
    inside = [
        it
        for it in stated.children
        if all((it.tag, it.attributes) != (b.tag, b.attributes) for b in children)
    ]
    if differ:
        losses.add(stated.tag, "the other description's hold", "a scene has one", *differ, of=stated)
    for it in inside:
        losses.add(
            f"{stated.tag}/{it.tag}", "the other description's hold", "a scene has one", *it.attributes, of=it
        )
