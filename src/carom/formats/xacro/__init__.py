"""Xacro, the macro language for robot files, without ROS."""

from carom.formats.xacro.document import Expanded, expand, is_xacro

__all__ = ["Expanded", "expand", "is_xacro"]
