"""Random programs of calls, whose results have to be those that PyBullet had; `make differ` makes more."""

from __future__ import annotations

import json
import lzma
from typing import Any

import pytest
from tools.differ.causes.known import statement
from tools.differ.compare import compare
from tools.differ.pair import Outcome
from tools.differ.perform import perform
from tools.differ.programs import script
from tools.differ.record import SAMPLE
from tools.differ.themes import THEMES

import pybullet_data

PROGRAMS: list[dict[str, Any]] = json.loads(lzma.decompress(SAMPLE.read_bytes()))


@pytest.mark.parametrize("theme", THEMES)
def test_programs_have_pybullets_results(theme: str):
    programs = [program for program in PROGRAMS if program["theme"] == theme]
    assert programs
    for program in programs:
        calls = program["calls"]
        results = list(perform(calls, pybullet_data.getDataPath()))
        # As JSON has them: what was recorded went through it, too.
        ours: Outcome = {"results": json.loads(json.dumps(results)), "died": None}
        for found in compare(calls, program["theirs"], ours):
            assert statement(calls, found), (
                f"{found.signature}: {found.place}\n{script(calls[: found.call + 1])}"
            )


def test_the_sample_calls_most_functions():
    called = {call["f"] for program in PROGRAMS for call in program["calls"]}
    assert len(called) > 75
