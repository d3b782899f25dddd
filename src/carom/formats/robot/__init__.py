"""Shared code of the readers of robot files.

The formats say the same things in different places: URDF and MJCF in the attributes of elements, SDF in the
text of their children. `FileContext.states`, `value` and `pose` hide it from everything else here.
"""
