"""Robots at work: classes that load an arm with things to grasp and move it, and scripts that show them."""
