// Sweeps over the rows of several worlds at once: their numbers are put side by side, a kernel relaxes all rows once, and
// each world takes its results after the sweep in which it converges.
//
// Worlds may have different rows over one tree, as joints reach their limits in some of them. They are merged: a *slot* is
// a row of some lanes, all on the same dof, and the rows of each lane are in its order. In a lane without a row in a slot
// all changes are zeros there.

#include "lane_sweeps.h"

#include "lane_rows.h"
#include "perform.h"

namespace {

// Whole numbers at the beginning of a row over one tree; see `RowScratch`.
enum { CONSTRAINT, ENTRY, DELTA, RESPONSE, BLOCKS, SOFT, PLACE_NUMBERS };
// Places among the numbers of rows over one tree, of which the first is the same in rows over two.
enum { EFFECTIVE_MASS = 1, LOWER, UPPER, IMPULSE };

// More rows than this, for each of those of the world with the most, cost more than solving each world for itself.
constexpr int MAX_SLOTS = 2;

// What a lane without a row has in its place: change, effective mass, bounds, impulse; share and softness, which make
// every change 0. A row that is not soft in a slot that is corrects its whole rate.
const double NO_ROW[] = {0.0, 1.0, 0.0, 0.0, 0.0}, NO_SHARE = 0.0, WHOLE_SHARE = 1.0, NO_SOFTNESS = 0.0;
const double NO_RESPONSE[4] = {};

// Blocks of `Scratch.delta_velocity`.
struct Extent {
    int first, end;
};

Extent include(Extent extent, int first, int count) {
    if (count == 0)
        return extent;
    return {first < extent.first ? first : extent.first, first + count > extent.end ? first + count : extent.end};
}

const int32_t* places_at(const LaneSweeps& sweeps, const LaneWorld& world, int row) {
    return reinterpret_cast<const int32_t*>(world.row_numbers + row * sweeps.row_stride);
}

int32_t* slot_places_at(const LaneSweeps& sweeps, int slot) {
    return reinterpret_cast<int32_t*>(sweeps.row_numbers + slot * sweeps.wide_row_stride);
}

bool are_equal(const int32_t* a, const int32_t* b, int count) {
    int32_t differences = 0;
    for (int i = 0; i < count; ++i)
        differences |= a[i] ^ b[i];
    return differences == 0;
}

// Whether the rows over two trees of a world are those of the first, but for their numbers.
bool have_same_pair_rows(const LaneWorld& first, const LaneWorld& other) {
    const int rows = first.waiting[WAITING_PAIR_ROWS];
    return rows == other.waiting[WAITING_PAIR_ROWS] && first.waiting[WAITING_BLOCKS] == other.waiting[WAITING_BLOCKS] &&
           are_equal(first.row_places, other.row_places, 4 * rows) &&
           are_equal(first.row_starts, other.row_starts, rows);
}

// The rows of all lanes in the order of their visits, merged.
class Merging {
public:
    Merging(const LaneMotion& lanes) : lanes(lanes), sweeps(lanes.sweeps) {}

    // Returns whether they could be merged to few enough slots.
    bool merge() {
        int most = 0;
        for (const LaneWorld& world : lanes.worlds)
            most = world.waiting[WAITING_VISITS] > most ? world.waiting[WAITING_VISITS] : most;
        while (left_of(longest()) > 0) {
            const int lane = longest();
            if (visits == MAX_SLOTS * most)
                return false;
            if (!(next(lane) < 0 ? add_common(next(lane)) : add_slot(places(lane)[ENTRY])))
                return false;
        }
        return true;
    }

    int slots = 0, visits = 0;

private:
    const LaneMotion& lanes;
    const LaneSweeps& sweeps;
    int done[LANES] = {};

    int left_of(int lane) const { return lanes.worlds[lane].waiting[WAITING_VISITS] - done[lane]; }
    int next(int lane) const { return lanes.worlds[lane].visits[done[lane]]; }
    const int32_t* places(int lane) const { return places_at(sweeps, lanes.worlds[lane], next(lane)); }

    // The lane with most visits left, first of all of those with a row over one tree next.
    int longest() const {
        int found = 0, found_left = -1;
        for (int lane = 0; lane < LANES; ++lane) {
            const bool is_slot = left_of(lane) > 0 && next(lane) >= 0;
            const int left = left_of(lane) + (is_slot ? INT16_MAX : 0);
            if (left > found_left)
                found = lane, found_left = left;
        }
        return found;
    }

    // A row over two trees is in all lanes.
    bool add_common(int code) {
        for (int lane = 0; lane < LANES; ++lane)
            if (left_of(lane) == 0 || next(lane) != code)
                return false;
        for (int& count : done)
            ++count;
        sweeps.order[visits++] = code;
        return true;
    }

