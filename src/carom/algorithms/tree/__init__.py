"""Equations of motion of one body at any coordinates: kernels that work in the frames of its joints."""
