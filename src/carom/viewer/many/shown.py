"""Which of many worlds are shown, and where; and what was seen of them last."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import ceil, sqrt
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from carom.native.uninterrupted import uninterrupted
from carom.viewer.many.extent import extent_of

if TYPE_CHECKING:
    from carom.scene.core.restorable import Restorable
    from carom.viewer.many.viewed import ViewedWorlds

Arrangement = Literal["grid", "overlay"]
ARRANGEMENTS: tuple[str, ...] = get_args(Arrangement)

MOST = 256
"""Maximum number of worlds that are shown."""
USUAL = 16
"""Number of worlds that are shown at first."""


@dataclass(frozen=True, slots=True)
class Plan:
    """Which worlds are shown, and where.

    Attributes:
        numbers: The worlds, in the order of their places.
        chosen: The one of them that is looked at, and whose readings are told.
        arrangement: Side by side, or all in one place.
        spacing: Distance of neighbours in the grid [m].
    """

    numbers: tuple[int, ...]
    chosen: int
    arrangement: Arrangement
    spacing: float

    def others(self) -> list[tuple[int, int]]:
        """Place and number of each world but the chosen one."""
        return [(place, number) for place, number in enumerate(self.numbers) if number != self.chosen]

    def offsets(self) -> NDArray[np.float32]:
        """Where each world is drawn [m], (n, 3): the chosen one where it is, so that its numbers are true."""
        places = np.arange(len(self.numbers))
        found = np.zeros((len(places), 3), dtype=np.float32)
        if self.arrangement == "grid":
            columns = ceil(sqrt(len(places)))
            found[:, 0], found[:, 1] = places % columns, -(places // columns)
            found *= self.spacing
            found -= found[self.numbers.index(self.chosen)]
        return found


@dataclass(frozen=True, slots=True)
class Seen:
    """What was seen of the worlds at a moment.

    Attributes:
        plan: Which worlds these are.
        poses: Poses of all their links (n, links, 7).
        absent: Which links belong to bodies that are absent (n, links); None if none is.
        time: Simulated time of the chosen world [s].
    """

    plan: Plan
    poses: NDArray[np.float32]
    absent: NDArray[np.bool_] | None
    time: float


class ShownWorlds:
    """The worlds that are shown, and the chosen one as a `World`.

    Attributes:
        centre: The middle of a world from above, as it was at first: (x, y) [m].
        lone: The chosen world; its lock is held while it is refilled.
        plan: Which worlds are shown now.
        seen: What was seen last.

    Args:
        worlds: All worlds.
        shown: How many of them are shown, or which ones.
        chosen: The one that is looked at first; None for the first shown one.
        arrangement: "grid" or "overlay".
        spacing: Distance of neighbours in the grid [m]; None for as much as their bodies need.

    Raises:
        ValueError: There are no such worlds, none or too many are shown, or there is no such arrangement.
        NotImplementedError: They have soft bodies.
    """

    def __init__(
        self,
        worlds: ViewedWorlds,
        shown: int | Iterable[int] = USUAL,
        chosen: int | None = None,
        arrangement: str = "grid",
        spacing: float | None = None,
    ) -> None:
        self.worlds: ViewedWorlds = worlds
        numbers = self._numbers(shown)
        first = numbers[0] if chosen is None else int(chosen)
        self._check(first)
        self.lone: Restorable = worlds.extract(first)
        if any(body.spec.soft is not None for body in self.lone.bodies.values()):
            raise NotImplementedError(
                "many worlds with soft bodies are not shown yet; extract(number) gives one that is"
            )
        if spacing is not None and not 0.0 < spacing < np.inf:
            raise ValueError(f"spacing must be a distance above 0, not {spacing}")
        centre, size = extent_of(self.lone)
        self.centre: tuple[float, float] = centre
        room = size if spacing is None else float(spacing)
        self.plan: Plan = Plan(numbers, first, _arrangement(arrangement), room)
        if first not in numbers:
            self.plan = replace(self.plan, numbers=self._around(first, len(numbers)))
        self._filled: int | None = None
        self.seen: Seen = self._look()

    def choose(self, number: int) -> None:
        """Looks at another world; if it is not shown, those around it are shown instead.

        Raises:
            ValueError: There is no such world.
        """
        self._check(number)
        plan = self.plan
        numbers = plan.numbers if number in plan.numbers else self._around(number, len(plan.numbers))
        self.plan = replace(plan, numbers=numbers, chosen=number)

    def show(self, shown: int | Iterable[int]) -> None:
        """Shows so many worlds around the chosen one, or these.

        Raises:
            ValueError: There are no such worlds, or none or too many.
        """
        chosen = self.plan.chosen
        numbers = self._numbers(shown)
        if isinstance(shown, int):
            numbers = self._around(chosen, len(numbers))
        self.plan = replace(self.plan, numbers=numbers, chosen=chosen if chosen in numbers else numbers[0])

    def arrange(self, arrangement: str) -> None:
        """Shows the worlds side by side, or all in one place.

        Raises:
            ValueError: There is no such arrangement.
        """
        self.plan = replace(self.plan, arrangement=_arrangement(arrangement))

    def take(self, message: dict[str, Any]) -> None:
        """Does what a page asks for.

        Raises:
            ValueError: There is no such world or arrangement, or none or too many are to be shown.
        """
        if "shown" in message:
            self.show(min(int(message["shown"]), MOST))
        if "arrangement" in message:
            self.arrange(message["arrangement"])
        if "chosen" in message:
            self.choose(int(message["chosen"]))

    def look(self, patience: float) -> bool:
        """Sees the worlds as they are now; false if they are being stepped for longer than so [s]."""
        if not self.worlds.lock.acquire(timeout=patience):
            return False
        try:
            self.seen = self._look()
        finally:
            self.worlds.lock.release()
        return True

    def _look(self) -> Seen:
        plan, glimpses = self.plan, self.worlds.glimpses
        numbers = np.array(plan.numbers)
        time = float(self.worlds.time[plan.chosen])
        with uninterrupted, self.lone.lock:
            glimpses.refill(self.lone, plan.chosen, parameters=plan.chosen != self._filled)
            self.lone.time = time
            self._filled = plan.chosen
        poses = glimpses.poses(numbers)
        return Seen(plan, poses, glimpses.absent(numbers, np.arange(poses.shape[1])), time)

    def _numbers(self, shown: int | Iterable[int]) -> tuple[int, ...]:
        count = self.worlds.count
        if isinstance(shown, int):
            numbers = tuple(range(min(shown, count)))
        else:
            numbers = tuple(dict.fromkeys(int(number) for number in shown))
        if not 1 <= len(numbers) <= MOST or (isinstance(shown, int) and shown > MOST):
            asked = shown if isinstance(shown, int) else len(numbers)
            raise ValueError(f"shown must be 1 to {MOST} worlds, or their indices, not {asked}")
        for number in numbers:
            self._check(number)
        return numbers

    def _check(self, number: int) -> None:
        if not 0 <= number < self.worlds.count:
            raise ValueError(f"there is no world {number}: there are worlds 0 to {self.worlds.count - 1}")

    def _around(self, number: int, count: int) -> tuple[int, ...]:
        """So many worlds with one among them: its page, as in a book."""
        first = min(number // count * count, self.worlds.count - count)
        return tuple(range(first, first + count))


def _arrangement(name: Any) -> Arrangement:
    if name not in ARRANGEMENTS:
        raise ValueError(f"arrangement must be one of {', '.join(map(repr, ARRANGEMENTS))}, not {name!r}")
    return name
