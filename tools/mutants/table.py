"""The table of mutants by rooms."""

from __future__ import annotations

from collections.abc import Sequence

from tools.mutants.drawing import Drawn

NOTICED = ("killed", "timed out")
"""What becomes of mutants that tests notice."""
EQUIVALENT = "equivalent"
_NOT_COUNTED = (None, "does not build", EQUIVALENT)


def table(outcomes: Sequence[tuple[Drawn, str | None]], wanted: float) -> tuple[str, bool]:
    """A table of what became of mutants, with those that were not noticed below.

    Args:
        outcomes: Mutants and what became of them; None for those that were not tried.
        wanted: The share that is to be noticed in each room.

    Returns:
        The text, and whether all rooms have their share.
    """
    lines = ["", "| room | mutants | noticed | share |", "|---|---|---|---|"]
    passed = True
    counted = [(drawn, result) for drawn, result in outcomes if result not in _NOT_COUNTED]
    for room in sorted({drawn.room for drawn, _ in counted}):
        results = [result for drawn, result in counted if drawn.room == room]
        noticed = sum(result in NOTICED for result in results)
        passed &= noticed >= wanted * len(results)
        lines.append(f"| {room} | {len(results)} | {noticed} | {noticed / len(results):.0%} |")
    noticed = sum(result in NOTICED for _, result in counted)
    lines.append(f"| all | {len(counted)} | {noticed} | {noticed / max(1, len(counted)):.0%} |")
    left = sum(result is None for _, result in outcomes)
    equal = sum(result == EQUIVALENT for _, result in outcomes)
    unbuilt = len(outcomes) - left - equal - len(counted)
    lines.append(f"\n{left} not tried, {equal} equivalent, {unbuilt} do not build")
    lines += [f"{result}: {drawn.name}" for drawn, result in counted if result not in NOTICED]
    return "\n".join(lines), passed
