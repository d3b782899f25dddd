"""Following the bodies of a recording: which there are in which frames, where, and how they look."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description import Pose
from carom.replay.replay import ReplayLook
from carom.replay.shapes import Assets
from carom.viewer.protocol import to_page

_POSE = 7


@dataclass(slots=True)
class FoundBody:
    """A body of a recording: all with the same number, name, links and joints are one.

    Attributes:
        name: Its name in the replay.
        header: The message that described it first.
        link_names: Names of its links, the base first, each once.
        present: (frames,) whether it is there.
        poses: (frames, links, 7) poses of the inertial frames of its links; NaN while it is not there.
        frames: For each link its frame in its inertial frame, from which frame on.
        looks: Its shapes over time.
    """

    name: str
    header: Mapping[str, Any]
    link_names: tuple[str, ...]
    present: NDArray[np.bool_]
    poses: NDArray[np.float32]
    frames: tuple[tuple[tuple[int, Pose], ...], ...]
    looks: tuple[ReplayLook, ...]


@dataclass(slots=True)
class _Body:
    """What has been found of a body so far: versions from a frame on, until before another; and poses."""

    versions: list[tuple[int, int | None, Mapping[str, Any]]] = field(default_factory=list)
    poses: list[tuple[int, NDArray[np.float32]]] = field(default_factory=list)


class Following:
    """The bodies that messages tell of, which are given in order."""

    def __init__(self) -> None:
        self._found: dict[tuple[Any, ...], _Body] = {}
        self._present: dict[int, _Body] = {}
        self._layouts: dict[int, list[tuple[int, int]]] = {}

    def take(self, at: int, header: Mapping[str, Any]) -> None:
        """Takes a message about bodies; `at` is the number of the next frame."""
        if header["type"] == to_page.LAYOUT.type:
            self._layouts[header["layout"]] = header["bodies"]
        elif header["type"] in (to_page.BODY.type, to_page.NO_BODY.type):
            self._end(at, header["body"])
            if header["type"] == to_page.BODY.type:
                body = self._found.setdefault(_identity(header), _Body())
                body.versions.append((at, None, header))
                self._present[header["body"]] = body

    def take_frames(self, at: int, header: Mapping[str, Any], numbers: NDArray[np.float32]) -> None:
        """Takes the poses of frames that share a header.

        Args:
            at: Number of the first of them.
            header: What they share.
            numbers: (frames, numbers) the numbers of each; the first are its poses.

        Raises:
            ValueError: There are fewer numbers than poses.
        """
        count, rows = len(numbers), header["poses"]
        if numbers.shape[1] < _POSE * rows:
            raise ValueError(f"frame {at} has {numbers.shape[1]} numbers, too few for {rows} poses")
        poses = numbers[:, : _POSE * rows].reshape(count, rows, _POSE)
        first = 0
        for number, links in self._layouts.get(header["layout"], ()):
            body = self._present.get(number)
            # The description of a body may be a frame late.
            if body is not None and len(body.versions[-1][2]["links"]) == links and first + links <= rows:
                body.poses.append((at, poses[:, first : first + links]))
            first += links

    def bodies(self, count: int, assets: Assets) -> list[FoundBody]:
        """All bodies, in the order in which they came; `count` is the number of frames."""
        names = unique(body.versions[0][2]["name"] for body in self._found.values())
        return [_finished(*it, count, assets) for it in zip(names, self._found.values(), strict=True)]

    def _end(self, at: int, number: int) -> None:
        body = self._present.pop(number, None)
        if body is not None:
            begin, _, header = body.versions[-1]
            body.versions[-1] = (begin, at, header)


def unique(names: Iterable[str]) -> tuple[str, ...]:
    """The names, each once: those that were there before have a number behind them, from 2 on."""
    taken: dict[str, None] = {}
    for name in names:
        free, number = name, 1
        while free in taken:
            number += 1
            free = f"{name} {number}"
        taken[free] = None
    return tuple(taken)


def _identity(header: Mapping[str, Any]) -> tuple[Any, ...]:
    links = (
        (link["name"], link.get("joint"), link.get("kind"), link.get("parent")) for link in header["links"]
    )
    return (header["body"], header["name"], *links)


def _finished(name: str, body: _Body, count: int, assets: Assets) -> FoundBody:
    header = body.versions[0][2]
    links = header["links"]
    poses = np.full((count, len(links), _POSE), np.nan, dtype=np.float32)
    present = np.zeros(count, dtype=bool)
    for at, rows in body.poses:
        poses[at : at + len(rows)] = rows
        present[at : at + len(rows)] = True
    frames: list[list[tuple[int, Pose]]] = [[] for _ in links]
    looks: list[ReplayLook] = []
    names = unique(link["name"] for link in links)
    for begin, end, version in body.versions:
        for told, known in zip(version["links"], frames, strict=True):
            frame = Pose(tuple(told["position"]), tuple(told["orientation"]))
            if not known or known[-1][1] != frame:
                known.append((begin if known else 0, frame))
        last = count if end is None else end
        # A description that no frame was shown with is none.
        if begin < last:
            shapes = tuple(assets.shape(shape, names, version["links"], name) for shape in version["shapes"])
            looks.append(ReplayLook(begin, last, shapes))
    return FoundBody(name, header, names, present, poses, tuple(map(tuple, frames)), tuple(looks))
