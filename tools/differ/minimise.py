"""Makes a program as short as it can be while it still differs in the same way."""

from __future__ import annotations

import copy
from typing import Any

from tools.differ.causes.substeps import with_contacts_of_substeps
from tools.differ.compare import Difference, compare
from tools.differ.pair import Pair
from tools.differ.programs import Call, closed

_SECONDS = 10.0
_STATE = "@probe"


class Minimiser:
    """Makes programs short.

    Args:
        pair: Both interpreters.
        signature: Of the difference that is to stay; any two states that differ count as the same.
        budget: So many programs are tried.
    """

    def __init__(self, pair: Pair, signature: str, budget: int = 150) -> None:
        self._pair = pair
        self._signature = _STATE if signature.startswith(_STATE) else signature
        self._left = budget

    def minimise(self, calls: list[Call]) -> tuple[list[Call], Difference | None]:
        """The shortest program that was found, and how it differs; None if the program does not."""
        found = self._difference(calls)
        if found is None:
            return calls, None
        calls = calls[: found.call + 1]
        size = max(len(calls) // 2, 1)
        while self._left > 0:
            shorter, found_again = self._without(calls, size)
            if found_again:
                calls, found = shorter, found_again
            elif size == 1:
                break
            size = max(size // 2, 1)
        return self._simplified(calls, found)

    def _difference(self, calls: list[Call]) -> Difference | None:
        self._left -= 1
        theirs, ours = self._pair.run(calls, _SECONDS)
        found = compare(calls, theirs, ours)
        if found:
            theirs = with_contacts_of_substeps(self._pair.oracle, calls, theirs)
            found = compare(calls, theirs, ours)
        return next((one for one in found if one.signature.startswith(self._signature)), None)

    def _without(self, calls: list[Call], size: int) -> tuple[list[Call], Difference | None]:
        """The calls without all parts of a size that are not needed, tried from the end."""
        found = None
        end = len(calls)
        while end > 0 and self._left > 0:
            fewer = closed(calls[: max(end - size, 0)] + calls[end:])
            again = self._difference(fewer)
            if again:
                calls, found = fewer[: again.call + 1], again
            end = min(end - size, len(calls))
        return calls, found

    def _simplified(self, calls: list[Call], found: Difference) -> tuple[list[Call], Difference]:
        """Without keyword arguments that are not needed, and with rounded numbers."""
        for number in range(len(calls)):
            for change in (*calls[number]["k"], 1, 2, 3):
                trial = copy.deepcopy(calls)
                call = trial[number]
                if isinstance(change, str):
                    del call["k"][change]
                else:
                    call["a"], call["k"] = _rounded(call["a"], change), _rounded(call["k"], change)
                if trial == calls or self._left <= 0:
                    continue
                again = self._difference(trial)
                if again:
                    calls, found = trial, again
                    if not isinstance(change, str):
                        break
        return calls, found


def _rounded(value: Any, digits: int) -> Any:
    if isinstance(value, float):
        return round(value, digits)
    if isinstance(value, list):
        return [_rounded(part, digits) for part in value]
    if isinstance(value, dict):
        return {key: _rounded(part, digits) for key, part in value.items()}
    return value
