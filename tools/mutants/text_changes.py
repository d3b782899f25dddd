"""Small changes of C++ and JavaScript, which are told from their text: strings and comments are left out."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tools.mutants.change import Change

_LEFT_OUT = re.compile(
    r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`|^[ \t]*\#[^\n]*|"""
    r"""(?<=[=(,:?&|!]\s)/(?![/*])(?:\\.|[^/\\\n])+/[a-z]*""",
    re.DOTALL | re.MULTILINE | re.VERBOSE,
)
_OTHER = {
    " < ": " <= ",
    " <= ": " < ",
    " > ": " >= ",
    " >= ": " > ",
    " == ": " != ",
    " != ": " == ",
    " === ": " !== ",
    " !== ": " === ",
    " + ": " - ",
    " - ": " + ",
    " * ": " / ",
    " / ": " * ",
    " && ": " || ",
    " || ": " && ",
    " += ": " -= ",
    " -= ": " += ",
    " ?? ": " && ",
}
_OPERATOR = re.compile("|".join(re.escape(text) for text in sorted(_OTHER, key=len, reverse=True)))
_NUMBER = re.compile(r"(?<![\w.\[])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
_TRUTH = re.compile(r"\b(true|false)\b")
_CONDITION = re.compile(r"\b(?:if|while) \(")
# A call or an assignment that is a line of its own, and no declaration.
_STATEMENT = re.compile(
    r"^[ \t]*(?!(?:const|let|var|return|import|export|using|namespace|typedef|static|struct|class|auto|throw|"
    r"else|case|default|goto|double|float|int|bool|char|long|unsigned|void|template|extern|for|while|if|switch|super)\b)"
    r"([A-Za-z_*(][\w.\->:\[\]()?*, ]*?(?:\([^\n\0]*\)|\s[-+*/|&]?=\s[^\n\0]*));(?=[ \t\0]*$)",
    re.MULTILINE,
)
_JUMP = re.compile(r"\b(?:break|continue);")


def text_changes(source: str) -> Iterator[Change]:
    """All changes of a file, in the order of its text."""
    plain = _LEFT_OUT.sub(lambda match: re.sub(r"[^\n]", "\0", match.group()), source)
    yield from sorted(_all(source, plain), key=lambda change: (change.start, change.end))


def _all(source: str, plain: str) -> Iterator[Change]:
    def change(start: int, end: int, new: str, kind: str) -> Change:
        return Change(start, end, new, kind, plain.count("\n", 0, start) + 1)

    for match in _OPERATOR.finditer(plain):
        if not _of_a_template(plain, match):
            yield change(*match.span(), _OTHER[match.group()], "operator")
    for match in _NUMBER.finditer(plain):
        number = match.group()
        new = str(int(number) + 1) if number.isdigit() else f"(1.5 * {number})"
        yield change(*match.span(), new, "constant")
    for match in _TRUTH.finditer(plain):
        yield change(*match.span(), "false" if match.group() == "true" else "true", "constant")
    for match in _CONDITION.finditer(plain):
        end = _closing(plain, match.end())
        if end is not None:
            condition = source[match.end() : end]
            yield change(match.end(), end, f"!({condition})", "branch")
    for match in _STATEMENT.finditer(plain):
        if match.group(1).count("(") == match.group(1).count(")"):
            yield change(match.start(1), match.end(), ";", "statement")
    for match in _JUMP.finditer(plain):
        yield change(*match.span(), ";", "statement")


def _of_a_template(plain: str, match: re.Match[str]) -> bool:
    line = plain[plain.rfind("\n", 0, match.start()) + 1 : plain.find("\n", match.end())]
    return match.group().strip() in "<>" and "template" in line


def _closing(plain: str, start: int) -> int | None:
    """Where the parenthesis closes that opened before a place."""
    depth = 1
    for index in range(start, len(plain)):
        depth += (plain[index] == "(") - (plain[index] == ")")
        if depth == 0:
            return index
    return None
