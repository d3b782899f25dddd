"""Steps of many worlds in fine launches, for CUDA devices. Needs Warp, from the extra `gpu`.

A fine launch runs one stage of a step with one thread for each world, tree, shape or island of all worlds.
"""
