"""Camera images without a GPU or a display: a software rasteriser in kernels."""
