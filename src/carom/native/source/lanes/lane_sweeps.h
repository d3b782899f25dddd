// Sweeps over the rows of several worlds at once.
#pragma once

#include "layouts.h"

// Relaxes the rows that all lanes have written. It returns false, and leaves them as they are, if some has none, or if
// they differ in more than numbers.
bool relax_together(const LaneMotion& lanes);
