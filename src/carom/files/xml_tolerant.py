"""Tolerant reader for XML that is not well formed but that PyBullet loads.

It accepts the same errors as TinyXML: text and further elements outside the root, white space before the
declaration, bare ampersands and `<` in attribute values, missing spaces between attributes, double hyphens
in comments, an extra end tag (the document ends there, whatever follows). Errors that TinyXML refuses are
refused here too: mismatched or missing end tags, attributes without quotes or given twice, a declaration
after other content.
"""

from __future__ import annotations

import re
from bisect import bisect_right

from carom.errors import DescriptionError
from carom.files.xml_element import DOCTYPE_REFUSED, TreeBuilder

_NAME = r"[A-Za-z_:\u0080-\U0010ffff][\w:.\-\u0080-\U0010ffff]*"
_TAG_NAME = re.compile(_NAME)
_ATTRIBUTE = re.compile(rf"""({_NAME})\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_BLANK = re.compile(r"\s*")
_REFERENCE = re.compile(r"&(?:#(\d{1,7})|#x([0-9A-Fa-f]{1,6})|(quot|amp|apos|lt|gt));")
_ENTITIES = {"quot": '"', "amp": "&", "apos": "'", "lt": "<", "gt": ">"}


def read_tolerantly(text: str, builder: TreeBuilder) -> None:
    """Feed a document that is not well formed to the builder.

    Raises:
        DescriptionError: It has an error that TinyXML refuses; the message names line and reason.
    """
    _TolerantReader(text, builder).run()


class _TolerantReader:
    def __init__(self, text: str, builder: TreeBuilder) -> None:
        self.text = text
        self.builder = builder
        self.at = 0
        self.only_declarations_so_far = True
        self._line_starts = [match.end() for match in re.finditer("\n", text)]

    def run(self) -> None:
        while True:
            opening = self.text.find("<", self.at)
            between = self.text[self.at : opening if opening >= 0 else len(self.text)]
            if opening < 0:
                self._finish(between)
                return
            if between.strip():
                self.only_declarations_so_far = False
                if self.builder.open:
                    self.builder.data(_replace_references(between))
            self.at = opening
            self._markup()

    def _finish(self, rest: str) -> None:
        if self.builder.open:
            element = self.builder.open[-1]
            raise self.builder.error(f"<{element.tag}> is never closed", element.line)
        if rest.strip():
            raise self._error("text after the last element", self.at + len(rest) - len(rest.lstrip()))

    def _markup(self) -> None:
        text, at = self.text, self.at
        if text.startswith("<?", at):
            if self.builder.roots or not self.only_declarations_so_far:
                raise self._error("an XML declaration must come before everything else", at)
            self.at = self._after("?>", at)
            return
        self.only_declarations_so_far = False
        if text.startswith("<!--", at):
            self.at = self._after("-->", at)
        elif text.startswith("<![CDATA[", at):
            self.at = self._after("]]>", at)
            if self.builder.open:
                self.builder.data(text[at + len("<![CDATA[") : self.at - len("]]>")])
        elif text.startswith("<!", at):
            self.at = self._after(">", at)
            declaration = text[at : self.at]
            if "[" in declaration or re.search(r"\b(?:SYSTEM|PUBLIC|ENTITY)\b", declaration):
                raise self._error(DOCTYPE_REFUSED, at)
        elif text.startswith("</", at):
            self._end_tag()
        else:
            self._start_tag()

    def _end_tag(self) -> None:
        at = self.at
        name = self._name(at + 2)
        self.at = self._after(">", at)
        if not self.builder.open:
            if not self.builder.roots:
                raise self._error(f"</{name}> without a start tag", at)
            self.at = len(self.text)
            return
        element = self.builder.open[-1]
        if element.tag != name:
            raise self._error(f"</{name}> does not match <{element.tag}> on line {element.line}", at)
        self.builder.end()

    def _start_tag(self) -> None:
        start = self.at
        line = self._line(start)
        name = self._name(_skip_blank(self.text, start + 1))
        attributes: dict[str, str] = {}
        at = _skip_blank(self.text, start + 1) + len(name)
        while True:
            at = _skip_blank(self.text, at)
            if self.text.startswith(">", at):
                self.at = at + 1
                self.builder.start(name, attributes, line)
                return
            if self.text.startswith("/>", at):
                self.at = at + 2
                self.builder.start(name, attributes, line)
                self.builder.end()
                return
            match = _ATTRIBUTE.match(self.text, at)
            if match is None:
                raise self._error(f'<{name}>: expected an attribute written as name="value"', at)
            key, double_quoted, single_quoted = match.groups()
            if key in attributes:
                raise self._error(f"<{name}>: attribute {key!r} is given twice", at)
            value = double_quoted if double_quoted is not None else single_quoted
            attributes[key] = _replace_references(value)
            at = match.end()

    def _name(self, at: int) -> str:
        match = _TAG_NAME.match(self.text, at)
        if match is None:
            raise self._error("'<' without the name of an element", at)
        return match.group()

    def _after(self, closing: str, at: int) -> int:
        end = self.text.find(closing, at)
        if end < 0:
            raise self._error(f"{self.text[at : at + 4].strip()!r} without a closing {closing!r}", at)
        return end + len(closing)

    def _line(self, at: int) -> int:
        return bisect_right(self._line_starts, at) + 1

    def _error(self, reason: str, at: int) -> DescriptionError:
        return self.builder.error(reason, self._line(at))


def _skip_blank(text: str, at: int) -> int:
    match = _BLANK.match(text, at)
    return match.end() if match else at


def _replace_references(text: str) -> str:
    """The text with named and numeric character references replaced; unknown ones stay as they are."""
    if "&" not in text:
        return text

    def replacement(match: re.Match[str]) -> str:
        decimal, hexadecimal, name = match.groups()
        if name:
            return _ENTITIES[name]
        code = int(decimal) if decimal else int(hexadecimal, 16)
        return chr(code) if 0 < code <= 0x10FFFF and not 0xD800 <= code <= 0xDFFF else match.group()

    return _REFERENCE.sub(replacement, text)
