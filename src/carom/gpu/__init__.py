"""Steps of many worlds in fine launches, for CUDA devices. Needs Warp, which the extra `gpu` brings."""
