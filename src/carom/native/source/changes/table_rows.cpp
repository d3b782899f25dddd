// Bodies in the arrays of a world: their rows are put in or taken out in all arrays of a table by one call, which no
// signal can interrupt.
#include "table_rows.h"

#include "export.h"

// Put rows into unused places. `data` has the rows of each field in turn, as in a table without other rows; `first` and
// `count` say for each axis where they go and how many there are. Each world gets the same.
extern "C" CAROM_EXPORT void carom_put_rows(
    const RowTable* table, const char* data, const int64_t* first, const int64_t* count
) {
    for (int64_t i = 0; i < table->column_count; ++i) {
        const RowField& field = table->columns[i];
        const int64_t bytes = count[field.axis] * field.row_bytes;
        char* memory = field.memory + first[field.axis] * field.row_bytes;
        for (int64_t world = 0; world < field.worlds; ++world)
            __builtin_memcpy(memory + world * field.world_bytes, data, bytes);
        data += bytes;
    }
    for (int64_t i = 0; i < table->reference_count; ++i) {
        const RowReference& reference = table->references[i];
        const int64_t moved = first[reference.target];
        char* row = reference.memory + first[reference.axis] * reference.row_bytes;
        for (int64_t k = 0; moved && k < count[reference.axis]; ++k, row += reference.row_bytes) {
            int32_t* numbers = reinterpret_cast<int32_t*>(row);
            for (int64_t n = 0; n < reference.numbers; ++n)
                if (numbers[n] >= 0)
                    numbers[n] += moved;
        }
    }
}

// Take consecutive rows out of each axis, of the rows in use on it; later rows move up, and the rows that become free
// are zero.
void carom_take_rows(const RowTable* table, const int64_t* first, const int64_t* count, const int64_t* used) {
    for (int64_t i = 0; i < table->column_count; ++i) {
        const RowField& field = table->columns[i];
        const int64_t size = field.row_bytes, from = first[field.axis], gone = count[field.axis];
        const int64_t kept = used[field.axis] - gone;
        for (int64_t world = 0; gone && world < field.worlds; ++world) {
            char* rows = field.memory + world * field.world_bytes;
            __builtin_memmove(rows + from * size, rows + (from + gone) * size, (kept - from) * size);
            __builtin_memset(rows + kept * size, 0, gone * size);
        }
    }
    for (int64_t i = 0; i < table->reference_count; ++i) {
        const RowReference& reference = table->references[i];
        const int64_t gone = count[reference.target], after = first[reference.target] + gone;
        const int64_t kept = used[reference.axis] - count[reference.axis];
        char* row = reference.memory;
        for (int64_t k = 0; gone && k < kept; ++k, row += reference.row_bytes) {
            int32_t* numbers = reinterpret_cast<int32_t*>(row);
            for (int64_t n = 0; n < reference.numbers; ++n)
                if (numbers[n] >= after)
                    numbers[n] -= gone;
        }
    }
}

// Copy blocks of some worlds to those of others, none of which overlaps its target.
extern "C" CAROM_EXPORT void carom_copy_worlds(
    const WorldBlock* blocks, int64_t count, const int64_t* from, const int64_t* to, int64_t worlds
) {
    for (int64_t i = 0; i < count; ++i) {
        const WorldBlock& block = blocks[i];
        for (int64_t world = 0; world < worlds; ++world)
            __builtin_memcpy(
                block.target + to[world] * block.target_bytes, block.source + from[world] * block.source_bytes,
                block.size
            );
    }
}

// Copy blocks of memory, none of which overlaps its target.
extern "C" CAROM_EXPORT void carom_copy_blocks(const Block* blocks, int64_t count) {
    for (int64_t i = 0; i < count; ++i)
        __builtin_memcpy(blocks[i].target, blocks[i].source, blocks[i].size);
}
