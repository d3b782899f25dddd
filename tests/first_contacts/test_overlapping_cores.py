"""Shapes deeper in each other than their margins touch where they do in PyBullet."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.first_contacts.overlapping_cores import ON_TABLES, PAIRS, contacts

import pybullet as p

RECORDED = json.loads((Path(__file__).parent / "overlapping_cores.json").read_text())


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize("pair", PAIRS)
def test_overlapping_cores_touch_as_recorded(pair: str) -> None:
    found, recorded = np.array(contacts(p, pair)), np.array(RECORDED[pair])
    assert found.shape == recorded.shape
    # At edges Bullet's search ends where its 128 corners are used up, a little before the nearest point.
    assert_allclose(found, recorded, atol=1e-6 if pair in ON_TABLES else 5e-4)


def test_nothing_else_is_recorded() -> None:
    assert list(RECORDED) == list(PAIRS)
