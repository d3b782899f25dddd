"""The models of a Gazebo world file: a scene of models that stand in files of their own."""

from __future__ import annotations

import logging
from typing import Any
from xml.etree import ElementTree

_log = logging.getLogger(__name__)
_PREFIX = "model://"


def is_int(text: Any) -> bool:
    """Whether a text is a whole number."""
    return _is(int, text)


def is_float(text: Any) -> bool:
    """Whether a text is a number."""
    return _is(float, text)


def _is(kind: type, text: Any) -> bool:
    try:
        kind(text)
    except (TypeError, ValueError):
        return False
    return True


def only_contains_int(stringlist: list[str]) -> bool:
    """Whether all texts are whole numbers."""
    return all(map(is_int, stringlist))


def only_contains_float(stringlist: list[str]) -> bool:
    """Whether all texts are numbers."""
    return all(map(is_float, stringlist))


def parse_number(text: str) -> int | float | str:
    """A text as a whole number if it is one, as a number if it is one, or as it is."""
    if is_int(text):
        return int(text)
    return float(text) if is_float(text) else text


def parse_text(text: str) -> Any:
    """The words of a text: None if there are none, one alone, several as a list of one kind."""
    words = text.split()
    if len(words) < 2:
        return parse_number(words[0]) if words else None
    if only_contains_int(words):
        return [int(word) for word in words]
    return [float(word) for word in words] if only_contains_float(words) else words


def parseModel(model_xml: ElementTree.Element, urdffilepath: str) -> dict[str, Any]:
    """What a `<model>` says: its attributes, the file it includes, where it is.

    Args:
        model_xml: The element.
        urdffilepath: Not used.

    Returns:
        The attributes, an empty list `children` and, where they are stated, `uri`, `pose_xyz` and `pose_rpy`.
    """
    model: dict[str, Any] = {**model_xml.attrib, "children": []}
    uri = model_xml.findtext("include/uri")
    if uri is not None:
        uri = uri.strip()
        model["uri"] = f"models/{uri[len(_PREFIX) :]}/model.sdf" if uri.startswith(_PREFIX) else uri
    pose = parse_text(model_xml.findtext("pose", ""))
    if isinstance(pose, list) and len(pose) == 6:
        model["pose_xyz"], model["pose_rpy"] = pose[:3], pose[3:]
    return model


def parseWorld(p: Any, filepath: str) -> dict[str, dict[str, Any]]:
    """Loads the files that the models of a world include, where it puts them, as bodies that do not move.

    Args:
        p: `pybullet`, or a client of it.
        filepath: The world file.

    Returns:
        All models by name, see `parseModel`.

    Raises:
        OSError: The file cannot be read.
        xml.etree.ElementTree.ParseError: It is no XML.
        pybullet.error: A file that it includes cannot be loaded.
    """
    models = {}
    for element in ElementTree.parse(filepath).getroot().iter("model"):
        model = parseModel(element, "")
        models[element.attrib["name"]] = model
        if "uri" not in model:
            continue
        turn = p.getQuaternionFromEuler(model.get("pose_rpy", (0, 0, 0)))
        bodies = p.loadSDF(model["uri"])
        for body in bodies:
            old = p.getBasePositionAndOrientation(body)
            new = p.multiplyTransforms(model.get("pose_xyz", (0, 0, 0)), turn, *old)
            p.resetBasePositionAndOrientation(body, *new)
            p.changeDynamics(body, -1, mass=0)
        _log.info("%s: bodies %s", element.attrib["name"], bodies)
    return models
