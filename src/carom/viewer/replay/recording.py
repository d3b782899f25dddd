"""Recordings: the messages of a page, packed into bytes.

A recording is compressed with zlib. It contains the length of an index as a little-endian integer of four
bytes, the index in JSON, and the binary data of its records, one after the other. A record is a *message*
about the scene (its header, and the number of bytes of its data), or a run of *frames* that differ only in
their times and numbers. The numbers of a run are floats of four bytes. Each frame is stored as its bitwise
XOR with the frame before it, sorted by byte, then by column, then by frame: small changes give zeros, which
are compressed well.

`page/time/recording.js` reads and writes the same format.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from json import JSONDecodeError
from typing import Any
from zlib import compress, decompress
from zlib import error as CompressionError

import numpy as np
from numpy.typing import NDArray

from carom.viewer.protocol import to_page

FORMAT = 1
_UINT = np.dtype("<u4")


class Recording:
    """Messages to a page, in order."""

    def __init__(self) -> None:
        self._records: list[dict[str, Any]] = []
        self._parts: list[bytes] = []
        self._run: list[bytes] = []
        self._times: list[float] = []
        self._shared: dict[str, Any] = {}
        self.frame_count: int = 0

    def add(self, header: dict[str, Any], payload: bytes) -> None:
        """Adds the next message."""
        if header["type"] != to_page.FRAME.type:
            self._end_run()
            self._records.append({"message": header, "bytes": len(payload)})
            self._parts.append(payload)
            return
        shared = {name: value for name, value in header.items() if name not in to_page.OWN_OF_FRAMES}
        if self._run and (shared != self._shared or len(payload) != len(self._run[0])):
            self._end_run()
        self._shared = shared
        self._run.append(payload)
        self._times.append(header["time"])
        self.frame_count += 1

    def packed(self, *, level: int = 9, **facts: Any) -> bytes:
        """The packed recording, with further data: `title`, `camera`, `options`; `level` is that of zlib."""
        self._end_run()
        index = json.dumps({"format": FORMAT, **facts, "records": self._records}, separators=(",", ":"))
        text = index.encode()
        return compress(b"".join((struct.pack("<I", len(text)), text, *self._parts)), level)

    def _end_run(self) -> None:
        if not self._run:
            return
        frames = np.array([np.frombuffer(payload, _UINT) for payload in self._run])
        record = {
            "frames": len(frames),
            "floats": frames.shape[1],
            "header": self._shared,
            "times": self._times,
        }
        self._records.append(record)
        self._parts.append(_planes(frames))
        self._run, self._times = [], []


@dataclass(frozen=True, slots=True)
class Run:
    """Frames one after the other that differ only in their times and numbers.

    Attributes:
        header: What their headers share.
        times: Simulated time of each [s].
        frames: (frames, numbers) the bits of the floats of each.
    """

    header: dict[str, Any]
    times: list[float]
    frames: NDArray[np.uint32]


def records(recording: bytes) -> tuple[dict[str, Any], list[tuple[dict[str, Any], bytes] | Run]]:
    """The further data, and in order the messages (header, payload) and the runs of frames of a recording.

    Raises:
        ValueError: It is damaged, or has another format.
    """
    try:
        plain = decompress(recording)
        (length,) = struct.unpack_from("<I", plain)
        facts = json.loads(plain[4 : 4 + length])
        if facts["format"] != FORMAT:
            raise ValueError(f"the recording has format {facts['format']}; only {FORMAT} is known")
        return facts, list(_divided(facts.pop("records"), plain, 4 + length))
    except (CompressionError, struct.error, JSONDecodeError, UnicodeDecodeError) as problem:
        raise ValueError(f"the recording is damaged ({problem})") from problem
    except (KeyError, TypeError, AttributeError) as problem:
        raise ValueError(f"the index of the recording is damaged ({problem!r})") from problem


def _divided(
    index: list[dict[str, Any]], plain: bytes, at: int
) -> Iterator[tuple[dict[str, Any], bytes] | Run]:
    for record in index:
        count = record.get("frames", 0)
        size = record["bytes"] if "message" in record else _UINT.itemsize * count * record["floats"]
        data = plain[at : at + size]
        if len(data) < size:
            raise ValueError(f"the recording ends after {len(plain)} bytes, within what its index lists")
        if "message" in record:
            yield record["message"], data
        else:
            frames = _from_planes(data, count, record["floats"])
            if len(record["times"]) != count:
                raise ValueError(
                    f"a run of the recording has {count} frames and {len(record['times'])} times"
                )
            yield Run(record["header"], record["times"], frames)
        at += size


def unpacked(recording: bytes) -> tuple[dict[str, Any], list[tuple[dict[str, Any], bytes]]]:
    """The further data and the messages (header, payload) of a recording; `ValueError` for another format."""
    facts, parts = records(recording)
    messages: list[tuple[dict[str, Any], bytes]] = []
    for part in parts:
        if isinstance(part, Run):
            messages.extend(
                ({**part.header, "time": time}, frame.tobytes())
                for time, frame in zip(part.times, part.frames, strict=True)
            )
        else:
            messages.append(part)
    return facts, messages


def _planes(frames: NDArray[np.uint32]) -> bytes:
    changes = frames.copy()
    changes[1:] ^= frames[:-1]
    columns = np.ascontiguousarray(changes.T)
    return np.ascontiguousarray(columns.view(np.uint8).reshape(-1, _UINT.itemsize).T).tobytes()


def _from_planes(planes: bytes, count: int, floats: int) -> NDArray[np.uint32]:
    bytes_ = np.frombuffer(planes, np.uint8).reshape(_UINT.itemsize, -1).T
    columns = np.ascontiguousarray(bytes_).view(_UINT).reshape(floats, count)
    return np.bitwise_xor.accumulate(columns.T, axis=0)
