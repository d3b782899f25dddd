// Free motion of several worlds at once: their numbers are put side by side, a kernel computes with all of them, and each
// world takes its results.

#include "lane_motion.h"

#include "lane_rows.h"
#include "perform.h"

namespace {

// Where some world has joint terms and another has none, adding 0 would change the sign of a zero.
bool are_alike(const LaneMotion& lanes) {
    for (int tree = 0; tree < lanes.tree_count; ++tree)
        for (int lane = 1; lane < LANES; ++lane) {
            const double* terms = lanes.joint_terms + tree * LANES;
            if ((terms[lane] != 0.0) != (terms[0] != 0.0))
                return false;
        }
    return true;
}

}  // namespace

bool prepare_motion(const LaneMotion& lanes, int first) {
    for (int i = 0; i < lanes.gathered_count; ++i)
        gather(lanes.gathered[i], 0, lanes.gathered[i].rows, first);
    if (!are_alike(lanes))
        return false;
    run(lanes.motion);
    ++*lanes.steps_begun;
    return true;
}

void hand_over_motion(const LaneMotion& lanes) {
    for (int i = 0; i < lanes.scattered_count; ++i)
        scatter_to_all(lanes.scattered[i]);
}
