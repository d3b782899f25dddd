"""Parsing XML from untrusted files, in bounded time.

Expat parses well-formed documents. Documents that expat refuses go to the tolerant reader in `xml_tolerant`,
because many robot files in use are not well formed.
"""

from __future__ import annotations

# What `xml.parsers.expat` is another name of, without the packages around it.
import pyexpat as expat
from codecs import BOM_UTF8
from pathlib import Path
from typing import Any

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.files.xml_element import DOCTYPE_REFUSED, Element, TreeBuilder


def parse_xml(data: bytes, file: Path) -> list[Element]:
    """The elements at the top level: one for a well-formed document, perhaps more for other ones.

    Content that is not valid UTF-8 is read as Latin-1. Entity declarations and external entities are refused;
    nothing but `data` is ever read.

    Raises:
        DescriptionError: The document has an error that PyBullet refuses too, or exceeds the limits.
    """
    if not data.strip():
        raise DescriptionError("the file is empty", file=file)
    # PyBullet takes a stray NUL for a line end, and robot files with one are in use.
    data = data.replace(b"\0", b" ")
    try:
        # As the codec `utf-8-sig`, which Python would have to import.
        text = data.removeprefix(BOM_UTF8).decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    builder = TreeBuilder(file)
    try:
        _run_expat(text, builder)
    except expat.ExpatError:
        # Imported only here: few files need it, and its regular expressions are slow to compile.
        from carom.files.xml_tolerant import read_tolerantly

        builder = TreeBuilder(file)
        read_tolerantly(text, builder)
    charge("elements", builder.count, file=file)
    return builder.roots


def parse_root(data: bytes, file: Path, *tags: str) -> Element:
    """The first top-level element with one of these names; raises `DescriptionError` if there is none."""
    root = next((element for element in parse_xml(data, file) if element.tag in tags), None)
    if root is None:
        raise DescriptionError(f"there is no <{tags[0]}> element", file=file)
    return root


def _run_expat(text: str, builder: TreeBuilder) -> None:
    # The text is decoded already: an encoding named in the declaration must not be applied again.
    parser = expat.ParserCreate("utf-8")
    parser.buffer_text = True
    parser.buffer_size = 1 << 16

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, attributes, parser.CurrentLineNumber)

    def end(_tag: str) -> None:
        builder.end()

    def doctype(_name: str, system_id: str | None, public_id: str | None, has_subset: int) -> None:
        if system_id or public_id or has_subset:
            raise builder.error(DOCTYPE_REFUSED, parser.CurrentLineNumber)

    def entity(*_declaration: Any) -> None:
        raise builder.error(DOCTYPE_REFUSED, parser.CurrentLineNumber)

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = doctype
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(text.encode("utf-8"), True)
    finally:
        # They refer to the parser.
        parser.StartElementHandler = parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = None
