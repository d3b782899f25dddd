// Threads that perform shares of a launch of a lone world.
#pragma once

#include "layouts.h"

// Performs a launch with all threads of its team; returns when all its shares are done. False if there is too little to
// do, or no thread to be had; then nothing has been done.
bool perform_shares(const Shares& shares, int world);
