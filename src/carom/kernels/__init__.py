"""Device code: everything that is compiled, written in Python for the compiler of NVIDIA Warp."""
