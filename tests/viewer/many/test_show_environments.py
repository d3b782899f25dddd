"""`show` of vector environments: a window that goes along with training."""

from __future__ import annotations

import pytest
from tests.viewer.watcher import Watcher

gymnasium = pytest.importorskip("gymnasium")

from carom.vector.panda import PandaReach  # noqa: E402


def test_environments_are_shown_while_they_are_stepped(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("CI", "true")
    environments = PandaReach(8)
    environments.reset(seed=1)
    viewer = environments.show(shown=4, port=0)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("worlds", None) in page.shown and page.frame)
        assert page.shown["worlds", None]["shown"] == [0, 1, 2, 3]
        assert page.shown["title", None]["title"] == "PandaReach"
        for _ in range(3):
            environments.step(environments.action_space.sample())
        page.wait_for(lambda: page.frame["time"] == environments.worlds.time[0] > 0.0)
    assert environments.show() is viewer
    environments.close()
    assert not viewer.is_open
    assert environments.worlds.observers == []
