"""What declares a message: its type, its fields and what follows them in binary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.viewer.protocol.kinds import Kind

REMOVAL = "no "
"""What the type of a message begins with that removes what another one, of the type after it, has shown."""


@dataclass(frozen=True, eq=False, slots=True)
class Field:
    """A field of a message: its kind of values and its meaning; whether it may be missing."""

    kind: Kind
    meaning: str
    optional: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Message:
    """A message. Called with its fields it makes a header.

    Attributes:
        type: Its type, the first field of its header.
        meaning: What it tells.
        fields: Its other fields, by name.
        payload: What follows the header in binary; empty if nothing does.
        kept: What histories keep it by: the field with its number, or empty if there is one at a time. None
            if it is only for the present.
    """

    type: str
    meaning: str
    fields: Mapping[str, Field]
    payload: str = ""
    kept: str | None = None

    @property
    def kind(self) -> str | None:
        """What histories keep it as, with its number if it has one; None if they do not keep it."""
        return None if self.kept is None else self.kept or self.type.removeprefix(REMOVAL)

    def __call__(self, **fields: Any) -> dict[str, Any]:
        """A header with these fields; `TypeError` for a field that is not declared, or missing."""
        if fields.keys() != self.fields.keys():
            unknown = fields.keys() - self.fields.keys()
            missing = {name for name in self.fields.keys() - fields.keys() if not self.fields[name].optional}
            if unknown or missing:
                raise TypeError(
                    f"a {self.type!r} message has the fields {', '.join(self.fields) or 'none'}: "
                    f"unknown are {sorted(unknown)}, missing {sorted(missing)}"
                )
        return {"type": self.type, **fields}

    def check(self, header: Mapping[str, Any]) -> None:
        """Raises `ValueError` if a field is missing or has a wrong kind of value.

        Fields that are not declared are ignored: the sender may be a page of another version.
        """
        for name, field in self.fields.items():
            if name not in header:
                if not field.optional:
                    raise ValueError(f"a {self.type!r} message needs the field {name!r}")
            elif not field.kind.holds(header[name]):
                raise ValueError(
                    f"{name!r} of a {self.type!r} message has to be {field.kind}, "
                    f"not {str(header[name])[:_MAX_SHOWN]!r}"
                )


# Maximum length of a wrong value in the text of an error.
_MAX_SHOWN = 60


def needed(kind: Kind, meaning: str) -> Field:
    """A field that every message of its type has."""
    return Field(kind, meaning)


def optional(kind: Kind, meaning: str) -> Field:
    """A field that may be missing."""
    return Field(kind, meaning, optional=True)


def declared(module: Mapping[str, Any]) -> dict[str, Message]:
    """The messages among the names of a module, by the names of their constants."""
    return {name: value for name, value in module.items() if isinstance(value, Message)}
