"""Shared code of the readers of robot files.

The formats keep the same values in different places: URDF and MJCF in the attributes of elements, SDF in the
text of child elements. `FileContext.states`, `value` and `pose` hide this difference from the other modules.
"""
