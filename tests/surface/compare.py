"""What is different between what came of a call with PyBullet and with Carom."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

NEAR = 2e-5
"""Numbers may differ by this much, relative to the greater of 1 and their size."""


def differences(
    theirs: dict[str, Any], ours: dict[str, Any], untouched: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """What is different, and how.

    Args:
        theirs: What came of the call with PyBullet.
        ours: The same with Carom.
        untouched: What is seen with Carom without the call.

    Yields:
        `"raises"`, `"text"`, `"returns"`, `"value"` or the name of what is seen afterwards; and a text.
    """
    if "crashes" in theirs:
        return
    raised = theirs.get("raises")
    if raised == "SystemError":
        # Raised by mistake there.
        raised = ours.get("raises") or "pybullet.error"
    if raised != ours.get("raises"):
        yield "raises", f"{raised}: {theirs.get('text', '')} | {ours.get('raises')}: {ours.get('text', '')}"
    elif theirs.get("raises") == "pybullet.error":
        if not ours["text"].startswith(theirs["text"]):
            yield "text", f"{theirs['text']} | {ours['text']}"
    elif raised is None:
        if theirs["returns"] != ours["returns"]:
            yield "returns", f"{theirs['returns']} | {ours['returns']}"
        elif not close(theirs["value"], ours["value"]):
            yield "value", f"{theirs['value']} | {ours['value']}"
    for name in sorted({*theirs["changes"], *ours["changes"]}):
        before = untouched.get(name)
        there, here = theirs["changes"].get(name, before), ours["changes"].get(name, before)
        if not close(there, here):
            yield name, f"{there} | {here}"


def close(theirs: Any, ours: Any) -> bool:
    """Both are the same but for rounding."""
    if isinstance(theirs, list) and isinstance(ours, list):
        return len(theirs) == len(ours) and all(map(close, theirs, ours))
    if isinstance(theirs, dict) and isinstance(ours, dict):
        return theirs.keys() == ours.keys() and all(close(theirs[name], ours[name]) for name in theirs)
    if isinstance(theirs, (int, float)) and isinstance(ours, (int, float)):
        return abs(theirs - ours) <= NEAR * max(1.0, abs(theirs))
    return theirs == ours
