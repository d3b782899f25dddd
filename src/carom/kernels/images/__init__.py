"""The rasteriser."""
