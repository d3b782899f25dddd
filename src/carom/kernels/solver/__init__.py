"""Islands, sleep, constraint rows and their relaxation."""
