"""Steps of many worlds in fine launches, for CUDA devices. Needs Warp, from the extra `gpu`."""
