"""Descriptions become bodies, and bodies the flat arrays that kernels work on."""
