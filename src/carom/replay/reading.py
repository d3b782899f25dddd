"""Reading a replay: from the messages of its recording to arrays by names."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from carom.errors import DescriptionError
from carom.replay.following import Following
from carom.replay.page_file import recording_of
from carom.replay.replay import Floats, Replay, ReplayEvent
from carom.replay.shapes import Assets
from carom.replay.tables import Tables
from carom.viewer.protocol import to_page
from carom.viewer.replay.recording import Run, records

# Step of the clock where simulated time stands still or goes back [s], as on the page.
_MIN_INTERVAL = 1 / 60
# What becomes something else than an event.
_SHAPES = {to_page.MESH.type, to_page.TEXTURE.type, to_page.NO_MESH.type, to_page.NO_TEXTURE.type}
_BODIES = {to_page.BODY.type, to_page.NO_BODY.type, to_page.LAYOUT.type, to_page.NO_LAYOUT.type}


def read(path: str | Path) -> Replay:
    """Read a replay, as `World.record`, `carom record` and the page's *Save* write it.

    Args:
        path: The page, an HTML file.

    Returns:
        What it holds, as arrays over its frames. It takes the memory of the unpacked recording about twice.

    Raises:
        DescriptionError: The file is no such page, is damaged or not complete, or comes from a version of
            Carom whose recordings this one does not know.
        OSError: The file cannot be read.
    """
    file = Path(path)
    recording = recording_of(file)
    try:
        return _replay(recording)
    except ValueError as problem:
        raise DescriptionError(f"it cannot be replayed: {problem}", file=file) from problem
    except (KeyError, TypeError, IndexError) as problem:
        raise DescriptionError(f"its recording is damaged ({problem!r})", file=file) from problem


def _replay(recording: bytes) -> Replay:
    facts, parts = records(recording)
    following = Following()
    assets = Assets()
    tables = Tables()
    times: list[float] = []
    values: dict[str, list[tuple[int, int, float]]] = {}
    events: list[ReplayEvent] = []
    for part in parts:
        at = len(times)
        if isinstance(part, Run):
            times.extend(part.times)
            numbers = part.frames.view("<f4")
            following.take_frames(at, part.header, numbers)
            tables.take(at, part.header, numbers)
            for name, value in part.header.get("values", {}).items():
                values.setdefault(name, []).append((at, len(times), value))
            continue
        header, payload = part
        if header["type"] in _SHAPES:
            assets.take(header, payload)
        elif header["type"] in _BODIES:
            following.take(at, header)
        else:
            told = {name: value for name, value in header.items() if name != "type"}
            events.append(ReplayEvent(at, header["type"], told, payload))
    count = len(times)
    bodies = following.bodies(count, assets)
    return Replay(
        title=facts.get("title", ""),
        times=np.array(times, dtype=np.float64),
        clock=_clock(times),
        bodies=tables.fill(bodies, count),
        contacts=tables.contacts(bodies),
        tendons=tables.tendons(bodies),
        values={name: _values(pieces, count) for name, pieces in values.items()},
        events=tuple(events),
        camera=_without_type(facts.get("camera")),
        options=_without_type(facts.get("options")),
    )


def _clock(times: list[float]) -> Floats:
    passed = np.diff(np.array(times[:1] + times, dtype=np.float64))
    passed[1:][passed[1:] <= 0.0] = _MIN_INTERVAL
    return np.cumsum(passed)


def _values(pieces: list[tuple[int, int, float]], count: int) -> Floats:
    values = np.full(count, np.nan)
    for begin, end, value in pieces:
        values[begin:end] = value
    return values


def _without_type(header: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    return None if header is None else {name: value for name, value in header.items() if name != "type"}
