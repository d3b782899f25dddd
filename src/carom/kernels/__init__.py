"""Device code: the compiled functions, written in Python for the compiler of NVIDIA Warp."""
