"""How many random cases tests try: few in every run, many in `make thorough`.

`CAROM_TEST_PROFILE=thorough` chooses the long profile.
"""

from __future__ import annotations

import os

FACTORS = {"short": 1, "thorough": 20}
"""Profiles, and how many times the cases of the short one they try."""
DEFAULT_CASES = 40
"""Cases of properties that name no number, in the short profile."""

PROFILE = os.environ.get("CAROM_TEST_PROFILE", "short")
if PROFILE not in FACTORS:
    raise ValueError(f"CAROM_TEST_PROFILE is {PROFILE!r}: choose from {', '.join(FACTORS)}")


def cases(short: int) -> int:
    """How many random cases to try, where every run tries `short`."""
    return short * FACTORS[PROFILE]
