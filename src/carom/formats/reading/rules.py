"""What is lost with an element or attribute that a reader leaves out, and why: one table for each format."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

# Number of places whose rules are kept once they are found.
_MAX_PLACES = 4096


class Rule(NamedTuple):
    """Consequence and reason for one kind of element or attribute.

    Attributes:
        place: Names of an element and of those around it, as in `joint/mimic`; `*` is any. With `@name` an
            attribute of it, with `@*` any. A rule counts for all places that end like this one.
        consequence: What a simulation lacks without it.
        reason: Why it is left out.
        even_if_taken: The reader takes it, to keep it in the description, but nothing simulates it.
    """

    place: str
    consequence: str
    reason: str
    even_if_taken: bool = False


class Rules:
    """The rules of a format; the longest that fits counts, and of equally long ones that with fewer `*`.

    Args:
        format_name: Name of the format.
        rules: The rules.
    """

    def __init__(self, format_name: str, rules: Iterable[Rule]) -> None:
        self.format_name = format_name
        by_length = sorted(
            [(_parts(rule.place), rule) for rule in rules],
            key=lambda it: (len(it[0][0]), -it[0][0].count("*") - (it[0][1] == "*")),
            reverse=True,
        )
        # By their last names and attributes, each with its rank.
        self._ranked: dict[tuple[str, str | None], list[tuple[int, tuple[str, ...], Rule]]] = {}
        for rank, ((names, attribute), rule) in enumerate(by_length):
            self._ranked.setdefault((names[-1], attribute), []).append((rank, names, rule))
        self._longest = max((len(names) for (names, _), _ in by_length), default=1)
        # Files name the same places again and again.
        self._first = lru_cache(_MAX_PLACES)(self._first_that_fits)

    def of(self, path: tuple[str, ...], attribute: str | None, *, taken: bool) -> tuple[str, str] | None:
        """Consequence and reason for an element at a path of names, or an attribute of it.

        None if it was taken and is simulated.
        """
        rule = self._find(path, attribute)
        if taken and (rule is None or not rule.even_if_taken):
            return None
        if rule is None:
            what = "element" if attribute is None else "attribute"
            return "it has no effect", f"no {what} of {self.format_name} that Carom knows"
        return rule.consequence, rule.reason

    def know(self, path: tuple[str, ...]) -> bool:
        """Whether there is a rule for an element at a path of names."""
        return self._find(path, None) is not None

    def _find(self, path: tuple[str, ...], attribute: str | None) -> Rule | None:
        return self._first(path[-self._longest :], attribute)

    def _first_that_fits(self, path: tuple[str, ...], attribute: str | None) -> Rule | None:
        ends = {path[-1], "*"} if path else set[str]()
        found = (
            (rank, rule)
            for name in ends
            for of_attribute in {attribute, "*" if attribute else attribute}
            for rank, names, rule in self._ranked.get((name, of_attribute), ())
            if len(names) <= len(path)
            and all(it in ("*", other) for it, other in zip(names, path[-len(names) :], strict=True))
        )
        return min(found, key=lambda it: it[0], default=(0, None))[1]


def _parts(place: str) -> tuple[tuple[str, ...], str | None]:
    names, _, attribute = place.partition("@")
    return tuple(names.split("/")), attribute or None
