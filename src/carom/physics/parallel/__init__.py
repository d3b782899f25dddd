"""The same step in more and finer launches, for devices with thousands of threads.

A kernel of `carom.physics.step` and `carom.physics.coupled_step` does all of a step of a world, which is
what a core of a CPU wants. Here each stage is a kernel, over what it can be parallel in: trees and islands,
besides worlds. Neighbouring threads have the same tree in neighbouring worlds, so that they do the same.
"""

# Threads of a block. The solver's kernels take 255 registers a thread, of which a multiprocessor has enough
# for 256 threads: in smaller blocks they are shared out more evenly.
BLOCK_SIZE = 64
