"""An environment is the same after an update: from a seed on, the same observations and rewards."""

from __future__ import annotations

import json

import numpy as np
from tests.each import each
from tests.envs.record_seeded import RECORDED, environments, played

# `python -m tests.envs.record_seeded` records environments that have been changed on purpose.
_RECORDED = json.loads(RECORDED.read_text(encoding="utf-8"))


@each("name", environments())
def test_observations_and_rewards_of_a_seed_are_those_recorded(name: str) -> None:
    found = played(name)
    assert len(found) == len(_RECORDED[name])
    np.testing.assert_allclose(found, _RECORDED[name], rtol=1e-4, atol=1e-4)
