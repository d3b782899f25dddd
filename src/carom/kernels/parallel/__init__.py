"""The same step in more and finer launches, for devices with thousands of threads.

The kernels of `dynamics.step`, `contact.stages` and `solver.stages` do all of a stage of a world, which is
what suits a core of a CPU. Here each is over what it can be parallel in: trees and islands, besides worlds.
Neighbouring threads have the same tree in neighbouring worlds, so that they do the same.
"""
