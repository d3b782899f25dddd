"""Xacro, the macro language for robot files, without ROS."""

from carom.formats.xacro.document import Expanded, expand, expanded_if_xacro, is_xacro

__all__ = ["Expanded", "expand", "expanded_if_xacro", "is_xacro"]
