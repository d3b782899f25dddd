"""Defaults are promises: a script that leaves arguments out computes after an update what it did before."""

from __future__ import annotations

from difflib import unified_diff

from tests.face.defaults import RECORDED, defaults


def test_defaults_of_the_modern_api_are_those_recorded() -> None:
    recorded = RECORDED.read_text(encoding="utf-8").splitlines()
    changed = list(unified_diff(recorded, defaults(), "recorded", "now", n=0, lineterm=""))
    assert not changed, "python -m tests.face.defaults records what is meant:\n" + "\n".join(changed)
