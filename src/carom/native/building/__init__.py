"""Building the native library: Warp translates kernels to C++, and Zig compiles that to a shared library."""
