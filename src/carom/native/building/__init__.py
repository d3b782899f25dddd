"""Building the native library: Warp makes C++ of the kernels, and Zig a shared library of that."""
