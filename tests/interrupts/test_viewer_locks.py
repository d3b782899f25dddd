"""Locks of the viewer: what runs in the middle of a call that holds one can make the same call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.interrupts.faults import Fault, Fuse
from tests.interrupts.test_nested_changes import WAYS, _at_line

from carom.native import uninterrupted
from carom.viewer.input.gamepads import Gamepads
from carom.viewer.input.keys import Keyboard
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.lenses import Lenses
from carom.viewer.messages import decoded

_PAD = {"gamepads": [{"name": "pad", "axes": [0.5], "buttons": [1.0], "standard": True}]}
# Of the lines of a call, about so many are tried.
_TRIED = 8
_EYE = np.eye(4)


class _Lock:
    """Raises an error where a lock would wait for ever."""

    held = False

    def __enter__(self) -> None:
        assert not self.held, "this thread would wait for itself"
        self.held = True

    def __exit__(self, *_: object) -> None:
        self.held = False


def _messages() -> tuple[Any, dict[str, Callable[[], object]]]:
    latest = LatestMessages()
    latest.put("a", {"n": 1})
    latest.put("b", {"n": 2})
    reader = latest.reader()
    return latest, {
        "put": lambda: latest.put("a", {"n": 3}),
        "amend": lambda: latest.amend("b", {"n": 4}),
        "remove": lambda: latest.remove("b", {"n": 5}),
        "since": lambda: latest.since(0),
        "reader": latest.reader,
        "forget_removals": lambda: (reader.changes(), latest.forget_removals(None)),
    }


def _keys() -> tuple[Any, dict[str, Callable[[], object]]]:
    keys = Keyboard()
    return keys, {
        "press": lambda: keys.press(1, "a", "KeyA"),
        "release": lambda: keys.release(1, "a", "KeyA"),
        "release_all": lambda: keys.release_all(1),
        "events": keys.events,
    }


def _pads() -> tuple[Any, dict[str, Callable[[], object]]]:
    pads = Gamepads()
    return pads, {"take": lambda: pads.take(1, _PAD), "all": pads.all, "forget": lambda: pads.forget(1)}


def _lenses() -> tuple[Any, dict[str, Callable[[], object]]]:
    lenses = Lenses(LatestMessages(), None)
    return lenses, {"saw": lambda: lenses.saw(_EYE, _EYE, 8, 8)}


@pytest.mark.parametrize("way", ["signal", "tracer"])
@pytest.mark.parametrize("make", [_messages, _keys, _pads, _lenses])
def test_a_call_within_a_call_does_not_wait_for_it(make: Any, way: str) -> None:
    for outer, inner in zip(make()[1], reversed(make()[1]), strict=True):
        with _at_line(0, lambda: None) as count:
            uninterrupted._State.keeps_tracing = way != "tracer"
            make()[1][outer]()
        for line in range(1, count[0] + 1, 1 + count[0] // _TRIED):
            made, calls = make()
            made._lock = _Lock()
            errors: list[BaseException] = []

            def interrupt(call: Any = calls[inner], errors: list[BaseException] = errors) -> None:
                try:
                    call()
                except BaseException as problem:
                    # Python only prints what a finalizer raises.
                    errors.append(problem)

            with WAYS[way](line, interrupt):
                calls[outer]()
            assert not errors, (outer, inner, line)


def test_a_finalizer_draws_while_a_message_is_put() -> None:
    latest, calls = _messages()
    latest._lock = _Lock()
    done: list[None] = []
    for line in range(5, 15):
        with WAYS["finalizer"](line, lambda: (calls["put"](), done.append(None))):
            calls["remove"]()
            calls["put"]()
    assert len(done) > 5


def test_a_message_that_ctrl_c_breaks_off_is_the_old_or_the_new_one() -> None:
    fuse = Fuse()
    fuse.blow(_messages()[1]["put"])
    olds = 0
    for place in range(1, fuse.count + 1):
        latest, calls = _messages()
        with pytest.raises(Fault):
            Fuse(place).blow(calls["put"])
        messages, revision = latest.since(0)
        headers = [decoded(message)[0]["n"] for message in messages]
        assert headers in ([1, 2], [2, 3]), place
        olds += headers == [1, 2]
        latest.put("c", {"n": 6})
        assert [decoded(message)[0] for message in latest.since(revision)[0]] == [{"n": 6}]
    assert olds
