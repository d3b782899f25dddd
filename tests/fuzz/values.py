"""Values that are hard to take, in the place of ordinary arguments."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np

REALS: tuple[Any, ...] = (
    0.0, -0.0, 1.0, -1.0, 0.1, 5e-324, 1e-300, 1e-160, 1e-80, 1e-20, 1e-6, 1e3, 1e6, 1e15, 1e20, 1e80, 1e155,
    1e300, 1.7e308, -1e-300, -1e15, -1e300, float("inf"), float("-inf"), float("nan"),
)  # fmt: skip
INTEGERS: tuple[Any, ...] = (
    0, 1, -1, 2, 3, 77, 255, 1000, 65536, 10**6, 10**9, 2**31 - 1, -(2**31), 2**31, 2**63, 10**30, -(10**30),
)  # fmt: skip
TEXTS: tuple[str, ...] = (
    "", "x", " ", "a\0b", "\0", "é", "\ud800", "x" * 300, "x" * 5000, "..", "/", "/dev/null", "plane.urdf",
    "no/such/file.urdf", "%s%n", "-1", "nan", "a\nb",
)  # fmt: skip
STRANGE: tuple[Callable[[], Any], ...] = (
    lambda: None,
    lambda: True,
    lambda: "1",
    lambda: b"1",
    lambda: 1j,
    lambda: [],
    lambda: (),
    lambda: [1],
    lambda: {},
    lambda: {"a": 1},
    object,
    lambda: range(3),
    lambda: [[1, 2], [3]],
    lambda: np.float32(0.5),
    lambda: np.int64(2),
    lambda: np.array(1.0),
    lambda: np.array([1.0]),
    lambda: np.array([1.0, 2.0, 3.0]),
    lambda: np.zeros((2, 3)),
    lambda: np.array([1.0, float("nan"), 2.0]),
    lambda: np.array(["a", "b"]),
    lambda: np.array([1 + 2j]),
    lambda: iter([1.0, 2.0, 3.0]),
    lambda: (number for number in (1.0, 2.0, 3.0)),
    lambda: _Bad(),  # noqa: PLW0108 (it is defined below)
)


class _Bad:
    """An object whose every conversion fails in its own way."""

    def __float__(self) -> float:
        raise TypeError("no number")

    def __index__(self) -> int:
        raise TypeError("no index")

    def __len__(self) -> int:
        return 3

    def __getitem__(self, place: int) -> float:
        raise IndexError(place)


def spoiled(value: Any, random: Random) -> Any:
    """Something in the place of an argument: of its own kind but extreme, or of another kind."""
    if random.random() < 0.25:
        return random.choice(STRANGE)()
    if isinstance(value, str):
        return random.choice(TEXTS)
    if isinstance(value, bool) or value is None:
        return random.choice(STRANGE)()
    if isinstance(value, int):
        return random.choice(INTEGERS if random.random() < 0.8 else REALS)
    if isinstance(value, float):
        return random.choice(REALS)
    if isinstance(value, (list, tuple)):
        return _spoiled_list(list(value), random)
    return random.choice(STRANGE)()


def _spoiled_list(items: list[Any], random: Random) -> Any:
    match random.randrange(7):
        case 0:
            return items[:-1]
        case 1:
            return [*items, *items[:1], 0.0]
        case 2:
            return [random.choice(REALS) for _ in items]
        case 3:
            return np.array(items, dtype=object) if random.random() < 0.3 else tuple(items)
        case 4:
            scale = random.choice(REALS)
            return [item * scale if isinstance(item, (int, float)) else item for item in items]
        case _:
            if items:
                place = random.randrange(len(items))
                items[place] = spoiled(items[place], random)
            return items
