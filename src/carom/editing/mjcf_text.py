"""The text of a description as MJCF."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

from carom.files.xml_element import Element

_FILES = ("file", "fileback", "filedown", "filefront", "fileleft", "fileright", "fileup")


def mjcf_text(root: Element, folder: Path | None) -> str:
    """The text of a document; paths of files are relative to a folder if there is one.

    Numbers have all their digits, so `carom.read` and MuJoCo read the same description from it.
    """
    return "\n".join([*_lines(root, 0, folder), ""])


def _lines(element: Element, depth: int, folder: Path | None) -> Iterator[str]:
    indent = "  " * depth
    stated = "".join(
        f" {name}={quoteattr(_relative(text, folder) if name in _FILES else text)}"
        for name, text in element.attributes.items()
    )
    text = element.text.strip()
    if not element.children and not text:
        # Sections that are empty say nothing.
        if stated or depth != 1:
            yield f"{indent}<{element.tag}{stated}/>"
        return
    if not element.children:
        yield f"{indent}<{element.tag}{stated}>{escape(text)}</{element.tag}>"
        return
    yield f"{indent}<{element.tag}{stated}>{escape(text)}"
    for child in element.children:
        yield from _lines(child, depth + 1, folder)
    yield f"{indent}</{element.tag}>"


def _relative(name: str, folder: Path | None) -> str:
    """The path of a file relative to a folder, where there is one on the same drive."""
    if folder is None or not Path(name).is_absolute():
        return name
    try:
        return Path(os.path.relpath(name, folder)).as_posix()
    except ValueError:  # another drive
        return name
