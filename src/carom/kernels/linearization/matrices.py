"""Dense matrices of a linearised step, in C++ for the reason given in `maths.blocks`."""

import warp as wp

from carom.kernels.types import Int32, Reals, real

__all__ = ["add_products", "clear", "inverse_of_mass", "inverse_of_rows", "scaled_row", "transposed"]


@wp.func_native("""
    auto* x = &wp::index(a, start);
    for (int i = 0; i < count; ++i)
        x[i] = 0.0;
""")
def clear(a: Reals, start: Int32, count: Int32):
    """Set `count` numbers to zero."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, start_a);
    const auto* y = &wp::index(b, start_b);
    auto* z = &wp::index(c, start_c);
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < inner; ++k) {
            const auto factor = scale * x[i * step_a + k];
            if (factor != 0.0)
                for (int j = 0; j < columns; ++j)
                    z[i * step_c + j] += factor * y[k * step_b + j];
        }
""")
def add_products(
    c: Reals,
    start_c: Int32,
    step_c: Int32,
    scale: real,
    a: Reals,
    start_a: Int32,
    step_a: Int32,
    b: Reals,
    start_b: Int32,
    step_b: Int32,
    rows: Int32,
    inner: Int32,
    columns: Int32,
):
    """Add `scale` times the product of a (rows, inner) and b (inner, columns) to c.

    Each matrix is given by its array, its first entry, and the distance of its rows.
    """
    ...


@wp.func_native("""
    const auto* m = &wp::index(a, start);
    auto* inverse = &wp::index(b, start_inverse);
    auto* lower = &wp::index(work, start_work);
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j)
            inverse[i * step + j] = 0.0;
    // The Cholesky factor, with zeros in the rows of dofs that cannot move.
    for (int i = 0; i < size; ++i) {
        const bool moves = m[i * step + i] > 0.0;
        for (int j = 0; j <= i; ++j) {
            auto sum = m[i * step + j];
            for (int k = 0; k < j; ++k)
                sum -= lower[i * size + k] * lower[j * size + k];
            if (i == j)
                lower[i * size + i] = moves ? sqrt(sum) : 0.0;
            else
                lower[i * size + j] = moves && lower[j * size + j] > 0.0 ? sum / lower[j * size + j] : 0.0;
        }
    }
    for (int column = 0; column < size; ++column) {
        if (!(lower[column * size + column] > 0.0))
            continue;
        for (int i = column; i < size; ++i) {
            if (!(lower[i * size + i] > 0.0))
                continue;
            auto sum = i == column ? 1.0 : 0.0;
            for (int k = column; k < i; ++k)
                sum -= lower[i * size + k] * inverse[k * step + column];
            inverse[i * step + column] = sum / lower[i * size + i];
        }
        for (int i = size - 1; i >= column; --i) {
            if (!(lower[i * size + i] > 0.0))
                continue;
            auto sum = inverse[i * step + column];
            for (int k = i + 1; k < size; ++k)
                sum -= lower[k * size + i] * inverse[k * step + column];
            inverse[i * step + column] = sum / lower[i * size + i];
        }
        for (int i = column + 1; i < size; ++i)
            inverse[column * step + i] = inverse[i * step + column];
    }
""")
def inverse_of_mass(
    b: Reals,
    start_inverse: Int32,
    a: Reals,
    start: Int32,
    step: Int32,
    size: Int32,
    work: Reals,
    start_work: Int32,
):
    """Write the inverse of a mass matrix (size, size), with zeros where nothing can move.

    Rows of both are `step` apart; `work` has room for the factor.
    """
    ...


@wp.func_native("""
    const auto* m = &wp::index(a, start);
    auto* inverse = &wp::index(b, start_inverse);
    auto* left = &wp::index(work, start_work);
    double size_of_it = 0.0, size_of_inverse = 0.0;
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) {
            left[i * size + j] = m[i * size + j];
            size_of_it += fabs(m[i * size + j]);
            inverse[i * size + j] = i == j ? 1.0 : 0.0;
        }
    for (int column = 0; column < size; ++column) {
        int pivot = column;
        for (int i = column + 1; i < size; ++i)
            if (fabs(left[i * size + column]) > fabs(left[pivot * size + column]))
                pivot = i;
        const auto greatest = left[pivot * size + column];
        if (!(fabs(greatest) > 0.0))
            return 0;
        const auto share = 1.0 / greatest;
        for (int j = 0; j < size; ++j) {
            const auto own = left[pivot * size + j], of_inverse = inverse[pivot * size + j];
            left[pivot * size + j] = left[column * size + j];
            inverse[pivot * size + j] = inverse[column * size + j];
            left[column * size + j] = own * share;
            inverse[column * size + j] = of_inverse * share;
        }
        for (int i = 0; i < size; ++i) {
            const auto factor = left[i * size + column];
            if (i == column || factor == 0.0)
                continue;
            for (int j = column; j < size; ++j)
                left[i * size + j] -= factor * left[column * size + j];
            for (int j = 0; j < size; ++j)
                inverse[i * size + j] -= factor * inverse[column * size + j];
        }
    }
    for (int i = 0; i < size * size; ++i)
        size_of_inverse += fabs(inverse[i]);
    return size_of_it * size_of_inverse < most ? 1 : 0;
""")
def inverse_of_rows(
    b: Reals,
    start_inverse: Int32,
    a: Reals,
    start: Int32,
    size: Int32,
    work: Reals,
    start_work: Int32,
    most: real,
) -> Int32:
    """Write the inverse of a matrix (size, size); returns 0 if it may be singular.

    It is not if the sums of all entries of both, without their signs, have a product below `most`. `work` has
    room for another matrix.
    """
    ...


@wp.func_native("""
    auto* own = &wp::index(a, start_a);
    auto* side = &wp::index(b, start_b);
    double greatest = 1e-300;
    for (int i = 0; i < count_a; ++i)
        greatest = fabs(own[i]) > greatest ? fabs(own[i]) : greatest;
    for (int i = 0; i < count_a; ++i)
        own[i] /= greatest;
    for (int i = 0; i < count_b; ++i)
        side[i] /= greatest;
""")
def scaled_row(a: Reals, start_a: Int32, count_a: Int32, b: Reals, start_b: Int32, count_b: Int32):
    """Divide a row of equations and its right sides by the greatest entry of the row."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, start_a);
    auto* y = &wp::index(b, start_b);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            y[j * step_b + i] = x[i * step_a + j];
""")
def transposed(
    b: Reals,
    start_b: Int32,
    step_b: Int32,
    a: Reals,
    start_a: Int32,
    step_a: Int32,
    rows: Int32,
    columns: Int32,
):
    """Write the transpose of a (rows, columns) into b."""
    ...
