"""Declarations shared by kernels and Python: structs, field types, and integer codes of kinds and columns."""
