"""What `World.constrain` is given: wrong kinds and orders of arguments, and the sentence that helps."""

from __future__ import annotations

from collections.abc import Container, Sequence
from typing import Any, Literal

import numpy as np

Kind = Literal["fixed", "point", "hinge", "slide", "gear"]
KINDS = ("fixed", "point", "hinge", "slide", "gear")
# What others call them; the numbers are PyBullet's.
_ELSEWHERE = {
    **dict.fromkeys(("weld", "joint_fixed", "rigid", 4), "fixed"),
    **dict.fromkeys(("connect", "ball", "spherical", "point2point", "p2p", "joint_point2point", 5), "point"),
    **dict.fromkeys(("revolute", "continuous", "joint_revolute", 0), "hinge"),
    **dict.fromkeys(("prismatic", "joint_prismatic", "slider", 1), "slide"),
    **dict.fromkeys(("mimic", "joint", "joint_gear", 6), "gear"),
}
_ORDER = "the order is constrain(a, b, kind)"


def check_order(names: Container[Any], a: Any, b: Any, kind: Any) -> None:
    """Refuse kinds that there are not, and arguments in another order.

    Args:
        names: The names of bodies, which may be those of kinds, too.
        a: As `World.constrain` is given it.
        b: Likewise.
        kind: Likewise.

    Raises:
        TypeError: `a` is the kind or the world, `b` is the kind or a point, or the kind is a body.
        ValueError: There is no such kind, or a link would be held to itself.
    """
    other = "None" if isinstance(kind, str) and _named(kind) is not None else _called(kind)
    for given, first in ((a, "BODY" if b is None else _called(b)), (b, _called(a))):
        if _is_kind(names, given):
            right = f"constrain({first}, {other}, {_named(given)!r})"
            raise TypeError(f"{_ORDER}: {right}; None stands for the world")
    if hasattr(kind, "body") or hasattr(kind, "links"):
        raise TypeError(
            f"{_ORDER}, with kind one of {_listed()}; links have no numbers of their own: {_LINKS}"
        )
    if kind not in KINDS:
        meant = _named(kind)
        instead = f"; here it is {meant!r}" if meant is not None else ""
        raise ValueError(f"kind must be one of {_listed()}, not {kind!r}{instead}")
    if a is None:
        raise TypeError(f"{_ORDER}: what is held comes first, and None, the world, second")
    if isinstance(b, (Sequence, np.ndarray)) and not isinstance(b, str):
        raise TypeError(
            f"{_ORDER}: b is a link, a body or None, not {b!r}; a point is at=(x, y, z), and to=(x, y, z) "
            "where it is pulled"
        )
    if a is b or (_place(a) is not None and _place(a) == _place(b)):
        raise ValueError(f"{_called(a)} cannot be held to itself: with None as b it is held in the world")


def _place(it: Any) -> tuple[Any, int] | None:
    """The body of a link, and its number there; None for what is no link."""
    return (it.body, it.index) if hasattr(it, "index") and hasattr(it, "body") else None


_LINKS = "constrain(arm.links['hand'], cube, 'fixed')"


def _is_kind(names: Container[Any], it: Any) -> bool:
    """Whether something is a kind, and no body that has such a name."""
    return isinstance(it, str) and _named(it) is not None and it not in names


def _named(kind: Any) -> str | None:
    """The kind that somebody means, if any."""
    if isinstance(kind, str):
        low = kind.lower()
        return low if low in KINDS else _ELSEWHERE.get(low)
    return _ELSEWHERE.get(int(kind)) if isinstance(kind, (int, np.integer)) else None


def _listed() -> str:
    return ", ".join(map(repr, KINDS))


def _called(it: Any) -> str:
    """How a body or a link is called in a message."""
    if hasattr(it, "body"):
        return f"{it.body.name}.links[{it.name!r}]"
    return it.name if hasattr(it, "links") else repr(it)
