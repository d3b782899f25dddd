"""What M and H are sums of: inertia of trees, and Jᵀ S J of rows; `envelope` tells of their layout."""

import warp as wp

from carom.kernels.structs import DofRows, NewtonRows
from carom.kernels.types import Int32, IntRows, Matrix3, RealRows, Vector4Rows, real

__all__ = ["add_row_squares", "mass_of_single", "mass_of_tree"]


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const int blocks = (count + 3) / 4;
    four* entries = (four*)&wp::index(matrix, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const four* rows = (const four*)&wp::index(mass, world, block);
    const auto* dof = &wp::index(dofs, world, first_dof);
    for (int k = 0; k < count; ++k) {
        const four* row = rows + k * blocks;
        const int end = k / 4, q = k % 4;
        four* column = entries + 4 * (place + end) + q;
        for (int i = 0; i < end; ++i) {
            four& to = column[4 * starts[place + i]];
            to = wp::add(to, row[i]);
        }
        four* own = entries + 4 * (starts[place + end] + place + end);
        for (int i = 0; i < q; ++i)
            own[q][i] = own[i][q] = row[end][i];
        own[q][q] = row[end][q] + (dof[k].inverse_pivot > 0.0 ? 0.0 : immovable);
    }
    for (int i = count; i < 4 * blocks; ++i)
        entries[4 * (starts[place + i / 4] + place + i / 4) + i % 4][i % 4] = 1.0;
""")
def mass_of_tree(
    matrix: RealRows,
    start: IntRows,
    mass: Vector4Rows,
    block: Int32,
    dofs: DofRows,
    first_dof: Int32,
    world: Int32,
    place: Int32,
    count: Int32,
    immovable: real,
):
    """Write M of a tree, whose rows `mass` has, at `place`; dofs without inertia get an `immovable` one."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    four* entries = (four*)&wp::index(matrix, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    four* first = entries + 4 * (starts[place] + place);
    four* second = entries + 4 * (starts[place + 1] + place + 1);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            first[j][i] = i <= j ? inertia.data[j][i] : inertia.data[i][j];
    first[3][3] = second[0][0] = second[1][1] = mass;
    second[2][2] = second[3][3] = 1.0;
""")
def mass_of_single(
    matrix: RealRows, start: IntRows, world: Int32, place: Int32, inertia: Matrix3, mass: real
):
    """Write M of a body of one link at `place`: angular dofs come first, then linear ones."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    constexpr int most = 24;
    four* entries = (four*)&wp::index(matrix, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const auto* all = &wp::index(row, world, 0);
    const four* blocks = jacobian.shape[1] > 0 ? (const four*)&wp::index(jacobian, world, 0) : nullptr;
    int begin = 0;
    while (begin < count) {
        const auto& first = all[begin];
        if (first.kind == 0 || first.kind == 3) {
            ++begin;
            continue;
        }
        if (first.start < 0) {
            const int at = first.place_a / 4, q = first.place_a % 4;
            entries[4 * (starts[at] + at) + q][q] += first.slope;
            ++begin;
            continue;
        }
        // Rows between the same trees are added together; of trees with branches those of a contact, which
        // act on the same dofs.
        const bool is_large = first.blocks_a > 2 || first.blocks_b > 2;
        int chosen[most], used = 0, r = begin;
        for (; r < count && used <= most - 6; ++r) {
            const auto& own = all[r];
            if (own.kind == 0 || own.kind == 3)
                continue;
            if (own.start < 0 || own.place_a != first.place_a || own.blocks_a != first.blocks_a ||
                own.place_b != first.place_b || own.blocks_b != first.blocks_b ||
                (is_large && own.source != first.source))
                break;
            const int size = own.kind >= 4 ? own.size : own.kind == 2 ? 2 : 1;
            bool acts = false;
            for (int i = 0; i < size; ++i)
                acts = acts || all[r + i].slope != 0.0;
            if (acts)
                for (int i = 0; i < size; ++i)
                    chosen[used++] = r + i;
        }
        begin = r;
        if (used == 0)
            continue;
        const four* rows[most];
        for (int k = 0; k < used; ++k)
            rows[k] = blocks + all[chosen[k]].start;
        // Blocks of dofs that the rows act on, a bit each; beyond so many all are taken to be.
        constexpr int words = 16;
        const int places[2] = {first.place_a, first.place_b}, sizes[2] = {first.blocks_a, first.blocks_b};
        const int total = sizes[0] + sizes[1];
        unsigned long long acting[words];
        const bool is_listed = is_large && total <= 64 * words;
        if (is_listed)
            for (int i = 0; i < total; ++i) {
                // Bits of numbers, without their signs: 0 of both signs is none.
                unsigned long long bits[4] = {}, part[4];
                for (int k = 0; k < used; ++k) {
                    __builtin_memcpy(part, &rows[k][i], sizeof(part));
                    for (int q = 0; q < 4; ++q)
                        bits[q] |= part[q];
                }
                const bool acts = (bits[0] | bits[1] | bits[2] | bits[3]) << 1 != 0;
                if (i % 64 == 0)
                    acting[i / 64] = 0;
                acting[i / 64] |= (unsigned long long)acts << i % 64;
            }
        const auto has_part = [&](int i) { return !is_listed || (acting[i / 64] >> i % 64 & 1); };
        four weighted[most];
        for (int side = 0; side < 2; ++side)
            for (int b = 0; b < sizes[side]; ++b) {
                const int offset = (side == 0 ? 0 : sizes[0]) + b, column = places[side] + b;
                if (!has_part(offset))
                    continue;
                // S J of this block of dofs. A disc that slides acts across its direction only.
                for (int k = 0; k < used; ++k) {
                    const auto& own = all[chosen[k]];
                    const four& j = rows[k][offset];
                    if (own.kind >= 4) {
                        for (int i = 0; i < own.size; ++i)
                            weighted[k + i] = four{};
                        for (int i = 0; i < own.size; ++i) {
                            const auto& term = (&own)[i];
                            if (term.slope == 0.0)
                                continue;
                            four sum = rows[k + i][offset];
                            for (int l = i + 1; l < own.size; ++l)
                                sum = wp::add(sum, wp::mul(rows[k + l][offset], term.couplings[l - i - 1]));
                            sum = wp::mul(sum, term.slope);
                            weighted[k + i] = wp::add(weighted[k + i], sum);
                            for (int l = i + 1; l < own.size; ++l)
                                weighted[k + l] =
                                    wp::add(weighted[k + l], wp::mul(sum, term.couplings[l - i - 1]));
                        }
                        k += own.size - 1;
                    } else if (own.kind == 2 && own.state == 1) {
                        const auto& second = (&own)[1];
                        const four& j2 = rows[k + 1][offset];
                        const four across = wp::mul(
                            wp::sub(wp::mul(j2, own.direction), wp::mul(j, second.direction)), own.slope);
                        weighted[k] = wp::mul(across, -second.direction);
                        weighted[k + 1] = wp::mul(across, own.direction);
                        ++k;
                    } else
                        weighted[k] = wp::mul(j, own.slope);
                }
                for (int other = 0; other < 2; ++other)
                    for (int i = 0; i < sizes[other]; ++i) {
                        const int line = places[other] + i;
                        if (line > column)
                            break;
                        const int with = (other == 0 ? 0 : sizes[0]) + i;
                        if (!has_part(with))
                            continue;
                        four* target = entries + 4 * (starts[line] + column);
                        four c0 = target[0], c1 = target[1], c2 = target[2], c3 = target[3];
                        #pragma clang loop vectorize(disable)
                        for (int k = 0; k < used; ++k) {
                            const four j = rows[k][with];
                            const four& w = weighted[k];
                            c0 = wp::add(c0, wp::mul(j, w[0]));
                            c1 = wp::add(c1, wp::mul(j, w[1]));
                            c2 = wp::add(c2, wp::mul(j, w[2]));
                            c3 = wp::add(c3, wp::mul(j, w[3]));
                        }
                        target[0] = c0;
                        target[1] = c1;
                        target[2] = c2;
                        target[3] = c3;
                    }
            }
    }
""")
def add_row_squares(
    matrix: RealRows,
    start: IntRows,
    row: NewtonRows,
    jacobian: Vector4Rows,
    world: Int32,
    count: Int32,
):
    """Add Jᵀ S J, where S has the slopes of all rows."""
    ...
