// Free motion of several worlds at once.
#pragma once

#include "layouts.h"

// Computes the free motion of the worlds from `first` on for a step of one substep. It returns false if that is
// impossible, because they differ in more than numbers.
bool prepare_motion(const LaneMotion& lanes, int first);

// Puts the results of each lane where the steps of single worlds expect them, in its workspace.
void hand_over_motion(const LaneMotion& lanes);
