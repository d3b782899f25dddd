// Taking rows out of the arrays of a world, and copying memory.
#pragma once

#include "export.h"
#include "layouts.h"

void carom_take_rows(const RowTable* table, const int64_t* first, const int64_t* count, const int64_t* used);
extern "C" CAROM_EXPORT void carom_copy_blocks(const Block* blocks, int64_t count);
