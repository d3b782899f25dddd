// Loops of kernels over ranges of numbers, in place of Warp's type and functions of the same names.
//
// Warp's ranges have a step, whose sign is looked at in each iteration; compilers do not see that it is always 1. A loop
// in a kernel that has another step does not compile. Many loops of kernels do little in an iteration, so that counting
// matters: with Warp's ranges a step of a pile of 1,000 balls takes 31.1 million instructions, with these 26.1 million.
#pragma once

namespace carom {

struct range_t {
    int i;
    int end;
};

inline range_t range(int end) { return {0, end}; }

inline range_t range(int start, int end) { return {start, end}; }

inline bool iter_cmp(const range_t& range) { return range.i < range.end; }

inline int iter_next(range_t& range) { return range.i++; }

}  // namespace carom
