"""What users do on pages: keys, the mouse, sliders, pulling and driving, and leaving."""
