"""Where the page can be shown: on this machine, or on that of a user who is logged in over SSH."""

from __future__ import annotations

import getpass
import os
import sys
from urllib.parse import urlsplit

_USUAL_SSH_PORT = "22"


def over_ssh() -> bool:
    """Whether the user is logged in over SSH, from another machine."""
    return bool(os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_CLIENT"))


def has_display() -> bool:
    """Whether a browser can be opened here for the user.

    Not over SSH, even if X11 is forwarded: the browser would run on this machine, and draw through the
    network. The page is shown through a tunnel instead.
    """
    if "CI" in os.environ or over_ssh():
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def tunnel_command(address: str) -> str | None:
    """The command for the user's own machine to reach a page of this one; None without SSH."""
    if not over_ssh():
        return None
    port = urlsplit(address).port
    connection = os.environ.get("SSH_CONNECTION", "").split()
    server, server_port = connection[2:4] if len(connection) == 4 else ("THIS-MACHINE", _USUAL_SSH_PORT)
    option = "" if server_port == _USUAL_SSH_PORT else f" -p {server_port}"
    return f"ssh -L {port}:localhost:{port}{option} {_user()}@{server}"


def where_shown(address: str) -> list[str]:
    """Lines that say where a page is, and over SSH how it is reached from the user's own machine."""
    lines = [f"The simulation is shown at {address}"]
    if tunnel := tunnel_command(address):
        lines.append(
            f"You are connected by SSH: run '{tunnel}' on your own machine, and open {address} there."
        )
    return lines


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "USER"
