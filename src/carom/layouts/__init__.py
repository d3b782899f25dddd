"""What kernels and Python share: structs, their types, and the numbers that stand for kinds and columns."""
