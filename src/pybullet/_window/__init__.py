"""The window: sliders, keys, drawings, its camera."""
