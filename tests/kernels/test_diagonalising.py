"""Jacobi rotations by themselves, against NumPy's eigenvalues."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.maths.jacobi import diagonalise
from carom.kernels.types import Int32, Reals, kernel, real


@kernel
def diagonalise_kernel(matrix: Reals, vectors: Reals, rows: Int32):
    """Diagonalise a matrix."""
    diagonalise(matrix, vectors, rows)


def diagonalised(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The matrix after the rotations, and the rotations, both (n, n)."""
    given = matrix.ravel(), np.eye(len(matrix)).ravel()
    arrays = [wp.array(numbers, dtype=real, device="cpu", copy=True) for numbers in given]
    wp.launch(diagonalise_kernel, dim=1, inputs=[*arrays, len(matrix)], device="cpu")
    left, vectors = (array.numpy().reshape(matrix.shape) for array in arrays)
    return left, vectors


@pytest.mark.parametrize("rows", [3, 6, 12])
@pytest.mark.parametrize("seed", range(4))
def test_eigenvalues_and_eigenvectors(seed: int, rows: int) -> None:
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(rows, rows + 1)) * np.geomspace(1.0, 1e-2, rows)[:, None]
    matrix = jacobian @ jacobian.T
    left, vectors = diagonalised(matrix)
    size = np.trace(matrix)
    np.testing.assert_allclose(left, np.diag(np.diag(left)), atol=1e-9 * size)
    np.testing.assert_allclose(np.sort(np.diag(left)), np.linalg.eigvalsh(matrix), atol=1e-12 * size)
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(rows), atol=1e-12)
    np.testing.assert_allclose(vectors * np.diag(left) @ vectors.T, matrix, atol=1e-9 * size)


def test_a_diagonal_matrix_stays_as_it_is() -> None:
    matrix = np.diag([3.0, 0.0, 2.0])
    left, vectors = diagonalised(matrix)
    np.testing.assert_array_equal(left, matrix)
    np.testing.assert_array_equal(vectors, np.eye(3))
