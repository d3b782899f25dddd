"""Islands, sleeping, constraint rows and the solver."""
