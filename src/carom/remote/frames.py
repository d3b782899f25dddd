"""Frames on a socket: a message, the contents of its arrays, and the number of the call they belong to.

A frame is a header of 16 bytes (number of the call, size of the message, size of the contents; unsigned,
little endian), the message, and the contents; message and contents are each padded to a multiple of 16 bytes.
"""

from __future__ import annotations

import socket
from collections.abc import Sequence
from dataclasses import dataclass
from struct import Struct
from typing import NamedTuple

import numpy as np

from carom.remote.errors import Malformed
from carom.remote.values import ALIGNMENT, padded

MAX_NUMBER = 2**32 - 1
"""Largest number of a call."""

_HEADER = Struct("<IIQ")
# Size of the receive buffer, which holds most frames [bytes].
_CHUNK = 65536
# Frames up to this size are sent by one system call, which is faster than several [bytes].
_SMALL = 16384
# Most memory allocated for a longer frame because of its header alone, before its data arrive [bytes].
_TRUSTED = 16 << 20
_NOTHING = memoryview(b"")
_ZEROS = bytes(ALIGNMENT)


@dataclass(frozen=True)
class Limits:
    """The largest sizes that one side accepts from the other [bytes]: of a message, and of all its arrays."""

    message: int
    contents: int


OF_CALLS = Limits(message=64 << 20, contents=256 << 20)
"""Limits of servers, enough for a height field of 1,024 x 1,024 or a texture of 8,192 x 8,192."""
OF_RESULTS = Limits(message=512 << 20, contents=2048 << 20)
"""Limits of clients."""


class Frame(NamedTuple):
    """One received frame: the number of the call, the message, and the contents of its arrays."""

    number: int
    message: memoryview
    contents: memoryview


def check_size(message: bytes, arrays: Sequence[memoryview], limits: Limits) -> None:
    """Raise `Malformed` if a message and the contents of its arrays are larger than the limits."""
    size = _size(arrays)
    if len(message) > limits.message or size > limits.contents:
        raise Malformed(f"{len(message) + size:,} bytes are too much for one message.")


def send(peer: socket.socket, number: int, message: bytes, arrays: Sequence[memoryview]) -> None:
    """Send one frame; raises `OSError` if the socket is closed, or its timeout is over."""
    head = _HEADER.pack(number, len(message), _size(arrays)) + message + _ZEROS[: -len(message) % ALIGNMENT]
    pieces: list[bytes | memoryview] = [head]
    for array in arrays:
        pieces += [array, _ZEROS[: -len(array) % ALIGNMENT]]
    if arrays and sum(map(len, pieces)) <= _SMALL:
        pieces = [b"".join(pieces)]
    for piece in pieces:
        if len(piece):
            peer.sendall(piece)


def _size(arrays: Sequence[memoryview]) -> int:
    return sum(padded(len(array)) for array in arrays)


class Reader:
    """Reads frames from a socket. If waiting for a frame is interrupted, the part read so far is kept.

    For long frames memory is allocated as data arrive, not by the header.
    """

    def __init__(self, peer: socket.socket, limits: Limits) -> None:
        self._peer = peer
        self._limits = limits
        # Most frames fit into this buffer and are copied from it; a longer frame gets memory of its own.
        self._usual = memoryview(bytearray(_CHUNK))
        self._filled = 0
        self._long = _NOTHING

    def frame(self) -> Frame:
        """The next frame.

        Raises:
            Malformed: The frame is larger than the limits.
            EOFError: The other side has closed the socket.
            OSError: The socket is closed, or its timeout is over.
        """
        usual = self._usual
        while self._filled < _HEADER.size:
            self._filled += self._read(usual[self._filled :])
        number, message, contents = _HEADER.unpack_from(usual)
        if message > self._limits.message or contents > self._limits.contents:
            raise Malformed(f"A message of {message + contents:,} bytes is too long.")
        begin = _HEADER.size + padded(message)
        size = begin + contents
        if size > _CHUNK:
            whole = self._long_frame(size)
        else:
            while self._filled < size:
                self._filled += self._read(usual[self._filled :])
            whole = memoryview(bytearray(usual[:size]))
            rest = self._filled - size
            if rest:
                usual[:rest] = bytes(usual[size : self._filled])
            self._filled = rest
        return Frame(number, whole[_HEADER.size : _HEADER.size + message], whole[begin:])

    def _long_frame(self, size: int) -> memoryview:
        """Read the rest of a frame that is longer than the buffer; return the whole frame."""
        while self._filled < _CHUNK:
            self._filled += self._read(self._usual[self._filled :])
        while self._filled < size:
            if self._filled >= len(self._long):
                longer = np.empty(min(size, max(_TRUSTED, 2 * self._filled)), np.uint8).data
                longer[: self._filled] = (self._long or self._usual)[: self._filled]
                self._long = longer
            self._filled += self._read(self._long[self._filled :])
        whole, self._long, self._filled = self._long, _NOTHING, 0
        return whole

    def _read(self, free: memoryview) -> int:
        count = self._peer.recv_into(free)
        if count == 0:
            raise EOFError("The other side has closed the connection.")
        return count
