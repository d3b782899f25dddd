"""The window: sliders, keys, drawings, its camera, videos of what it shows."""
