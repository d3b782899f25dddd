"""Many things of one kind, checked by one test that lists those which fail."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import pytest

Test = Callable[..., None]


def each(
    names: str | Sequence[str],
    values: Iterable[Any],
    ids: Callable[[Any], object] | Sequence[str] | None = None,
) -> Callable[[Test], Test]:
    """Run a test for each of many values, as `pytest.mark.parametrize` does, but as one test.

    It goes through all of them and lists those that fail. For what has no state between values:
    modules, files of data, entries of a table. Fixtures that the test asks for are the same for all values.

    Args:
        names: The arguments of the test, as a sequence or separated by commas.
        values: Of these arguments; tuples if there are several.
        ids: What a value is called in the list: as for `pytest.mark.parametrize`.
    """
    arguments = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    several = len(arguments) > 1 or not isinstance(names, str)
    rows = [_row(value, several) for value in values]

    def decorated(test: Test) -> Test:
        signature = inspect.signature(test)

        @functools.wraps(test)
        def over_all(**fixtures: Any) -> None:
            assert rows, "there is nothing to check"
            failures = []
            for index, row in enumerate(rows):
                try:
                    test(**dict(zip(arguments, row, strict=True)), **fixtures)
                except (Exception, pytest.fail.Exception) as error:
                    name = ids[index] if isinstance(ids, Sequence) else "-".join(_shown(x, ids) for x in row)
                    failures.append(f"{name}: {type(error).__name__}: {error}")
            if failures:
                listed = "\n".join(failures)
                pytest.fail(f"{len(failures)} of {len(rows)} fail:\n{listed}", pytrace=False)

        # The fixtures that it needs, and not what it wraps, whose arguments pytest would look for.
        del over_all.__wrapped__
        left = [parameter for name, parameter in signature.parameters.items() if name not in arguments]
        over_all.__signature__ = signature.replace(parameters=left)  # type: ignore[attr-defined]
        return over_all

    return decorated


def _row(value: Any, several: bool) -> tuple[Any, ...]:
    return tuple(value) if several else (value,)


def _shown(value: Any, ids: Any) -> str:
    return str(ids(value) if callable(ids) else value)[:200]
