"""Messages to a page: a JSON header, and numbers in binary where there are many.

A message is four bytes, the length of the header as a little-endian integer; the header in UTF-8, padded by
spaces so that the numbers start at a multiple of four; and the numbers. The header's `type` is the kind of
message. Messages from a page are JSON texts. `carom.viewer.protocol` declares all messages.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

MAX_INCOMING_BYTES = 1 << 16
"""Largest message accepted from a page."""


def encoded(header: Mapping[str, Any], payload: bytes = b"") -> bytes:
    """A message to a page; raises `ValueError` if a number in the header is not finite."""
    text = json.dumps(header, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<I", len(text)) + text + payload


def decoded(message: bytes) -> tuple[dict[str, Any], bytes]:
    """Header and payload of a message to a page."""
    (length,) = struct.unpack_from("<I", message)
    return json.loads(message[4 : 4 + length]), message[4 + length :]


def received(text: str | bytes) -> dict[str, Any]:
    """A message from a page; raises `ValueError` if it is not a JSON object with a type."""
    message = json.loads(text)
    if not isinstance(message, dict) or not isinstance(message.get("type"), str):
        raise ValueError("a message has to be a JSON object with a type")
    return message
