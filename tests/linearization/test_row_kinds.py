"""Numbers that stand for kinds are different ones."""

from __future__ import annotations

from carom.layouts import linearization


def test_kinds_of_rows_are_different():
    kinds = {
        name: value
        for name, value in vars(linearization).items()
        if name.endswith(("_ROW", "_FRICTION", "TENDON_SPRING", "TENDON_LIMIT")) and name != "INPUT_FRICTION"
    }
    assert len(kinds) == 19
    assert sorted(kinds.values()) == list(range(len(kinds)))
