"""The readings of frames besides poses: from rows of all frames to arrays by names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description.joint import ONE_AXIS
from carom.replay.following import FoundBody, unique
from carom.replay.replay import (
    Floats,
    ReplayActuator,
    ReplayBody,
    ReplayContacts,
    ReplayJoint,
    ReplayLink,
    ReplayTendons,
)
from carom.viewer.readings import COLUMNS

_POSE = 7
# More links and joints than a body has.
_MANY = 1 << 24
_ONE_DOF = tuple(kind.value for kind in ONE_AXIS)

Numbers = NDArray[np.int64]
_ByPlace = dict[tuple[int, int], tuple[Numbers, Floats]]
_NOTHING: tuple[Numbers, Floats] = (np.zeros(0, dtype=np.int64), np.zeros((0, 2)))


class Tables:
    """Rows of readings by the name of their array, each with the number of its frame."""

    def __init__(self) -> None:
        self._rows: dict[str, list[tuple[Numbers, NDArray[np.float32]]]] = {}

    def take(self, at: int, header: Mapping[str, Any], numbers: NDArray[np.float32]) -> None:
        """Takes the readings of frames that share a header.

        Args:
            at: Number of the first of them.
            header: What they share.
            numbers: (frames, numbers) the numbers of each; readings come after the poses.

        Raises:
            ValueError: There are readings of an unknown name, or fewer numbers than the header says.
        """
        count, first = len(numbers), _POSE * header["poses"]
        for name, rows in header.get("blocks", ()):
            columns = COLUMNS.get(name)
            if columns is None:
                known = ", ".join(COLUMNS)
                raise ValueError(f"frame {at} has readings {name!r}; this version of Carom knows {known}")
            end = first + rows * columns
            if end > numbers.shape[1]:
                raise ValueError(f"frame {at} has {numbers.shape[1]} numbers, too few for its {name}")
            frames = np.repeat(np.arange(at, at + count), rows)
            table = numbers[:, first:end].reshape(count * rows, columns)
            self._rows.setdefault(name, []).append((frames, table))
            first = end

    def fill(self, bodies: Sequence[FoundBody], count: int) -> dict[str, ReplayBody]:
        """The bodies with what is read of them, by name; `count` is the number of frames."""
        joints, links = self._by_place("joints", 2), self._by_place("links", 2)
        actuators, sensors = self._by_place("actuators", 2), self._by_place("sensors", 2)
        return {
            body.name: ReplayBody(
                name=body.name,
                number=body.header["body"],
                file=body.header.get("path"),
                present=body.present,
                links=_links(body, links, count),
                joints=_joints(body, joints, count),
                actuators=_actuators(body, actuators, count),
                sensors=_sensors(body, sensors, count),
                looks=body.looks,
            )
            for body in bodies
        }

    def contacts(self, bodies: Sequence[FoundBody]) -> ReplayContacts:
        """The contacts of all frames."""
        frames, rows = self._table("contacts")
        places = rows[:, :4].astype(np.int64)
        body_a, link_a = _names(bodies, frames, places[:, 0], places[:, 1])
        body_b, link_b = _names(bodies, frames, places[:, 2], places[:, 3])
        return ReplayContacts(
            frames,
            body_a,
            link_a,
            body_b,
            link_b,
            rows[:, 4:7],
            rows[:, 7:10],
            rows[:, 10],
            rows[:, 11:14],
            rows[:, 14],
            rows[:, 15],
        )

    def tendons(self, bodies: Sequence[FoundBody]) -> ReplayTendons:
        """The pieces of the tendons of all frames."""
        frames, rows = self._table("tendons")
        numbers = rows[:, 0].astype(np.int64)
        names, _ = _names(bodies, frames, numbers, np.zeros_like(numbers))
        return ReplayTendons(frames, names, rows[:, 1:4], rows[:, 4:7], rows[:, 7], rows[:, 8] != 0.0)

    def _table(self, name: str) -> tuple[Numbers, Floats]:
        pieces = self._rows.get(name, [])
        empty = np.zeros(0, dtype=np.int64), np.zeros((0, COLUMNS[name]))
        frames = np.concatenate([empty[0], *(frames for frames, _ in pieces)])
        return frames, np.concatenate([empty[1], *(rows.astype(np.float64) for _, rows in pieces)])

    def _by_place(self, name: str, first: int) -> _ByPlace:
        """Frames and the columns from one on, by the first two columns: body, and link or joint."""
        frames, rows = self._table(name)
        body, place = rows[:, 0].astype(np.int64), rows[:, 1].astype(np.int64)
        return {
            (int(body[found[0]]), int(place[found[0]])): (frames[found], rows[found, first:])
            for found in _groups(body * _MANY + place)
        }


def _groups(keys: Numbers) -> Iterator[Numbers]:
    """The rows of each key."""
    order = np.argsort(keys, kind="stable")
    ends = np.flatnonzero(np.diff(keys[order])) + 1
    return (rows for rows in np.split(order, ends) if len(rows))


def _names(
    bodies: Sequence[FoundBody], frames: Numbers, numbers: Numbers, links: Numbers
) -> tuple[NDArray[np.str_], NDArray[np.str_]]:
    """Names of bodies and of their links, by their numbers in frames; "" for those that are not there."""
    longest = max((len(name) for body in bodies for name in (body.name, *body.link_names)), default=1)
    of_bodies, of_links = (np.zeros(len(frames), dtype=f"<U{max(longest, 1)}") for _ in range(2))
    for rows in _groups(numbers):
        for body in bodies:
            if body.header["body"] == numbers[rows[0]]:
                there = rows[body.present[frames[rows]]]
                of_bodies[there] = body.name
                there = there[links[there] < len(body.link_names)]
                of_links[there] = np.array(body.link_names)[links[there]]
    return of_bodies, of_links


def _series(body: FoundBody, place: int, found: _ByPlace, columns: int, count: int) -> Floats | None:
    """(frames, columns) what is read at a place of a body; NaN elsewhere, None if there is nothing."""
    frames, rows = found.get((body.header["body"], place), _NOTHING)
    there = body.present[frames]
    if not there.any():
        return None
    series = np.full((count, columns), np.nan)
    series[frames[there]] = rows[there, :columns]
    return series


def _links(body: FoundBody, found: _ByPlace, count: int) -> dict[str, ReplayLink]:
    links = {}
    for place, name in enumerate(body.link_names):
        read = _series(body, place - 1, found, 12, count)
        parent = body.header["links"][place].get("parent")
        links[name] = ReplayLink(
            name=name,
            parent=None if parent is None else body.link_names[parent],
            inertial_pose=body.poses[:, place],
            velocity=None if read is None else read[:, :6],
            joint_load=None if read is None else read[:, 6:],
            _frames=body.frames[place],
        )
    return links


def _joints(body: FoundBody, found: _ByPlace, count: int) -> dict[str, ReplayJoint]:
    links = body.header["links"][1:]
    names = unique(link["joint"] for link in links)
    joints = {}
    for place, (name, link) in enumerate(zip(names, links, strict=True)):
        read = _series(body, place, found, 6, count)
        if read is None and link["kind"] not in _ONE_DOF:
            continue
        columns = np.full((count, 6), np.nan) if read is None else read
        position, velocity, torque, *targets = columns.T
        moved = body.link_names[place + 1]
        joints[name] = ReplayJoint(name, moved, link["kind"], position, velocity, torque, *targets)
    return joints


def _actuators(body: FoundBody, found: _ByPlace, count: int) -> dict[str, ReplayActuator]:
    actuators = {}
    for place, name in enumerate(unique(it["name"] for it in body.header.get("actuators", ()))):
        read = _series(body, place, found, 3, count)
        control, force, activation = (np.full((count, 3), np.nan) if read is None else read).T
        actuators[name] = ReplayActuator(name, control, force, activation)
    return actuators


def _sensors(body: FoundBody, found: _ByPlace, count: int) -> dict[str, Floats]:
    sensors = {}
    told = body.header.get("sensors", ())
    for place, (name, sensor) in enumerate(zip(unique(it["name"] for it in told), told, strict=True)):
        values = np.full((count, sensor["size"]), np.nan)
        frames, rows = found.get((body.header["body"], place), _NOTHING)
        there = body.present[frames]
        values[frames[there], rows[there, 0].astype(np.int64)] = rows[there, 1]
        sensors[name] = values
    return sensors