    bool add_slot(int entry) {
        if (slots == sweeps.slot_count)
            return false;
        int32_t* to = slot_places_at(sweeps, slots);
        int soft = 0;
        for (int lane = 0; lane < LANES; ++lane) {
            int32_t& row = sweeps.slots[slots * LANES + lane];
            row = -1;
            if (left_of(lane) == 0 || next(lane) < 0 || places(lane)[ENTRY] != entry)
                continue;
            for (int i = 0; i < PLACE_NUMBERS; ++i)
                to[i] = places(lane)[i];
            soft |= to[SOFT];
            row = next(lane);
            ++done[lane];
        }
        to[SOFT] = soft;
        sweeps.order[visits++] = slots++;
        return true;
    }
};

// The response of a lane to an impulse on the dof of a slot; zeros if it has no row on this dof.
const double* response_of(const LaneSweeps& sweeps, const LaneWorld& world, int lane, const int32_t* slot) {
    for (int row = 0; row < world.waiting[WAITING_ROWS]; ++row)
        if (places_at(sweeps, world, row)[ENTRY] == slot[ENTRY])
            return numbers_at(sweeps.response.lone[lane], slot[RESPONSE] * sweeps.response.row_stride);
    return nullptr;
}

void gather_responses(const LaneMotion& lanes, const int32_t* slot, bool is_whole) {
    const LaneRows& response = lanes.sweeps.response;
    if (is_whole) {
        gather(response, slot[RESPONSE], slot[BLOCKS]);
        return;
    }
    const double* from[LANES];
    for (int lane = 0; lane < LANES; ++lane)
        from[lane] = response_of(lanes.sweeps, lanes.worlds[lane], lane, slot);
    for (int block = 0; block < slot[BLOCKS]; ++block) {
        const double* blocks[LANES];
        for (int lane = 0; lane < LANES; ++lane)
            blocks[lane] = from[lane] ? from[lane] + 4 * block : NO_RESPONSE;
        put_row(blocks, numbers_at(response.wide, (slot[RESPONSE] + block) * response.wide_stride), 4);
    }
}

void gather_slot(const LaneMotion& lanes, int slot) {
    const LaneSweeps& sweeps = lanes.sweeps;
    const int32_t* places = slot_places_at(sweeps, slot);
    const double *numbers[LANES], *shares[LANES], *softness[LANES];
    bool is_whole = true;
    for (int lane = 0; lane < LANES; ++lane) {
        const int row = sweeps.slots[slot * LANES + lane];
        const bool is_there = row >= 0;
        const bool is_soft = is_there && places_at(sweeps, lanes.worlds[lane], row)[SOFT] != 0;
        is_whole &= is_there;
        numbers[lane] = is_there ? numbers_at(sweeps.row.lone[lane], row * sweeps.row.row_stride) : NO_ROW;
        shares[lane] = !is_there ? &NO_SHARE : is_soft ? numbers_at(sweeps.share.lone[lane], 0) + row : &WHOLE_SHARE;
        softness[lane] = is_soft ? numbers_at(sweeps.softness.lone[lane], 0) + row : &NO_SOFTNESS;
    }
    int32_t* to = slot_places_at(sweeps, slot);
    to[SOFT] |= !is_whole;
    put_row(numbers, numbers_at(sweeps.row.wide, slot * sweeps.row.wide_stride), sweeps.row.numbers);
    if (to[SOFT] != 0) {
        put_row(shares, numbers_at(sweeps.share.wide, slot * sweeps.share.wide_stride), 1);
        put_row(softness, numbers_at(sweeps.softness.wide, slot * sweeps.softness.wide_stride), 1);
    }
    gather_responses(lanes, places, is_whole);
}

// Whether nothing can move along some row of a lane's world. Its change, NaN, hides those of the rows before it until the
// next row of that world; in a lane, rows that other worlds have would end that.
bool has_stuck_rows(const LaneMotion& lanes, int lane) {
    const LaneSweeps& sweeps = lanes.sweeps;
    const auto is_stuck = [lane](const LaneRows& rows, int row) {
        return numbers_at(rows.lone[lane], row * rows.row_stride)[EFFECTIVE_MASS] == 0.0;
    };
    bool found = false;
    for (int row = 0; row < lanes.worlds[lane].waiting[WAITING_ROWS]; ++row)
        found |= is_stuck(sweeps.row, row);
    for (int row = 0; row < lanes.worlds[lane].waiting[WAITING_PAIR_ROWS]; ++row)
        found |= is_stuck(sweeps.terms, row);
    return found;
}

// Puts all numbers that sweeps read side by side; returns what they change.
Extent gather_rows(const LaneMotion& lanes, int slots) {
    const LaneSweeps& sweeps = lanes.sweeps;
    const LaneWorld& first = lanes.worlds[0];
    Extent extent = {INT32_MAX, 0};
    for (int slot = 0; slot < slots; ++slot) {
        gather_slot(lanes, slot);
        extent = include(extent, slot_places_at(sweeps, slot)[DELTA], slot_places_at(sweeps, slot)[BLOCKS]);
    }
    for (int row = 0; row < first.waiting[WAITING_PAIR_ROWS]; ++row) {
        const int32_t* place = first.row_places + 4 * row;
        extent = include(include(extent, place[0], place[1]), place[2], place[3]);
    }
    gather(sweeps.terms, 0, first.waiting[WAITING_PAIR_ROWS]);
    gather(sweeps.jacobian, 0, first.waiting[WAITING_BLOCKS]);
    gather(sweeps.jacobian_response, 0, first.waiting[WAITING_BLOCKS]);
    gather(sweeps.delta, extent.first, extent.end - extent.first);
    return extent;
}

// Whether the impulse of a slot has, in all lanes that are searching, the only value that its bounds leave. Lanes without a row
// are settled.
bool has_settled(const LaneSweeps& sweeps, int slot, const bool (&is_searching)[LANES]) {
    const double* numbers = numbers_at(sweeps.row.wide, slot * sweeps.row.wide_stride);
    bool settled = true;
    for (int lane = 0; lane < LANES; ++lane) {
        const double impulse = numbers[IMPULSE * LANES + lane];
        settled &= !is_searching[lane] ||
                   (impulse == numbers[LOWER * LANES + lane] && impulse == numbers[UPPER * LANES + lane]);
    }
    return settled;
}

// Takes slots that no further sweep can change out of the order; see `leave_out_settled` in `kernels.solver.sweeps`.
void leave_out_settled(const LaneSweeps& sweeps, const bool (&is_searching)[LANES]) {
    int left = 0;
    for (int visit = 0; visit < *sweeps.visits; ++visit) {
        const int slot = sweeps.order[visit];
        if (slot < 0 || !has_settled(sweeps, slot, is_searching))
            sweeps.order[left++] = slot;
    }
    *sweeps.visits = left;
}

void hand_over(const LaneSweeps& sweeps, const LaneWorld& world, int lane, int slots, Extent extent) {
    const LaneRows& impulse = sweeps.row_impulse;
    for (int slot = 0; slot < slots; ++slot) {
        const int row = sweeps.slots[slot * LANES + lane];
        if (row >= 0)
            *numbers_at(impulse.lone[lane], row * impulse.row_stride) =
                numbers_at(impulse.wide, slot * impulse.wide_stride)[lane];
    }
    scatter(sweeps.term_impulse, lane, 0, world.waiting[WAITING_PAIR_ROWS]);
    scatter(sweeps.delta, lane, extent.first, extent.end - extent.first);
}

}  // namespace

