"""What other programs add to URDF files, where its meaning is plain; and xacro, which is no URDF yet."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.robot.context import FileContext
from carom.formats.xml_element import Element

_XACRO = "xacro:"


def read_extensions(context: FileContext) -> None:
    """Read `<mujoco><compiler meshdir strippath>`: where meshes are that are not found by their names."""
    root = context.root
    root.attributes.get("version")
    extension = root.first("mujoco")
    compiler = None if extension is None else extension.first("compiler")
    if compiler is not None:
        context.mesh_directory = compiler.attributes.get("meshdir", "")
        # Names are tried with and without their folders, whatever it says.
        compiler.attributes.get("strippath")


def refuse_xacro(root: Element, file: Path) -> None:
    """Raise `DescriptionError` if a file has macros of xacro that have not been expanded."""
    pending = [root]
    while pending:
        element = pending.pop()
        if element.tag.startswith(_XACRO):
            raise DescriptionError(
                "it is a xacro file, whose macros Carom does not expand yet; expand it first, "
                "for example with the program xacro",
                file=file,
                line=element.line,
                element=f"<{element.tag}>",
            )
        pending.extend(reversed(element.children))
