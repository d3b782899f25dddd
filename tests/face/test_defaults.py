"""Defaults are promises: a script that leaves arguments out computes after an update what it did before."""

from __future__ import annotations

from tests.face.defaults import RECORDED, defaults


def test_defaults_of_the_modern_api_are_those_recorded() -> None:
    """What is new need not be there yet."""
    recorded = RECORDED.read_text(encoding="utf-8").splitlines()
    gone = sorted(set(recorded) - set(defaults()))
    assert not gone, "python -m tests.face.defaults records changes that are meant:\n" + "\n".join(gone)
