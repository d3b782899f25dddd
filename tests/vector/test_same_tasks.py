"""A task is the same after an update: policies that were trained on it still play it, and results compare."""

import json
from typing import Any

import pytest
from numpy.testing import assert_allclose
from tests.vector.record_tasks import RECORDED, TASKS, ground, played


@pytest.fixture(scope="module")
def recorded() -> dict[str, Any]:
    return json.loads(RECORDED.read_text(encoding="utf-8"))


@pytest.mark.parametrize("task", TASKS)
def test_observations_and_rewards_are_those_recorded(task: str, recorded: dict[str, Any]):
    found, expected = played(task), recorded["tasks"][task]
    # `python -m tests.vector.record_tasks` records a task that has been changed on purpose.
    assert_allclose(found["observations"], expected["observations"], rtol=1e-5, atol=1e-5)
    assert_allclose(found["rewards"], expected["rewards"], rtol=1e-5, atol=1e-5)


def test_the_ground_of_a_seed_is_the_one_recorded(recorded: dict[str, Any]):
    assert_allclose(ground(0), recorded["ground"], rtol=1e-6, atol=1e-6)
