"""Keyframes of a description while it changes: each number stays with the joint or actuator it is of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, rotate
from carom.editing.elements import error, numbers, pairs, walk, words
from carom.files.xml_element import Element

_SIZES = {"free": (7, 6), "ball": (4, 3)}
_OWN_ACTIVATION = ("intvelocity", "cylinder", "muscle")
_BALL = (1.0, 0.0, 0.0, 0.0)


class Keys:
    """The keys of descriptions, each number with the element that it is of.

    Args:
        roots: Descriptions, whose keys are read now.
    """

    def __init__(self, *roots: Element) -> None:
        self._kept: list[tuple[Element, dict[str, dict[int, tuple[float, ...]]]]] = []
        # Ids are of use while the elements are there.
        self._elements: list[Element] = []
        for root in roots:
            keys = [it for each in root.all("keyframe") for it in each.all("key")]
            if not keys:
                continue
            joints, actuators, mocaps = joints_of(root), _actuators(root), _mocaps(root)
            self._elements += [*joints, *actuators, *mocaps]
            for key in keys:
                self._kept.append(
                    (
                        key,
                        {
                            "qpos": _split(
                                key, "qpos", joints, [len(_start(it, above)) for it, above in _placed(root)]
                            ),
                            "qvel": _split(key, "qvel", joints, [_size(it)[1] for it in joints]),
                            "ctrl": _split(key, "ctrl", actuators, [1] * len(actuators)),
                            "act": _split(key, "act", _active(root), [1] * len(_active(root))),
                            "mpos": _split(key, "mpos", mocaps, [3] * len(mocaps)),
                            "mquat": _split(key, "mquat", mocaps, [4] * len(mocaps)),
                        },
                    )
                )

    def move(self, root: Element, pose: Pose) -> None:
        """Move what keys say of the free joints and mocap bodies of a description by a pose of its world."""
        if pose == IDENTITY:
            return
        free = {id(it) for it in joints_of(root) if _size(it)[0] == 7}
        for _, kept in self._kept:
            for which in free & set(kept["qpos"]):
                x, y, z, w, i, j, k = kept["qpos"][which]
                moved = compose(pose, Pose((x, y, z), (i, j, k, w)))
                i, j, k, w = moved.orientation
                kept["qpos"][which] = (*moved.position, w, i, j, k)
            for which in free & set(kept["qvel"]):
                x, y, z, *turning = kept["qvel"][which]
                kept["qvel"][which] = (*rotate(pose.orientation, (x, y, z)), *turning)
            for body in _mocaps(root):
                which = id(body)
                if which in kept["mpos"]:
                    x, y, z = kept["mpos"][which]
                    kept["mpos"][which] = compose(pose, Pose((x, y, z))).position
                if which in kept["mquat"]:
                    w, i, j, k = kept["mquat"][which]
                    i, j, k, w = compose(pose, Pose(orientation=(i, j, k, w))).orientation
                    kept["mquat"][which] = (w, i, j, k)

    def united(self, root: Element) -> list[Element]:
        """Make one of keys of a description that have the same name: the first; gives the others."""
        firsts: dict[str, tuple[Element, dict[str, dict[int, tuple[float, ...]]]]] = {}
        others: list[Element] = []
        for key, kept in self._kept:
            name = key.attributes.get("name", "")
            if not name or name not in firsts:
                firsts.setdefault(name, (key, kept))
                continue
            first, all_of_it = firsts[name]
            for what, numbers_of in kept.items():
                all_of_it[what] |= numbers_of
                if what in key.attributes:
                    first.attributes.setdefault(what, key.attributes[what])
            others.append(key)
        self._kept = [(key, kept) for key, kept in self._kept if key not in others]
        return [it for it in others if any(it in each.children for each in root.all("keyframe"))]

    def write(self, root: Element) -> None:
        """State all numbers in the order of a description, which has the elements of all others now.

        Joints that a key says nothing of are at their references, and what else it lacks is 0.
        """
        joints = _placed(root)
        actuators, mocaps = _actuators(root), _mocaps(root)
        for key, kept in self._kept:
            _put(key, "qpos", kept["qpos"], [(it, _start(it, above)) for it, above in joints])
            _put(key, "qvel", kept["qvel"], [(it, (0.0,) * _size(it)[1]) for it, _ in joints])
            _put(key, "ctrl", kept["ctrl"], [(it, (0.0,)) for it in actuators])
            _put(key, "act", kept["act"], [(it, (0.0,)) for it in _active(root)])
            _put(key, "mpos", kept["mpos"], [(it, numbers(it, "pos", (0.0, 0.0, 0.0))) for it in mocaps])
            _put(key, "mquat", kept["mquat"], [(it, numbers(it, "quat", _BALL)) for it in mocaps])


def _put(
    key: Element,
    name: str,
    kept: dict[int, tuple[float, ...]],
    order: Iterable[tuple[Element, tuple[float, ...]]],
) -> None:
    if name in key.attributes:
        found = [kept.get(id(element), usual) for element, usual in order]
        text = words(number for each in found for number in each)
        if text:
            key.attributes[name] = text
        else:
            del key.attributes[name]


def _split(key: Element, name: str, of: list[Element], sizes: list[int]) -> dict[int, tuple[float, ...]]:
    values = numbers(key, name)
    if not values:
        return {}
    found, at = {}, 0
    for element, size in zip(of, sizes, strict=True):
        if at + size <= len(values):
            found[id(element)] = values[at : at + size]
        at += size
    if len(values) > at:
        raise error(key, f"{name} has {len(values)} numbers; the description needs {at}")
    return found


def _placed(root: Element) -> list[tuple[Element, Element]]:
    """The joints in the order of `qpos`, with their bodies."""
    return [
        (element, body)
        for world in root.all("worldbody")
        for body, element in _in_order(world)
        if element.tag in ("joint", "freejoint")
    ]


def _in_order(body: Element) -> Iterator[tuple[Element, Element]]:
    # A body's own joints count before those of the bodies in it, wherever they stand.
    for child in body.children:
        if child.tag in ("joint", "freejoint"):
            yield body, child
    for child in body.children:
        if child.tag == "body":
            yield from _in_order(child)


def joints_of(root: Element) -> list[Element]:
    """The joints of a description, in the order of `qpos`."""
    return [joint for joint, _ in _placed(root)]


def _mocaps(root: Element) -> list[Element]:
    found = (it for world in root.all("worldbody") for it in walk(world))
    return [it for it in found if it.tag == "body" and it.attributes.get("mocap") == "true"]


def _actuators(root: Element) -> list[Element]:
    return [it for section in root.all("actuator") for it in section.children]


def _active(root: Element) -> list[Element]:
    """The actuators that have an activation."""
    classes = {it.attributes.get("class", ""): it for _, it in pairs(root) if it.tag == "default"}
    return [it for it in _actuators(root) if _is_active(it, classes.get(it.attributes.get("class", "")))]


def _is_active(actuator: Element, defaults: Element | None) -> bool:
    stated = [actuator.attributes]
    if defaults is not None:
        stated += [it.attributes for it in defaults.children if it.tag in (actuator.tag, "general")]
    if actuator.tag in _OWN_ACTIVATION:
        return True
    if actuator.tag == "position":
        time = next((each["timeconst"] for each in stated if "timeconst" in each), "0")
        return float(time) > 0.0
    if actuator.tag == "general":
        return next((each["dyntype"] for each in stated if "dyntype" in each), "none") != "none"
    return False


def _size(joint: Element) -> tuple[int, int]:
    kind = "free" if joint.tag == "freejoint" else joint.attributes.get("type", "hinge")
    return _SIZES.get(kind, (1, 1))


def _start(joint: Element, body: Element) -> tuple[float, ...]:
    """The reference position of a joint, as a key states it."""
    size = _size(joint)[0]
    if size == 1:
        return (numbers(joint, "ref", (0.0,))[0],)
    if size == 4:
        return _BALL
    return (*numbers(body, "pos", (0.0, 0.0, 0.0)), *numbers(body, "quat", _BALL))
