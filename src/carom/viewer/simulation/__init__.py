"""The part of a viewer for simulations without a script: what their pages show besides, and are asked."""
