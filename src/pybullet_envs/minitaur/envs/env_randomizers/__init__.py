"""Randomizers of Minitaurs: different parameters, pushes, uneven ground."""
