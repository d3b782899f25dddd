"""Eigenvalues and eigenvectors of small symmetric matrices, by Jacobi rotations."""

import warp as wp

from carom.kernels.types import Int32, Reals, func, real

_MAX_SWEEPS = wp.constant(30)
_NEGLIGIBLE = real(1e-20)


@func
def diagonalise(matrix: Reals, vectors: Reals, rows: Int32):
    """Diagonalise a symmetric matrix in place by Jacobi rotations, both row-major.

    `vectors` is turned along: if it was the identity, its columns become the eigenvectors.
    """
    a = matrix
    sweep = Int32(0)
    while sweep < _MAX_SWEEPS:
        off, trace = real(0.0), real(0.0)
        for i in range(rows):
            trace += a[i * rows + i]
            for k in range(i):
                off += a[i * rows + k] * a[i * rows + k]
        if off <= _NEGLIGIBLE * trace * trace:
            sweep = _MAX_SWEEPS
        else:
            rotate_all(matrix, vectors, rows)
            sweep += 1


@func
def rotate_all(matrix: Reals, vectors: Reals, rows: Int32):
    """One sweep of Jacobi rotations, each of which makes a pair of entries beside the diagonal zero."""
    for p in range(rows):
        for q in range(p + 1, rows):
            rotate(matrix, vectors, rows, p, q)


@func
def rotate(matrix: Reals, vectors: Reals, rows: Int32, p: Int32, q: Int32):
    """Apply the Jacobi rotation that makes the entries (p, q) and (q, p) zero."""
    a = matrix
    v = vectors
    entry = a[p * rows + q]
    if entry == 0.0:
        return
    theta = (a[q * rows + q] - a[p * rows + p]) / (2.0 * entry)
    tangent = 1.0 / (wp.abs(theta) + wp.sqrt(theta * theta + 1.0))
    if theta < 0.0:
        tangent = -tangent
    cosine = 1.0 / wp.sqrt(tangent * tangent + 1.0)
    sine = tangent * cosine
    for k in range(rows):
        kp = a[k * rows + p]
        kq = a[k * rows + q]
        a[k * rows + p] = cosine * kp - sine * kq
        a[k * rows + q] = sine * kp + cosine * kq
    for k in range(rows):
        pk = a[p * rows + k]
        qk = a[q * rows + k]
        a[p * rows + k] = cosine * pk - sine * qk
        a[q * rows + k] = sine * pk + cosine * qk
        kp = v[k * rows + p]
        kq = v[k * rows + q]
        v[k * rows + p] = cosine * kp - sine * kq
        v[k * rows + q] = sine * kp + cosine * kq
