"""MJCF files as descriptions: what includes, frames, copies, attached models, defaults and options state.

In a description each element says by itself all that counts for it, so that parts of several files can be put
together: angles are in radians, poses those in the body, files have absolute paths. Only actuators keep
classes of defaults, because their defaults are of shortcuts that change each other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from carom.description.pose import IDENTITY
from carom.description.transform import compose, inverse, rotate, rotation_matrix
from carom.editing.elements import (
    IN_BODIES,
    ORIENTATIONS,
    UNBUILT_BODIES,
    copied,
    new,
    place,
    section,
    words,
)
from carom.editing.references import (
    ACTUATOR,
    BODY,
    CLASS,
    WORLD,
    attributes_of,
    kind_of,
    references,
)
from carom.files.xml_element import Element, PlacedElement
from carom.formats.mjcf.compiled.actuation.law import KINDS
from carom.formats.mjcf.compiled.context import AUTO, LAST_GROUP, CompiledContext
from carom.formats.mjcf.compiled.elements import Elements, Scope
from carom.formats.mjcf.compiled.names import LOST_BETWEEN_COPIES, full, in_order, resolved_by, scopes_of
from carom.formats.mjcf.compiled.shapes.geom import frame_between
from carom.formats.mjcf.defaults import MAIN, Attributes, class_defaults
from carom.formats.mjcf.frames import read_pose
from carom.native.products import turned_tensor

_RESOLVED = (
    "angle",
    "coordinate",
    "eulerseq",
    "meshdir",
    "texturedir",
    "assetdir",
    "autolimits",
    "strippath",
)
_OF_MASS = (
    "balanceinertia", "boundinertia", "boundmass", "inertiafromgeom", "inertiagrouprange", "settotalmass",
)  # fmt: skip
_COPIED = ("option", "size", "visual", "statistic", "custom", "extension", "keyframe")
_ASSETS_OF_MESHES = ("mesh", "hfield", "skin")
_FILES = (
    "file", "fileback", "filedown", "filefront", "fileleft", "fileright", "fileup",
)  # fmt: skip
_ANGLES = ("range", "ref", "springref")
_REFERRED = ("body", "joint", "geom", "site", "tendon", ACTUATOR)
_DRIVES = "drives"
_MOVED = ("joint", "jointinparent", "tendon", "site", "slidersite", "body")
_NO_TURN = IDENTITY.orientation


def flattened(context: CompiledContext) -> PlacedElement:
    """A document, whose includes and attached models have been read, as the root of a description.

    Its `<compiler>` has what cannot be said of each element: options of masses are made explicit by
    `carom.editing.masses`. Bodies and joints without names get some.

    Raises:
        DescriptionError: Something in it is broken.
    """
    return _Flattening(context).root


class _Flattening:
    def __init__(self, context: CompiledContext) -> None:
        self.root = new("mujoco", context.root, {"model": context.root.attributes.get("model", "")})
        if not self.root.attributes["model"]:
            self.root.attributes["model"] = context.file.stem
        self.elements = Elements()
        self.known: set[tuple[str, str]] = set()
        scope = Scope(context)
        compiler = section(self.root, "compiler")
        for stated in context.root.all("compiler"):
            kept = {name: text for name, text in stated.attributes.items() if name not in _RESOLVED}
            compiler.attributes.update(kept)
            compiler.children += [copied(child) for child in stated.children]
        compiler.attributes["angle"] = "radian"
        for tag in _COPIED:
            for stated in context.root.all(tag):
                self.root.children.append(copied(stated))
        world = section(self.root, "worldbody")
        for stated in context.root.all("worldbody"):
            self._content(world, stated, scope)
        self._name_below(world, WORLD)
        self.scopes = (scope, *self.elements.attached)
        self._assets()
        for tag, kind in (
            ("tendon", "tendon"), ("actuator", ""), ("equality", "equality"), ("contact", "pair"),
            ("sensor", ""), ("deformable", ""),
        ):  # fmt: skip
            self._section(tag, kind)
        self.root.children.sort(key=_order)

    def _content(self, out: Element, element: Element, scope: Scope) -> None:
        """Put the content of a body or of the world into `out`."""
        for child, within in self.elements.inside(element, scope):
            if child.tag == "body":
                self._body(out, child, within)
            elif child.tag in IN_BODIES:
                out.children.append(self._part(child, within))
            elif child.tag in UNBUILT_BODIES:
                # They are kept as they are; MuJoCo builds them.
                copy = copied(child)
                if any(name in copy.attributes for name in ("pos", *ORIENTATIONS)) or within.into != IDENTITY:
                    place(copy, within.pose(child, child.attributes))
                self._files(within.context, child, copy, within.context.compiler.mesh_directory)
                out.children.append(copy)
            else:
                raise within.context.error(child, f"<{child.tag}> is not known in a body")

    def _body(self, out: Element, element: Element, scope: Scope) -> None:
        context = scope.context
        body = new("body", element, element.attributes)
        child_class = body.attributes.pop("childclass", scope.child_class)
        self._place(body, element, scope, element.attributes)
        self._rename(body, element, scope, out)
        into = IDENTITY
        if context.compiler.global_frames:
            into = inverse(read_pose(context, element, element.attributes))
        out.children.append(body)
        self._content(body, element, replace(scope, child_class=child_class, into=into))

    def _part(self, element: Element, scope: Scope) -> Element:
        context = scope.context
        has_defaults = element.tag not in ("freejoint", "inertial")
        attributes: Attributes = dict(element.attributes)
        if has_defaults:
            attributes = dict(
                context.over(class_defaults(context, element, scope.child_class), element.attributes)
            )
        part = new(element.tag, element, attributes)
        part.attributes.pop("class", None)
        part.children = [copied(child) for child in element.children]
        if element.tag == "joint":
            self._joint(part, element, scope, attributes)
        elif element.tag == "light":
            if scope.into != IDENTITY:
                x, y, z = scope.point(context.triple(element, "pos", attributes.get("pos", "0 0 0")))
                a, b, c = context.triple(element, "dir", attributes.get("dir", "0 0 -1"))
                part.attributes["pos"] = words((x, y, z))
                part.attributes["dir"] = words(rotate(scope.into.orientation, (a, b, c)))
        elif element.tag == "inertial" and "fullinertia" in attributes:
            self._full_inertia(part, element, scope)
        elif element.tag in ("geom", "site") and "fromto" in attributes and scope.into != IDENTITY:
            self._between(part, element, scope, attributes)
        elif element.tag != "freejoint":
            self._place(part, element, scope, attributes)
        if element.tag == "freejoint" and context.compiler.align_free:
            part.attributes.setdefault("align", "true")
        self._rename(part, element, scope, new("body"))
        return part

    def _place(self, part: Element, element: Element, scope: Scope, attributes: Attributes) -> None:
        """State a pose as that in the body, by a position and a quaternion."""
        turns = [name for name in ORIENTATIONS if name in attributes]
        if scope.into == IDENTITY and turns in ([], ["quat"]):
            return
        place(part, scope.pose(element, attributes))

    def _joint(self, part: Element, element: Element, scope: Scope, attributes: Attributes) -> None:
        context, kind = scope.context, attributes.get("type", "hinge")
        if kind == "free":
            if context.compiler.align_free:
                part.attributes.setdefault("align", "true")
            return
        if kind in ("hinge", "ball") and context.compiler.degrees:
            for name in _ANGLES:
                if name in attributes:
                    text = attributes[name]
                    values = (
                        context.bounds(element, name, text)
                        if name == "range"
                        else (context.number(element, attributes, name, 0.0),)
                    )
                    part.attributes[name] = words(context.angle(value) for value in values)
        if scope.into != IDENTITY:
            x, y, z = context.triple(element, "pos", attributes.get("pos", "0 0 0"))
            part.attributes["pos"] = words(scope.point((x, y, z)))
            axis = context.triple(element, "axis", attributes.get("axis", "0 0 1"))
            part.attributes["axis"] = words(rotate(scope.into.orientation, axis))

    def _full_inertia(self, part: Element, element: Element, scope: Scope) -> None:
        """State a tensor in the axes of the body: MuJoCo takes no other ones with it."""
        pose = scope.pose(element, element.attributes)
        if pose.orientation != _NO_TURN:
            text = element.attributes["fullinertia"]
            a, b, c, d, e, f = scope.context.numbers(element, "fullinertia", text, 6, 6)
            tensor = np.array([[a, d, e], [d, b, f], [e, f, c]])
            t = turned_tensor(np.array(rotation_matrix(pose.orientation)), tensor)
            moments = (t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2])
            part.attributes["fullinertia"] = words(moments)
        place(part, replace(pose, orientation=_NO_TURN))

    def _between(self, part: Element, element: Element, scope: Scope, attributes: Attributes) -> None:
        """State the pose and the size of a shape that its ends give, in a frame that is turned."""
        context = scope.context
        own, half = frame_between(context, element, attributes["fromto"])
        sizes = context.singles(element, "size", attributes.get("size", ""))
        if not sizes:
            raise context.error(element, "a shape that its ends give needs a size")
        if attributes.get("type", "sphere") in ("capsule", "cylinder"):
            sizes = [sizes[0], half]
        else:
            sizes = [sizes[0], sizes[1] if len(sizes) > 1 else sizes[0], half]
        del part.attributes["fromto"]
        part.attributes["size"] = words(sizes)
        place(part, compose(scope.into, own))

    def _rename(self, part: Element, element: Element, scope: Scope, parent: Element) -> None:
        """Give an element its full name, and the full names of the assets and bodies that it names."""
        name = scope.name(element)
        kind = kind_of(part, parent)
        if name:
            part.attributes["name"] = name
            self.known.add((kind, name))
        for attribute, of in attributes_of(part, parent).items():
            if part.attributes.get(attribute):
                at = scope if of == BODY else replace(scope, suffix="")
                part.attributes[attribute] = full(at, part.attributes[attribute])

    def _name_below(self, body: Element, name: str) -> None:
        """Give bodies and joints that have no name one that is not used."""
        for child in body.children:
            if child.tag not in ("body", "joint", "freejoint"):
                continue
            kind = "body" if child.tag == "body" else "joint"
            if not child.attributes.get("name"):
                child.attributes["name"] = self._unused(kind, f"{name}_{kind}")
            if kind == "body":
                self._name_below(child, child.attributes["name"])

    def _assets(self) -> None:
        """The assets of the file and of all that it attaches, with absolute paths."""
        out = section(self.root, "asset")
        done: set[tuple[int, str]] = set()
        for scope in self.scopes:
            context = scope.context
            if (id(context), scope.prefix) in done:
                continue
            done.add((id(context), scope.prefix))
            for assets in context.root.all("asset"):
                for element in assets.children:
                    if element.tag != "model":
                        out.children.append(self._asset(element, scope))

    def _asset(self, element: Element, scope: Scope) -> Element:
        context = scope.context
        defaults = {} if element.tag in ("hfield", "skin") else class_defaults(context, element, None)
        asset = copied(element)
        asset.attributes = dict(context.over(defaults, element.attributes))
        asset.attributes.pop("class", None)
        name = asset.attributes.get("name") or Path(asset.attributes.get("file", "")).stem
        if name:
            asset.attributes["name"] = full(replace(scope, suffix=""), name)
        is_mesh = element.tag in _ASSETS_OF_MESHES
        compiler = context.compiler
        self._files(
            context, element, asset, compiler.mesh_directory if is_mesh else compiler.texture_directory
        )
        parent = new("asset")
        parent.children = [asset]
        for reference in references(parent):
            reference.restate(full(replace(scope, suffix=""), reference.name))
        return asset

    @staticmethod
    def _files(context: CompiledContext, element: Element, copy: Element, directory: str) -> None:
        """Make the names of files absolute; those that are not found are kept."""
        for name in _FILES:
            if text := copy.attributes.get(name):
                found = context.asset_file(element, text, directory)
                if found is not None:
                    copy.attributes[name] = str(found.absolute())

    def _section(self, tag: str, kind: str) -> None:
        """The elements of a section in the order that they have in MuJoCo."""
        found = [
            (at, copy)
            for scope in self.scopes
            for stated in scope.context.root.all(tag)
            for element in stated.children
            for at, copy in self._of_section(tag, kind, element, scope)
        ]
        if found:
            scopes, copies = zip(*found, strict=True)
            section(self.root, tag).children += in_order(copies, scopes)

    def _of_section(
        self, tag: str, kind: str, element: Element, scope: Scope
    ) -> Iterator[tuple[Scope, Element]]:
        parent = new(tag)
        for at in self._scopes_of(parent, element, scope):
            copy = copied(element)
            if kind and element.tag != "exclude":
                defaults = class_defaults(at.context, new(kind, element, element.attributes), None)
                copy.attributes = dict(at.context.over(defaults, element.attributes))
            if tag != "actuator":
                copy.attributes.pop("class", None)
            parent.children = [copy]
            for reference in references(parent):
                if reference.kind != CLASS:
                    kind_of_it = reference.kind
                    reference.restate(
                        resolved_by(at, reference.name, lambda name, of=kind_of_it: (of, name) in self.known)
                    )
            if copy.attributes.get("name"):
                copy.attributes["name"] = full(at, copy.attributes["name"])
                self.known.add((kind_of(copy, parent), copy.attributes["name"]))
            if tag == "actuator":
                self._keep_class(copy, at)
                self._name_actuator(copy)
            self._files(at.context, element, copy, at.context.compiler.mesh_directory)
            yield at, copy

    def _scopes_of(self, parent: Element, element: Element, scope: Scope) -> list[Scope]:
        """Where the names that an element states are known: in its file, or in copies by `<replicate>`."""
        parent.children = [element]
        wanted = [it for it in references(parent) if it.kind in _REFERRED]
        names = [it.name for it in wanted]
        copies = scopes_of(
            self.elements, scope, names, lambda place, name: (wanted[place].kind, name) in self.known
        )
        if parent.tag in ("actuator", "equality") and not all(
            (it.kind, full(at, it.name)) in self.known for at in copies for it in wanted
        ):
            scope.context.leave_out(element, *LOST_BETWEEN_COPIES)
            return []
        # An attached model need not have all; in the file itself, whoever compiles it says what is missing.
        return copies or ([] if scope in self.elements.attached else [scope])

    def _name_actuator(self, actuator: Element) -> None:
        """Give an actuator without a name one, by what it moves."""
        if not actuator.attributes.get("name"):
            moved = (actuator.attributes.get(what) for what in _MOVED)
            stem = f"{next((name for name in moved if name), WORLD)}_{actuator.tag}"
            actuator.attributes["name"] = self._unused(ACTUATOR, stem)

    def _unused(self, kind: str, stem: str) -> str:
        """A name of a kind that nothing has yet, which is noted."""
        name, number = stem, 1
        while (kind, name) in self.known:
            number += 1
            name = f"{stem}{number}"
        self.known.add((kind, name))
        return name

    def _keep_class(self, actuator: Element, scope: Scope) -> None:
        """Keep the defaults of an actuator, those for actuators only, as a class of the description."""
        context = scope.context
        own = actuator.attributes.pop("class", "") or MAIN
        if own not in context.classes and own != MAIN:
            raise context.error(actuator, f"there is no default class {own!r}")
        stated = {tag: it for tag, it in context.classes.get(own, {}).items() if tag in KINDS and it}
        if not stated:
            return
        name = scope.prefix + (_DRIVES if own == MAIN else own)
        actuator.attributes["class"] = name
        defaults = section(self.root, "default")
        if any(it.attributes.get("class") == name for it in defaults.children):
            return
        kept = new("default", actuator, {"class": name})
        kept.children = [new(tag, actuator, dict(attributes)) for tag, attributes in stated.items()]
        defaults.children.append(kept)


def options_of_mass(root: Element) -> dict[str, str]:
    """The options of the `<compiler>` of a description that change masses, other than by what is usual."""
    usual = {"inertiafromgeom": AUTO, "inertiagrouprange": f"0 {LAST_GROUP}", "balanceinertia": "false"}
    return {
        name: text
        for compiler in root.all("compiler")
        for name, text in compiler.attributes.items()
        if name in _OF_MASS and text != usual.get(name)
    }


def _order(element: Element) -> int:
    from carom.editing.elements import SECTIONS

    return SECTIONS.index(element.tag) if element.tag in SECTIONS else len(SECTIONS)
