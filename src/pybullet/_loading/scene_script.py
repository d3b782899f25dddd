"""Writing a scene as a script."""

from __future__ import annotations

from pybullet._calls.arguments import text
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of

__all__ = ["saveWorld"]

_FAILED = "saveWorld command execution failed."


@exported
def saveWorld(worldFileName: str, physicsClientId: int = 0) -> None:
    """Writes a script that rebuilds the scene.

    The script connects, loads the files of the bodies, or creates bodies from shapes, and sets poses,
    velocities and joint states. Then it sets constraints, gravity and the time step. Its dictionary `bodies`
    maps present ids to new ids. Colours, friction and motors are not written; `saveBullet` keeps everything.

    Args:
        worldFileName: The script; an existing file is replaced when the new one is complete.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the file cannot be written.

    Examples:
        >>> p.saveWorld(folder + "/scene.py")
        >>> "loadURDF" in open(folder + "/scene.py").read()
        True
    """
    client = client_of(physicsClientId)
    name = text(worldFileName, "worldFileName")

    from carom.writing import write_text
    from pybullet._loading.scene_lines import scene_lines

    with client.call_lock:
        lines = scene_lines(client)
    try:
        write_text(name, "\n".join(lines) + "\n")
    except (OSError, ValueError) as problem:
        fail(_FAILED, f"{problem}.")
