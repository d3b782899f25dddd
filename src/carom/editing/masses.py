"""Masses of a description that options of its `<compiler>` decide, stated by the bodies themselves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from carom.description import Inertial
from carom.description.transform import rotation_matrix
from carom.editing.elements import bodies, copied, new, place, words
from carom.editing.flattening import options_of_mass
from carom.file_bodies import compiled_mjcf_bodies
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.model import CompiledModel
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.reading.cursor import Cursor
from carom.formats.search import AssetSearch
from carom.native.products import turned_tensor

_NO_TURN = (0.0, 0.0, 0.0, 1.0)


def compiled(root: Element, file: Path, search: AssetSearch, cursor: Cursor | None = None) -> CompiledModel:
    """A description as MuJoCo compiles it; raises `DescriptionError` if something in it is wrong."""
    cursor = cursor or Cursor(MJCF_RULES)
    return compiled_mjcf_bodies(file, search, flags=0, cursor=cursor, root=copied(root))[0]


def state_masses(root: Element, file: Path, search: AssetSearch) -> None:
    """Give each body its mass by an `<inertial>`, if options change it, and drop these options.

    Raises:
        DescriptionError: Something in the description is wrong.
    """
    options = options_of_mass(root)
    if options:
        state_all_masses(root, file, search)
    for compiler in root.all("compiler"):
        for name in options:
            compiler.attributes.pop(name, None)
        for name in ("inertiafromgeom", "inertiagrouprange", "balanceinertia"):
            compiler.attributes.pop(name, None)


def state_all_masses(root: Element, file: Path, search: AssetSearch) -> None:
    """Give each body its mass by an `<inertial>`; raises `DescriptionError`."""
    model = compiled(root, file, search)
    found = {link.name: link.inertial for placed in model.robots for link in placed.robot.links}
    for body in bodies(root):
        state_mass(body, found[body.attributes["name"]])


def state_mass(body: Element, inertial: Inertial) -> None:
    """Give a body a mass by an `<inertial>`, as its first element."""
    body.children = [child for child in body.children if child.tag != "inertial"]
    body.children.insert(0, inertial_element(inertial, body))


def inertial_element(inertial: Inertial, like: Element | None = None) -> Element:
    """The `<inertial>` of a link."""
    element = new("inertial", like)
    a, b, c, d, e, f = inertial.tensor
    pose = inertial.frame
    if b or c or e:
        if pose.orientation != _NO_TURN:
            turn = np.array(rotation_matrix(pose.orientation))
            t = turned_tensor(turn, np.array([[a, b, c], [b, d, e], [c, e, f]]))
            a, b, c, d, e, f = (t[0, 0], t[0, 1], t[0, 2], t[1, 1], t[1, 2], t[2, 2])
        moments = {"fullinertia": words((a, d, f, b, c, e))}
        pose = replace(pose, orientation=_NO_TURN)
    else:
        moments = {"diaginertia": words((a, d, f))}
    place(element, pose)
    element.attributes = {**element.attributes, "mass": words((inertial.mass,)), **moments}
    return element