bool relax_together(const LaneMotion& lanes) {
    const LaneSweeps& sweeps = lanes.sweeps;
    if (*sweeps.iterations <= 0 || *sweeps.inner_iterations != 1)
        return false;
    for (int lane = 1; lane < LANES; ++lane)
        if (!have_same_pair_rows(lanes.worlds[0], lanes.worlds[lane]))
            return false;
    for (int lane = 0; lane < LANES; ++lane)
        if (has_stuck_rows(lanes, lane))
            return false;
    Merging merging(lanes);
    if (!merging.merge())
        return false;
    const Extent extent = gather_rows(lanes, merging.slots);
    *sweeps.visits = merging.visits;
    bool is_searching[LANES];
    for (bool& searching : is_searching)
        searching = true;
    int left = LANES;
    for (int sweep = 0; left > 0; ++sweep) {
        *sweeps.number = sweep;
        run(sweeps.sweep);
        for (int lane = 0; lane < LANES; ++lane) {
            const double residual = sweeps.residuals[lane];
            if (!is_searching[lane] || !(residual <= *sweeps.threshold || sweep + 1 >= *sweeps.iterations))
                continue;
            is_searching[lane] = false;
            --left;
            const LaneWorld& world = lanes.worlds[lane];
            world.waiting[WAITING_SWEEPS] = sweep + 1;
            *world.residual = residual;
            hand_over(sweeps, world, lane, merging.slots, extent);
        }
        if (sweep < SETTLING_SWEEPS)
            leave_out_settled(sweeps, is_searching);
        ++*sweeps.begun;
    }
    return true;
}
