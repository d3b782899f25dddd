"""Random sequences of calls and damaged files. `make fuzz` runs them long, the test suite for a moment.

What has to hold throughout: no crash, no hang, no exception but `pybullet.error` and those of wrong types,
nothing that is not finite, and a refused call or file leaves the world as it was.
"""
