// Steps of worlds, as programs of kernel launches.
#pragma once

#include "export.h"
#include "layouts.h"
#include "watch.h"

inline void run(const KernelCall& call) { call.function(call.bounds, call.arguments); }

extern "C" CAROM_EXPORT void carom_perform(const Run* run);
