"""The same step in more and finer launches, for devices with thousands of threads.

Each kernel of `dynamics.step`, `contact.stages` and `solver.stages` performs a whole stage for one world,
which suits a core of a CPU. Here each kernel is parallel over trees or islands as well, where possible.
Neighbouring threads have the same tree in neighbouring worlds, so that they execute the same instructions.
"""
