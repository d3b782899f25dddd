"""What ties the nodes of meshes: springs that stand for constraints."""

from __future__ import annotations

import numpy as np
import pytest

from carom.description.compliance import Compliance
from carom.soft.ties import Ties


def spring(masses: tuple[float, float], pinned: tuple[bool, bool] = (False, False)) -> np.ndarray:
    """Rest length [m], stiffness [N/m] and damping [N s/m] for a constraint of nodes of these masses [kg]."""
    ties = Ties(np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]), np.array([[0, 1]], np.int32), np.array(pinned))
    ties.add_constraint(Compliance(), np.array(masses), 0.002)
    _, terms = ties.made()
    return terms[0]


@pytest.mark.parametrize("masses", [(1.0, 3.0), (3.0, 1.0)])
def test_a_constraint_weighs_as_the_harmonic_mean_of_its_nodes(masses: tuple[float, float]) -> None:
    assert spring(masses) == pytest.approx(spring((1.5, 1.5)), rel=1e-12)


def test_a_constraint_weighs_as_its_node_that_is_not_pinned() -> None:
    assert spring((1.0, 3.0), (True, False)) == pytest.approx(spring((3.0, 3.0)), rel=1e-12)
    assert spring((1.0, 3.0))[0] == 0.5
