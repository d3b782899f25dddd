"""The page inside a notebook, reached by the browser wherever the notebook runs."""

from __future__ import annotations

import html
import json
import os
import sys
from base64 import b64encode
from uuid import uuid4

from carom.viewer.page_files import page_files

HEIGHT = 520
# Permissions of the page in the frame: full screen, and copying the camera's numbers.
_ALLOWED = "fullscreen; clipboard-write; gamepad"
_UNREACHABLE = """<p style="font: 14px system-ui, sans-serif">The simulation cannot be reached from here. It
has ended, or the notebook server has no proxy: <code>pip install jupyter-server-proxy</code> and restart it.
A recording needs no connection: <code>with world.record("run.html") as replay: ...</code> and
<code>replay</code> as the last line of a cell.</p>"""


def frame(port: int, token: str, picture: bytes | None = None, height: int = HEIGHT) -> str:
    """HTML that shows the page of a server on the kernel's machine or, if out of reach, a picture (PNG)."""
    identifier = f"carom-{uuid4().hex}"
    facts = json.dumps(
        {
            "id": identifier,
            "port": port,
            "token": token,
            "proxy": _proxy_of_editor(port),
            "unreachable": _shown(picture) + _UNREACHABLE,
        }
    )
    script = page_files()["notebook.js"].decode().replace("FACTS", facts.replace("</", "<\\/"))
    style = f"width:100%;height:{height}px;border:0"
    address = f"http://127.0.0.1:{port}/?token={token}"
    return (
        f'<iframe id="{identifier}" style="{style}" allow="{_ALLOWED}"></iframe><script>{script}</script>'
        f'<noscript><iframe src="{address}" style="{style}"></iframe></noscript>'
    )


def _shown(picture: bytes | None) -> str:
    if picture is None:
        return ""
    return f'<img alt="The simulation" src="data:image/png;base64,{b64encode(picture).decode()}">'


def replay_frame(page: str) -> str:
    """HTML that contains the page of a replay and shows it."""
    return f'<iframe srcdoc="{html.escape(page)}" style="width:100%;height:{HEIGHT}px;border:0"></iframe>'


def in_notebook() -> bool:
    """Whether this process is the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def show(markup: str) -> None:
    """Shows HTML below the present cell."""
    from importlib import import_module

    import_module("IPython.display").display({"text/html": markup}, raw=True)


def _proxy_of_editor(port: int) -> str | None:
    """The proxy address of an editor in the browser, such as code-server, if it is configured."""
    pattern = os.environ.get("VSCODE_PROXY_URI", "")
    if not pattern.startswith(("http://", "https://")) or "{{port}}" not in pattern:
        return None
    return pattern.replace("{{port}}", str(port)).rstrip("/") + "/"
