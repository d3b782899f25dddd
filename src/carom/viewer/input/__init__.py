"""User input on pages: keys, mouse, sliders, pulling bodies, driving joints, and closing."""
