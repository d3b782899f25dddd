"""Other limits of the budget of reading, for a while."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict

from carom.files.budget import set_budget


@contextmanager
def limited(**limits: float) -> Iterator[None]:
    """A context with these limits."""
    before = set_budget(**limits)
    try:
        yield
    finally:
        set_budget(**asdict(before))
