"""The files that fuzzers damage are good ones, or all that is tried is what readers refuse at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.fuzz import readers


def test_seeds_are_loaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    outcomes = {}
    for kind, seeds in readers.SEEDS.items():
        for number, content in enumerate(seeds()):
            Path(f"{number}.{kind}").write_bytes(content)
            outcomes[f"{number}.{kind}"] = readers.load(kind, f"{number}.{kind}")
    assert {name: outcome for name, outcome in outcomes.items() if outcome != "loaded"} == {}
