"""Keyframes of the models that a file attaches, as keys of its description."""

from __future__ import annotations

from pathlib import Path

from carom.editing.elements import new, section, words
from carom.file_bodies import compiled_mjcf_bodies
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.keyframes.attached import has_keys
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import Ignored
from carom.formats.search import AssetSearch

_KEYFRAME = "keyframe"


def add_attached_keys(root: Element, context: CompiledContext, search: AssetSearch) -> list[Ignored]:
    """Add the keys of the models that a file attaches to its description, in which its own keys are.

    They have the names and numbers that `World.load` gives them; a description has the same joints and
    actuators in the same order as the file.

    Args:
        root: The description.
        context: The file, with all that it attaches.
        search: The search for files.

    Returns:
        What these keys say and the description lacks.

    Raises:
        DescriptionError: A key is broken, two have one name, or something else in the file is wrong.
    """
    if not any(has_keys(other) for other in context.attached.values()):
        return []
    cursor = Cursor(MJCF_RULES)
    model, _ = compiled_mjcf_bodies(context.file, search, flags=0, cursor=cursor, missing_meshes=True)
    keys = section(root, _KEYFRAME)
    own = sum(len(list(stated.all("key"))) for stated in root.all(_KEYFRAME))
    for key in list(model.keyframes.values())[own:]:
        numbers = {
            "time": (key.time,) if key.time else (),
            "qpos": key.positions,
            "qvel": key.velocities,
            "ctrl": key.controls,
            "act": key.activations,
        }
        stated = {name: words(values) for name, values in numbers.items() if values}
        keys.children.append(new("key", keys, {"name": key.name, **stated}))
    files = {file.absolute() for other in context.attached.values() for file in _files(other)}
    of_attached = (it for it in cursor.ignored() if it.file.absolute() in files)
    return [it for it in of_attached if _KEYFRAME in it.element.split("/")]


def _files(context: CompiledContext) -> list[Path]:
    """The files of a model and of all that it attaches."""
    return [context.file, *(file for other in context.attached.values() for file in _files(other))]
