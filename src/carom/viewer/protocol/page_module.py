"""Writes what the page's modules know of the messages: constants, and types for `tsc`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

from carom.viewer.protocol import from_page, to_page
from carom.viewer.protocol.kinds import Bounds
from carom.viewer.protocol.message import REMOVAL, Message

CONSTANTS: Path = Path(__file__).parents[1] / "page" / "protocol.js"
"""The module with the constants, which is checked in."""
TYPES: Path = Path(__file__).parents[4] / "tools" / "page" / "messages.d.ts"
"""The file with the types, which is checked in as well, but not installed."""

_HEAD = """\
// %s. Written by `python -m carom.viewer.protocol` from
// src/carom/viewer/protocol, which is where to change them.
"""
_ANSWERS = """\
/** What takes each message to the page. */
type Answers = {
  [Type in MessageToPage["type"]]: (
    header: Extract<MessageToPage, { type: Type }>,
    payload: ArrayBuffer,
  ) => void;
};
"""


def constants() -> str:
    """The text of the module with the constants."""
    return "\n".join(
        [
            _HEAD % "Types and bounds of the messages between page and simulation",
            *_constants("ToPage", "Types of the messages to the page.", to_page.ALL),
            *_constants("FromPage", "Types of the messages from the page.", from_page.ALL),
            "/**",
            " * Least and greatest value of the numbers in the fields of messages from the page.",
            " *",
            " * @type {Readonly<Record<string, Readonly<Record<string, [number, number]>>>>}",
            " */",
            "export const BOUNDS = Object.freeze({",
            *_bounds(from_page.ALL),
            "});\n",
            "/** What the type of a message begins with that removes what another one has shown. */",
            f'export const REMOVAL = "{REMOVAL}";\n',
            "/**",
            " * What the history keeps messages by: the field with their number; empty without one.",
            " *",
            " * @type {Readonly<Record<string, string>>}",
            " */",
            "export const KEPT_BY = Object.freeze({",
            *(
                f'  [ToPage.{constant}]: "{message.kept}",'
                for constant, message in to_page.ALL.items()
                if message.kept is not None
            ),
            "});\n",
            "/** Types of the messages that a spectator's page may send: all others do nothing. */",
            f"export const SPECTATING = new Set({json.dumps(sorted(from_page.SPECTATING))});\n",
            "/** Fields in which frames of the same run of a recording may differ. */",
            f"export const OWN_OF_FRAMES = new Set({json.dumps(sorted(to_page.OWN_OF_FRAMES))});\n",
        ]
    )


def types() -> str:
    """The text of the file with the types."""
    return "\n".join(
        [
            _HEAD % "The messages between page and simulation",
            *_types("ToPage", to_page.ALL),
            *_types("FromPage", from_page.ALL),
            _ANSWERS,
        ]
    )


def _constants(name: str, meaning: str, messages: Mapping[str, Message]) -> Iterator[str]:
    yield f"/** {meaning} */"
    yield f"export const {name} = Object.freeze(/** @type {{const}} */ ({{"
    for constant, message in messages.items():
        yield f"  /** {message.meaning} */"
        yield f'  {constant}: "{message.type}",'
    yield "}));\n"


def _bounds(messages: Mapping[str, Message]) -> Iterator[str]:
    for constant, message in messages.items():
        bounds = [
            f"{name}: [{', '.join(map(_shown, field.kind.bounds))}]"
            for name, field in message.fields.items()
            if field.kind.bounds is not None
        ]
        if bounds:
            yield f"  [FromPage.{constant}]: {{ {', '.join(bounds)} }},"


def _types(direction: str, messages: Mapping[str, Message]) -> Iterator[str]:
    names = []
    for constant, message in messages.items():
        names.append(f"{constant.title().replace('_', '')}{direction}")
        yield f"/** {message.meaning}{f' Payload: {message.payload}' if message.payload else ''} */"
        yield f"interface {names[-1]} {{"
        yield f'  type: "{message.type}";'
        for field, facts in message.fields.items():
            yield f"  /** {facts.meaning}{_within(facts.kind.bounds)} */"
            yield f"  {field}{'?' if facts.optional else ''}: {facts.kind.typescript};"
        yield "}\n"
    yield f"type Message{direction} =\n  | {f'{chr(10)}  | '.join(names)};\n"


def _shown(bound: float) -> str:
    """A bound as JavaScript reads and a reader grasps it."""
    short = f"{bound:g}"
    return short if float(short) == bound else repr(bound)


def _within(bounds: Bounds | None) -> str:
    return "" if bounds is None else f" From {_shown(bounds[0])} to {_shown(bounds[1])}."
