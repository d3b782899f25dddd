"""Jacobi rotations of symmetric matrices."""

from __future__ import annotations

import numpy as np
import pytest

from carom.description.eigen import diagonalize

TENSOR = ((2.0, 0.3, -0.2), (0.3, 1.5, 0.4), (-0.2, 0.4, 3.0))


def test_eigenvectors_make_it_diagonal():
    values, vectors = diagonalize(TENSOR, 1e-16, 60)
    turn = np.array(vectors)
    assert turn @ np.diag(values) @ turn.T == pytest.approx(np.array(TENSOR), abs=1e-14)
    assert turn.T @ turn == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_no_more_rotations_are_made_than_allowed_and_each_brings_it_nearer():
    beside = []
    for steps in range(5):
        values, vectors = diagonalize(TENSOR, 1e-16, steps)
        turned = np.array(vectors).T @ np.array(TENSOR) @ np.array(vectors)
        assert np.diag(turned) == pytest.approx(values, abs=1e-14)
        beside.append(np.square(turned - np.diag(np.diag(turned))).sum())
    assert beside[0] == pytest.approx(2.0 * (0.09 + 0.04 + 0.16))
    # The largest entry beside the diagonal vanishes, and the others keep their sum of squares.
    assert beside[1] == pytest.approx(2.0 * (0.09 + 0.04))
    assert (np.diff(beside) < 0.0).all()
