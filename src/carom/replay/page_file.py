"""The recording inside a page that replays it."""

from __future__ import annotations

import binascii
from base64 import b64decode
from pathlib import Path

from carom.errors import DescriptionError
from carom.viewer.replay.page import PLACE

_BEGIN, _END = b'id="recording">', b"</script>"
_PAGES = "a page of `World.record`, of `carom record`, or of the page's Save"


def recording_of(path: Path) -> bytes:
    """The recording in a page.

    Raises:
        DescriptionError: The file is no such page, or a part of it is missing.
        OSError: The file cannot be read.
    """
    text = path.read_bytes()
    begin = text.find(_BEGIN)
    if begin < 0:
        what = "it is empty" if not text.strip() else "there is no recording in it"
        raise DescriptionError(f'{what}; {_PAGES} has an element with id="recording"', file=path)
    begin += len(_BEGIN)
    line = text.count(b"\n", 0, begin) + 1
    end = text.find(_END, begin)
    if end < 0:
        raise DescriptionError(
            "it ends within its recording, so it was not copied to its end", file=path, line=line
        )
    packed = text[begin:end].strip()
    if packed == PLACE.encode():
        raise DescriptionError("it is the player without a recording", file=path, line=line)
    try:
        return b64decode(packed, validate=True)
    except binascii.Error as problem:
        raise DescriptionError(f"its recording is no base 64 ({problem})", file=path, line=line) from problem
