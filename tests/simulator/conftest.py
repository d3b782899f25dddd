from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from carom.simulator.simulator import Simulator, Start


@pytest.fixture
def simulate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Simulator]]:
    """Starts simulators, whose turns the test makes; they end with it."""
    monkeypatch.setenv("CI", "true")
    started: list[Simulator] = []

    def start(*paths: Path, **options: Any) -> Simulator:
        simulator = Simulator(paths, Start(port=0, **options))
        simulator.viewer.set_speed(None)
        started.append(simulator)
        return simulator

    yield start
    for simulator in started:
        simulator.close()
