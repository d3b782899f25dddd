"""Short scripts that show the modules of `pybullet_utils`: `python -m pybullet_utils.examples.testlog`."""
