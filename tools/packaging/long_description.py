"""The description of Carom on a package index, made from README.md.

The index shows one text and has none of the other files, so relative links and pictures would lead nowhere.
Relative links become their plain text, relative pictures are left out, and absolute links stay.

`python tools/packaging/long_description.py` prints it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

# A line that begins or ends a block of code.
_FENCE = re.compile(r" {0,3}(`{3,}|~{3,})(.*)$")
_TARGET = r"\(\s*(?:<(?P<{0}>[^>\n]*)>|(?P<{1}>[^\s()<]*))(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)"
_CODE = r"(?P<ticks>`+)(?!`)(?:(?!\n[ \t]*\n).)+?(?<!`)(?P=ticks)(?!`)"
_PICTURE = re.compile(
    rf"{_CODE}|(?<!\\)!\[[^\[\]]*\]{_TARGET.format('bracketed', 'bare')}",
    re.DOTALL,
)
_LINK = re.compile(
    rf"{_CODE}|(?<![\\!])\[(?P<text>(?:`[^`]*`|!\[[^\[\]]*\]\([^()]*\)|[^\[\]`])*)\]"
    rf"{_TARGET.format('bracketed', 'bare')}",
    re.DOTALL,
)
# What else may name a file: links with brackets in their text, definitions of links, HTML.
_LEFT = re.compile(
    rf"{_CODE}|\]\(\s*<?(?P<inline>[^)\s>]*)|^ {{0,3}}\[[^\]]+\]:\s*<?(?P<defined>[^\s>]+)"
    r"|<[^>]*\b(?:src|href)\s*=\s*[\"']?(?P<html>[^\"'\s>]*)",
    re.DOTALL | re.MULTILINE,
)
_ABSOLUTE = re.compile(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//")


def long_description(readme: str) -> str:
    """README.md without relative links and pictures; blocks of code and code in the text stay as they are.

    Args:
        readme: The text of README.md, in Markdown, with links of the form `[text](target)`.

    Returns:
        The text for the index, in Markdown.

    Raises:
        ValueError: A relative link is written in another way, as a definition or in HTML.
    """
    return "".join(text if is_code else _without_links(text) for text, is_code in _pieces(readme))


def _pieces(readme: str) -> Iterator[tuple[str, bool]]:
    """The text in pieces, and whether each is a fenced block of code."""
    piece: list[str] = []
    fence = ""
    for line in readme.splitlines(keepends=True):
        found = _FENCE.match(line.rstrip("\r\n"))
        if fence:
            piece.append(line)
            if found and found[1].startswith(fence) and not found[2].strip():
                yield "".join(piece), True
                piece, fence = [], ""
        elif found and not (found[1][0] == "`" and "`" in found[2]):
            yield "".join(piece), False
            piece, fence = [line], found[1]
        else:
            piece.append(line)
    yield "".join(piece), bool(fence)


def _without_links(text: str) -> str:
    """A piece of text that is no block of code, without relative links and pictures."""
    pictured = _PICTURE.sub(lambda found: found[0] if _stays(found) else "", text)
    if pictured != text:
        pictured = re.sub(r"\n([ \t]*\n){2,}", "\n\n", pictured)
    linked = _LINK.sub(lambda found: found[0] if _stays(found) else found["text"], pictured)
    for found in _LEFT.finditer(linked):
        target = found["inline"] or found["defined"] or found["html"]
        if target and not _ABSOLUTE.match(target):
            raise ValueError(f"the relative link to {target} is not of the form [text](target)")
    return linked


def _stays(found: re.Match[str]) -> bool:
    """Whether what was found is code, or leads to an absolute address."""
    target = found["bracketed"] or found["bare"] or ""
    return found["ticks"] is not None or _ABSOLUTE.match(target) is not None


if __name__ == "__main__":
    readme = Path(__file__).parents[2] / "README.md"
    sys.stdout.write(long_description(readme.read_text(encoding="utf-8")))
