"""Conversion of descriptions to bodies, and of bodies to the flat arrays that kernels work on."""
