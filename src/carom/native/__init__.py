"""The kernels as one compiled library: choosing and loading it, tables of arrays, launches."""
