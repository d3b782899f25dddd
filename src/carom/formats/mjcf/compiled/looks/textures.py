"""`<texture>`: images of files and made ones, for materials and the sky."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from carom.description.pose import Vector3
from carom.description.texture import LateTexels, Texture
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.looks.builtin_textures import made_texture
from carom.formats.mjcf.defaults import Attributes, class_defaults
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown

_BUILTIN = ("gradient", "checker", "flat")
_MARKS = ("none", "edge", "cross", "random")
_KINDS = ("2d", "cube", "skybox")
_SIDE_FILES = ("fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")
_SIDES = "RLUDFB"
_MAX_SIDE = 8192
# Sky and cubes without a stated width are for files only.
_CUBE = 6


def read_texture(context: CompiledContext, element: Element) -> Texture | None:
    """The image of a `<texture>`; None if its file is missing, or there is none.

    Raises:
        DescriptionError: An attribute is not one that MJCF knows.
    """
    made = context.textures.get(id(element))
    if made is None:
        element.note()
        attributes = layered(class_defaults(context, element, None), element.attributes)
        made = context.textures[id(element)] = element, _read(context, element, attributes)
    return made[1]


def _read(context: CompiledContext, element: Element, attributes: Attributes) -> Texture | None:
    kind = attributes.get("type", "cube")
    if kind not in _KINDS:
        raise context.error(element, f"type={shown(kind)} must be one of {', '.join(_KINDS)}")
    is_cube = kind != "2d"
    builtin = attributes.get("builtin", "none")
    if builtin != "none":
        return _made(context, element, attributes, builtin, is_cube=is_cube)
    named = [attributes[name] for name in ("file",) if name in attributes]
    if is_cube and not named:
        named = [attributes[name] for name in _SIDE_FILES if name in attributes]
        if len(named) not in (0, _CUBE):
            context.leave_out(element, "it is not drawn", "a cube has six images, or one")
            return None
    found = [_file(context, element, name) for name in named]
    files = tuple(file for file in found if file is not None)
    if not files or len(files) != len(found):
        if named:
            context.leave_out(element, "none for the dynamics", "its file is missing")
        return None
    return Texture(None, files, is_cube, _layout(context, element, attributes) if is_cube else ())


def _file(context: CompiledContext, element: Element, name: str) -> Path | None:
    return context.asset_file(element, name, context.compiler.texture_directory)


def _layout(context: CompiledContext, element: Element, attributes: Attributes) -> tuple[str, ...]:
    rows, columns = (
        int(x) for x in context.numbers(element, "gridsize", attributes.get("gridsize", "1 1"), 2, 2)
    )
    if (rows, columns) == (1, 1):
        return ()
    letters = attributes.get("gridlayout", "." * max(rows * columns, 0))
    if len(letters) != rows * columns or not set(letters) <= {*_SIDES, "."}:
        raise context.error(
            element, f"gridlayout={shown(letters)}: {rows * columns} letters of {_SIDES} or . are needed"
        )
    return tuple(letters[row * columns : (row + 1) * columns] for row in range(rows))


def _made(
    context: CompiledContext, element: Element, attributes: Attributes, builtin: str, *, is_cube: bool
) -> Texture:
    mark = attributes.get("mark", "none")
    for name, value, known in (("builtin", builtin, _BUILTIN), ("mark", mark, _MARKS)):
        if value not in known:
            raise context.error(element, f"{name}={shown(value)} must be one of {', '.join(known)}")
    width, height = (int(context.number(element, attributes, name, 0.0)) for name in ("width", "height"))
    if not 0 < width <= _MAX_SIDE or not (is_cube or 0 < height <= _MAX_SIDE):
        raise context.error(
            element,
            f"width and height of a builtin texture must be from 1 to {_MAX_SIDE}, not {width}, {height}",
        )
    charge("pixels", width * (_CUBE * width if is_cube else height))
    make = partial(
        made_texture,
        builtin,
        width,
        height,
        _rgb(context, element, attributes, "rgb1", "0.8 0.8 0.8"),
        _rgb(context, element, attributes, "rgb2", "0.5 0.5 0.5"),
        mark,
        _rgb(context, element, attributes, "markrgb", "0 0 0"),
        context.number(element, attributes, "random", 0.01),
        is_cube=is_cube,
    )
    return Texture(is_cube=is_cube, late=LateTexels(make))


def _rgb(
    context: CompiledContext, element: Element, attributes: Attributes, name: str, usual: str
) -> Vector3:
    red, green, blue = context.numbers(element, name, attributes.get(name, usual), 3, 3)
    return (red, green, blue)
