"""Loading of Gazebo world files: scenes whose models are in separate files."""

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
    """A text as a whole number or else as a number, if possible; otherwise unchanged."""
    if is_int(text):
        return int(text)
    return float(text) if is_float(text) else text


def parse_text(text: str) -> Any:
    """The parsed words of a text: None without words, one value, or a list of values of the same type."""
    words = text.split()
    if len(words) < 2:
        return parse_number(words[0]) if words else None
    if only_contains_int(words):
        return [int(word) for word in words]
    return [float(word) for word in words] if only_contains_float(words) else words


def parseModel(model_xml: ElementTree.Element, urdffilepath: str) -> dict[str, Any]:
    """The data of a `<model>`: its attributes, included file and pose.

    Args:
        model_xml: The element.
        urdffilepath: Not used.

    Returns:
        The attributes, an empty list `children` and, if given, `uri`, `pose_xyz` [m] and `pose_rpy` [rad].
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
    """Loads the included files of the models of a world, at their poses, as bodies that do not move.

    Args:
        p: `pybullet` or a `BulletClient`.
        filepath: The world file.

    Returns:
        All models by name, see `parseModel`.

    Raises:
        OSError: The file cannot be read.
        xml.etree.ElementTree.ParseError: The file is not valid XML.
        pybullet.error: An included file cannot be loaded.
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
