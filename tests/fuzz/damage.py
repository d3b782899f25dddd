"""Damage to the content of files: bytes and tokens that are lost, repeated, moved or replaced."""

from __future__ import annotations

import re
from random import Random

TOKENS = (
    *(b"", b"0", b"-1", b"1e308", b"-1e400", b"nan", b"inf", b"1e-320", b"0x10", b"1_0", b"9" * 400, b"1e30"),
    *(b"1 2", b"0 0 0", b"1e30 1e30 1e30", b"${x}", b"\xff\xfe", b"\0", b"\n", b"<", b">", b"/>", b"<!--",
    b"]]>"), *(b'<!DOCTYPE x [<!ENTITY y "z">]>', b"&y;", b"world", b"../../../../etc/passwd", b"/dev/zero",
    b"x" * 5000), *(b"999999999", b"-2147483648", b"4294967296", b"1e100", b"1e-200", b"v 1 2 3", b"f 1 2 3",
    b"f 9 9 9"),
)  # fmt: skip
_WORDS = (
    *(
        word.to_bytes(4, order)
        for word in (0, 1, 3, 1000, 1 << 20, 1 << 30, (1 << 31) - 1, 1 << 31, (1 << 32) - 1)
        for order in ("little", "big")
    ),
    *(b"\0\0\x80\x7f", b"\0\0\xc0\x7f", b"\xff\xff\x7f\x7f"),
)
_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
_QUOTED = re.compile(rb'"[^"]*"')
_ELEMENT = re.compile(rb"<(\w+)[^<>]*?(?:/>|>[^<]*</\1>)")


def damaged(content: bytes, random: Random) -> bytes:
    """The content after one to four blows."""
    for _ in range(random.choice((1, 1, 2, 4))):
        content = random.choice(_BLOWS)(content, random)
    return content


def _span(content: bytes, random: Random) -> tuple[int, int]:
    start = random.randrange(len(content) + 1)
    return start, min(len(content), start + random.choice((1, 4, 20, 200)))


def _delete(content: bytes, random: Random) -> bytes:
    start, end = _span(content, random)
    return content[:start] + content[end:]


def _double(content: bytes, random: Random) -> bytes:
    start, end = _span(content, random)
    return content[:end] + content[start:end] * random.choice((1, 3, 30)) + content[end:]


def _insert(content: bytes, random: Random) -> bytes:
    start, _ = _span(content, random)
    return content[:start] + random.choice(TOKENS) + content[start:]


def _flip(content: bytes, random: Random) -> bytes:
    if not content:
        return content
    place = random.randrange(len(content))
    return content[:place] + bytes([content[place] ^ (1 << random.randrange(8))]) + content[place + 1 :]


def _cut(content: bytes, random: Random) -> bytes:
    return content[: random.randrange(len(content) + 1)]


def _replace_one(pattern: re.Pattern[bytes], content: bytes, random: Random, by: bytes) -> bytes:
    found = list(pattern.finditer(content))
    if not found:
        return _flip(content, random)
    chosen = random.choice(found)
    return content[: chosen.start()] + by + content[chosen.end() :]


def _number(content: bytes, random: Random) -> bytes:
    return _replace_one(_NUMBER, content, random, random.choice(TOKENS))


def _value(content: bytes, random: Random) -> bytes:
    return _replace_one(_QUOTED, content, random, b'"' + random.choice(TOKENS) + b'"')


def _element(content: bytes, random: Random) -> bytes:
    elements = [match.group() for match in _ELEMENT.finditer(content)]
    return _replace_one(_ELEMENT, content, random, random.choice(elements) if elements else b"")


def _word(content: bytes, random: Random) -> bytes:
    """Four bytes replaced, as the counts and offsets of binary files are."""
    at = random.randrange(len(content) // 4 + 1) * 4
    return content[:at] + random.choice(_WORDS) + content[at + 4 :]


_BLOWS = (_delete, _double, _insert, _flip, _cut, _number, _number, _value, _value, _element, _word)
