"""Arguments of learning scripts: `--key value value ...`, on the command line or in files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

_T = TypeVar("_T")
_TRUE = ("true", "True", "1", "T", "t")


class ArgParser:
    """Lists of words by key. The first value of a key is kept; words that begin with `#` are ignored."""

    global_parser: ArgParser | None = None

    def __init__(self) -> None:
        self._table: dict[str, list[str]] = {}

    def clear(self) -> None:
        """Removes all arguments."""
        self._table.clear()

    def load_args(self, arg_strs: Sequence[str]) -> bool:
        """Adds the arguments of a command line. Words before the first key are ignored.

        Returns:
            True.
        """
        given: list[tuple[str, list[str]]] = []
        for word in arg_strs:
            if word.startswith("--") and len(word) > 2:
                given.append((word[2:], []))
            elif given and not word.startswith("#"):
                given[-1][1].append(word)
        for key, words in given:
            self._table.setdefault(key, words)
        return True

    def load_file(self, filename: str) -> bool:
        """Adds the arguments of a file. Lines that begin with `#` are comments.

        Returns:
            True.
        """
        with open(filename, encoding="utf-8") as file:
            lines = file.read().splitlines()
        return self.load_args([word for line in lines if not line.startswith("#") for word in line.split()])

    def has_key(self, key: str) -> bool:
        """Whether a key is present."""
        return key in self._table

    def parse_string(self, key: str, default: str = "") -> str:
        """The first word after a key."""
        return self._first(key, default, str)

    def parse_strings(self, key: str, default: Sequence[str] = ()) -> list[str]:
        """All words after a key."""
        return self._all(key, default, str)

    def parse_int(self, key: str, default: int = 0) -> int:
        """The whole number after a key."""
        return self._first(key, default, int)

    def parse_ints(self, key: str, default: Sequence[int] = ()) -> list[int]:
        """All whole numbers after a key."""
        return self._all(key, default, int)

    def parse_float(self, key: str, default: float = 0.0) -> float:
        """The number after a key."""
        return self._first(key, default, float)

    def parse_floats(self, key: str, default: Sequence[float] = ()) -> list[float]:
        """All numbers after a key."""
        return self._all(key, default, float)

    def parse_bool(self, key: str, default: bool = False) -> bool:
        """Whether `true`, `True`, `t`, `T` or `1` comes after a key."""
        return self._first(key, default, _is_true)

    def parse_bools(self, key: str, default: Sequence[bool] = ()) -> list[bool]:
        """For each word after a key, whether it is `true`, `True`, `t`, `T` or `1`."""
        return self._all(key, default, _is_true)

    def _first(self, key: str, default: Any, read: Callable[[str], _T]) -> _T:
        return read(self._table[key][0]) if key in self._table else default

    def _all(self, key: str, default: Any, read: Callable[[str], _T]) -> list[_T]:
        return [read(word) for word in self._table[key]] if key in self._table else list(default)


def _is_true(word: str) -> bool:
    return word in _TRUE
