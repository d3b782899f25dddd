"""Residuals from which the search for the impulses of contacts that yield begins: those of the last impulses.

A resting contact pushes as in the substep before, so the equations are set up where they will hold, and the
first solution is the last one as a rule. Impulses are functions of residuals (`law`); this is their inverse.
Where a contact slides, the residual along which it slides is free, and stays that of the free motion.
"""

import warp as wp

from carom.kernels.structs import NewtonRows
from carom.kernels.types import Int32, real

__all__ = ["begin_at_last_impulse"]


@wp.func_native("""
    auto* rows = &wp::index(row, world, number);
    const int size = rows->size;
    if (!(normal > 0.0) || rows->kind == 0)
        return;
    if (rows->kind == 1) {
        rows->rate = -rows->regular * normal;
        return;
    }
    const double f[3] = {normal, first, second};
    if (rows->kind == 5) {
        // Forces of edges: in pairs, along each direction; one edge of a direction that slides pushes alone.
        const double regular = rows->regular;
        const double free = rows->rate;
        bool slides[6] = {};
        double above = 0.0;
        for (int turn = 0; turn < size; ++turn) {
            double left = normal, least = 1e300;
            int pairs = 0;
            for (int i = 1; i < size; ++i)
                if (slides[i]) {
                    const double edge = wp::abs(f[i]) / rows[i].friction;
                    left -= edge;
                    least = edge < least ? edge : least;
                } else
                    ++pairs;
            // All directions slide: as deep as the free motion has it.
            const double deepest = -0.499 * least * regular;
            above = pairs > 0 ? -left * regular / (2 * pairs) : free > deepest ? free : deepest;
            bool is_settled = true;
            for (int i = 1; i < size && i < 3; ++i)
                if (!slides[i] && wp::abs(f[i]) * regular > -2.0 * above * rows[i].friction) {
                    slides[i] = true;
                    is_settled = false;
                }
            if (is_settled)
                break;
        }
        for (int i = 1; i < size; ++i) {
            if (i > 2) {
                rows[i].rate = 0.0;
                continue;
            }
            const double push = f[i], friction = rows[i].friction;
            double away = -0.5 * push * regular / friction;
            if (slides[i])
                away = (above + wp::abs(push) / friction * regular) * (push > 0.0 ? -1.0 : 1.0);
            rows[i].rate = away / friction;
        }
        rows->rate = above;
        return;
    }
    // The cone: as it sticks, or at its edge.
    double square = 0.0, free = 0.0, pull = 0.0;
    for (int i = 1; i < 3; ++i) {
        const double scaled = rows[i].friction * rows[i].regular * f[i];
        square += scaled * scaled;
        free += rows[i].friction * rows[i].friction * rows[i].rate * rows[i].rate;
        pull += f[i] * f[i] / (rows[i].friction * rows[i].friction);
    }
    const double slope = rows->friction * wp::sqrt(rows[1].regular / rows->regular);
    double depth = -rows->regular * normal;
    if (slope * slope * depth + wp::sqrt(square) <= 0.0) {
        for (int i = 1; i < 3; ++i)
            rows[i].rate = -rows[i].regular * f[i];
    } else {
        const double ratio = 1.0 + slope * slope;
        const double beyond = -normal * rows->regular * slope * ratio;
        const double least = -1.01 * slope * beyond / ratio;
        double sliding = wp::sqrt(free);
        sliding = sliding > least ? sliding : least;
        for (int i = 1; i < 3; ++i)
            rows[i].rate = -sliding * f[i] / (wp::sqrt(pull) * rows[i].friction * rows[i].friction);
        depth = beyond / slope + sliding;
    }
    rows->rate = depth;
    for (int i = 3; i < size; ++i)
        rows[i].rate = 0.0;
""")
def begin_at_last_impulse(
    row: NewtonRows, world: Int32, number: Int32, normal: real, first: real, second: real
):
    """Write residuals of a contact that yields which cause its last impulses, if its normal had one.

    `number` is the row of its normal, `first` and `second` are the impulses of lateral friction.
    """
    ...
