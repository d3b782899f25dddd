"""What other programs add to URDF files, where its meaning is plain."""

from __future__ import annotations

from carom.formats.robot.context import FileContext


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
