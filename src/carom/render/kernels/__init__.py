"""What runs on every triangle and every pixel, as Warp kernels."""
