"""Moving elements of a description from one frame into another."""

from __future__ import annotations

from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose, rotate, turn_of_z
from carom.editing.elements import error, numbers, place, pose_of, words
from carom.files.xml_element import Element


def put_into(element: Element, pose: Pose) -> None:
    """Move an element that is in a frame into the body or world in which that has a pose."""
    if pose == IDENTITY:
        return
    if element.tag == "light":
        point = compose(pose, Pose(_three(element, "pos", (0.0, 0.0, 0.0)))).position
        element.attributes["pos"] = words(point)
        element.attributes["dir"] = words(rotate(pose.orientation, _three(element, "dir", (0.0, 0.0, -1.0))))
        return
    own = between(element) if "fromto" in element.attributes else pose_of(element)
    place(element, compose(pose, own))


def between(element: Element) -> Pose:
    """The pose of a shape that its ends give, which then has a size instead."""
    ax, ay, az, bx, by, bz = numbers(element, "fromto")
    x, y, z = ax - bx, ay - by, az - bz
    length = (x * x + y * y + z * z) ** 0.5
    if length == 0.0:
        raise error(element, "fromto: both ends are the same point")
    first, *more = numbers(element, "size", (0.0,))
    is_round = element.attributes.get("type", "sphere") in ("capsule", "cylinder")
    others = (first,) if is_round else (first, more[0] if more else first)
    element.attributes["size"] = words((*others, 0.5 * length))
    del element.attributes["fromto"]
    middle = (0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz))
    return Pose(middle, turn_of_z((x / length, y / length, z / length)))


def _three(element: Element, name: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = numbers(element, name, default)
    return (x, y, z)
