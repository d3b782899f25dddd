"""`<skin>`: surfaces that follow bodies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Material
from carom.description.pose import Pose
from carom.description.transform import rotation_matrix
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.deformables.file_skin import FileBone, FileSkin
from carom.formats.mjcf.compiled.deformables.skn import RawBone, RawSkin, read_skn
from carom.formats.mjcf.compiled.elements import WORLD, Scope
from carom.formats.mjcf.compiled.looks.material import read_material
from carom.formats.mjcf.compiled.names import Names, full
from carom.formats.robot.context import shown
from carom.native.products import length, product

Floats = NDArray[np.float64]
_SECTIONS = ("asset", "deformable")
_PLAIN = (0.0, 0.0, 0.0)
_LARGEST_NUMBER = 2.0**31


def read_skins(scope: Scope, names: Names) -> Iterator[FileSkin]:
    """The skins of a file and of all that it attaches; raises `DescriptionError`."""
    for each in (scope, *names.elements.attached):
        for tag in _SECTIONS:
            for section in each.context.root.all(tag):
                for element in section.all("skin"):
                    skin = _skin(each, element, names, is_main=each is scope)
                    if skin is not None:
                        yield skin


def _skin(scope: Scope, element: Element, names: Names, *, is_main: bool) -> FileSkin | None:
    context, attributes = scope.context, element.attributes
    element.note()
    if attributes.get("file"):
        path = context.asset_file(element, attributes["file"], context.compiler.mesh_directory)
        if path is None:
            raise context.not_found(element, attributes["file"])
        raw = read_skn(path)
    else:
        raw = _stated(scope, element)
    count = len(raw.vertices)
    if not count or not len(raw.faces) or not raw.bones:
        raise context.error(element, "a skin needs vertices, faces and bones, or a file with them")
    if len(raw.coordinates) not in (0, count):
        raise context.error(element, f"texcoord has {len(raw.coordinates)} pairs; there are {count} vertices")
    if not 0 <= raw.faces.min() <= raw.faces.max() < count:
        raise context.error(element, f"a face names a vertex that is not there; there are {count}")
    numbers = [raw.vertices, raw.coordinates, *(part for it in raw.bones for part in (it.bind, it.weights))]
    if not all(np.isfinite(part).all() for part in numbers):
        raise context.error(element, "a number of the skin is not finite")
    known = {*names.bodies, *names.nodes, WORLD}
    total = np.zeros(count)
    for bone in raw.bones:
        body = full(scope, bone.body)
        if body not in known and not is_main:
            return None
        if body not in known:
            raise context.error(element, f"there is no body {shown(bone.body)}, which is a bone")
        if not len(bone.vertices) or len(bone.vertices) != len(bone.weights):
            raise context.error(
                element, f"bone {shown(bone.body)} needs as many weights as vertices, 1 or more"
            )
        if not 0 <= bone.vertices.min() <= bone.vertices.max() < count:
            raise context.error(
                element, f"bone {shown(bone.body)} names a vertex that is not there; there are {count}"
            )
        if not bone.bind[3:].any():
            raise context.error(element, f"bone {shown(bone.body)}: bindquat is 0")
        np.add.at(total, bone.vertices, bone.weights)
    if total.min() <= 0.0:
        raise context.error(
            element, f"the weights of vertex {int(total.argmin())} do not add up to more than 0"
        )
    return FileSkin(
        scope.name(element),
        raw.vertices,
        raw.faces,
        raw.coordinates * np.array((1.0, -1.0)) + np.array((0.0, 1.0)) if len(raw.coordinates) else None,
        [_bone(scope, bone, raw.vertices, total) for bone in raw.bones],
        context.number(element, attributes, "inflate", 0.0),
        _material(scope, element, is_mapped=len(raw.coordinates) > 0),
        int(context.number(element, attributes, "group", 0.0)),
    )


def _bone(scope: Scope, bone: RawBone, vertices: Floats, total: Floats) -> FileBone:
    x, y, z, *turn = bone.bind.tolist()
    w, i, j, k = (np.array(turn) / length(np.array(turn))).tolist()
    bind = Pose((x, y, z), (i, j, k, w))
    apart = vertices[bone.vertices] - np.array(bind.position)
    points = product(apart, np.array(rotation_matrix(bind.orientation)))
    return FileBone(full(scope, bone.body), bone.vertices, points, bone.weights / total[bone.vertices])


def _material(scope: Scope, element: Element, *, is_mapped: bool) -> Material:
    material = read_material(scope.context, element, element.attributes, _PLAIN)
    image = material.image
    if image is not None and (image.is_cube or not is_mapped):
        why = "it is a cube" if image.is_cube else "the skin has no texcoord"
        scope.context.leave_out(element, "the skin has no texture", why, "material")
        return replace(material, image=None)
    return material


def _stated(scope: Scope, element: Element) -> RawSkin:
    """What the element itself lists."""
    vertices = _rows(scope, element, "vertex", 3)
    bones: list[RawBone] = []
    for bone in element.all("bone"):
        bone.note()
        position = scope.context.numbers(bone, "bindpos", scope.context.required(bone, "bindpos"), 3, 3)
        turn = scope.context.numbers(bone, "bindquat", scope.context.required(bone, "bindquat"), 4, 4)
        weights = scope.context.singles(bone, "vertweight", scope.context.required(bone, "vertweight"))
        bones.append(
            RawBone(
                scope.context.required(bone, "body"),
                np.array([*position, *turn]),
                _rows(scope, bone, "vertid", 1).astype(np.int32).reshape(-1),
                np.array(weights),
            )
        )
    faces = _rows(scope, element, "face", 3).astype(np.int32)
    return RawSkin(vertices, _rows(scope, element, "texcoord", 2), faces, bones)


def _rows(scope: Scope, element: Element, name: str, width: int) -> Floats:
    found = scope.context.singles(element, name, element.attributes.get(name, ""))
    if len(found) % width or any(abs(number) >= _LARGEST_NUMBER for number in found):
        raise scope.context.error(element, f"{name} needs {width} numbers for each")
    return np.array(found).reshape(-1, width)
