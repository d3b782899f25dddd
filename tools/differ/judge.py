"""Says of differences whether something explains them: docs/differences, or other answers of PyBullet."""

from __future__ import annotations

from collections.abc import Sequence

from tools.differ.causes.again import Performer
from tools.differ.causes.bounds import has_present_bounds
from tools.differ.causes.depths import is_as_deep_elsewhere
from tools.differ.causes.digits import loses_digits
from tools.differ.causes.heights import touches_heights_elsewhere
from tools.differ.causes.known import statement
from tools.differ.causes.parted import keeps_what_parted
from tools.differ.causes.placed import was_placed_among_bare_links
from tools.differ.causes.rounding import doubted_by_pybullet
from tools.differ.causes.shadows import differs_by_shadows
from tools.differ.causes.surfaces import SURFACES, is_as_good, off_surfaces
from tools.differ.causes.tied import touches_what_it_is_tied_to
from tools.differ.causes.unmoved import hits_once_bounds_are_there
from tools.differ.compare import Difference
from tools.differ.pair import Outcome, Pair
from tools.differ.programs import Call

_POINTS = ("points", "normal")


class Judge:
    """Explains the differences of one program.

    Args:
        pair: Both interpreters; they perform the program again, as far as that is needed.
        calls: The program.
        theirs: PyBullet's answer.
        ours: Carom's.
        carom: Performs programs as Carom did; the pair's if left out.
    """

    def __init__(
        self,
        pair: Pair,
        calls: Sequence[Call],
        theirs: Outcome,
        ours: Outcome,
        carom: Performer | None = None,
    ) -> None:
        self._pair = pair
        self._calls = calls
        self._theirs = theirs
        self._ours = ours
        self._carom = carom or pair.carom

    def explanations(self, differences: Sequence[Difference]) -> list[str | None]:
        """Of each difference the words of the documentation about it; None if nothing explains it."""
        says = [statement(self._calls, difference) for difference in differences]
        asked: dict[int, list[int]] = {}
        for place, difference in enumerate(differences):
            nearest = difference.function == "getClosestPoints" and difference.place.field in _POINTS
            if nearest and not says[place]:
                asked.setdefault(difference.call, []).append(place)
        for call, places in asked.items():
            points = [point for place in places for point in differences[place].place[1:3]]
            off = off_surfaces(self._pair.oracle, self._calls[: call + 1], points)
            for place, theirs, ours in zip(places, off[::2], off[1::2], strict=True):
                says[place] = SURFACES if is_as_good(theirs, ours) else None
        return [says or self._shown(difference) for says, difference in zip(says, differences, strict=True)]

    def _shown(self, difference: Difference) -> str | None:
        """What other answers show about a difference."""
        oracle, carom, calls = self._pair.oracle, self._carom, self._calls
        theirs, ours = self._theirs, self._ours
        return (
            has_present_bounds(oracle, calls, difference)
            or hits_once_bounds_are_there(oracle, calls, theirs, ours, difference)
            or keeps_what_parted(oracle, calls, theirs, ours, difference)
            or was_placed_among_bare_links(oracle, calls, theirs, ours, difference)
            or touches_what_it_is_tied_to(oracle, calls, theirs, ours, difference)
            or doubted_by_pybullet(oracle, self._pair.afresh(), calls, theirs, ours, difference)
            or loses_digits(carom, calls, ours, difference)
            or is_as_deep_elsewhere(oracle, calls, theirs, ours, difference)
            or differs_by_shadows(oracle, carom, calls, difference)
            or touches_heights_elsewhere(oracle, carom, calls, theirs, ours, difference)
        )
