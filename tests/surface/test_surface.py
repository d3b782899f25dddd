"""Every function of the interface, called in every way: what comes of it is what comes of it in PyBullet.

`make surface` makes the same calls with real PyBullet and records what comes of them; so the test itself is
known to be true.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tests.each import each
from tests.rings import few

import pybullet as p

from .call import CLIENT, TABLE
from .calls import CALLS
from .compare import differences
from .differences import MEANT, meant, unheard
from .perform import Places, changed, tried, untouched

RECORDED: dict[str, Any] = json.loads(Path(__file__).with_name("oracle.json").read_text())


def test_every_function_and_every_keyword_is_called() -> None:
    assert CALLS.keys() == TABLE.keys() == RECORDED.keys() - {"pybullet"}
    for function, calls in CALLS.items():
        names = {name for name, *_ in TABLE[function]["parameters"] or ()} - {CLIENT}
        assert names <= {*calls.needed, *calls.other}, function


@each("function", CALLS)
def test_every_listed_error_has_been_heard(function: str) -> None:
    heard = {outcome.get("text") for outcome in RECORDED[function].values()}
    silent = [text for text in TABLE[function]["errors"] if text not in heard]
    assert [text for text in silent if not unheard(function, text)] == []


@pytest.mark.parametrize("function", few(CALLS, 12))
def test_what_comes_of_calls_is_what_comes_of_them_in_pybullet(function: str, tmp_path: Path) -> None:
    calls, places = CALLS[function], Places(str(tmp_path))
    before = untouched(p, calls, places)
    problems, outcomes, met = [], {}, set()
    for call in calls.each(function):
        ours = tried(p, function, calls, call, places)
        ours["changes"] = changed(before, ours.pop("seen"))
        outcomes[call.title] = ours
        for what, how in differences(RECORDED[function][call.title], ours, before):
            reason = meant(function, call.title, what)
            if reason is None:
                problems.append(f"{call.title}: {what}: {how}")
            else:
                met.add(reason)
    assert problems == []
    assert {reason for reason in MEANT if reason[0] == function} <= met, "differences that are none"
    assert outcomes.keys() == RECORDED[function].keys()
    if "needed" in outcomes:
        assert outcomes["by position"] == outcomes["needed"]
