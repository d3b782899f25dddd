"""The files of the page, and the addresses that a server has them at.

They have the digest of all of them in their addresses, so that browsers can keep them for ever: another
version is somewhere else.
"""

from __future__ import annotations

import re
from functools import cache
from hashlib import sha256
from pathlib import Path

_PAGE = Path(__file__).with_name("page")
_KINDS = frozenset({".html", ".css", ".js", ".svg"})
# Those of the page itself, which are not parts of it, or none that is loaded by its name.
_NOT_KEPT = frozenset({"index.html", "notebook.js"})
_DIGITS = 16
_STARTING = '<script type="module" src="main.js"></script>'


@cache
def page_files() -> dict[str, bytes]:
    """Content of every file of the page, by its path relative to the page's address."""
    return {
        path.relative_to(_PAGE).as_posix(): path.read_bytes()
        for path in sorted(_PAGE.rglob("*"))
        if path.suffix in _KINDS
    }


@cache
def lasting_files() -> dict[str, bytes]:
    """The parts of the page, by the addresses that a server has them at: one always means the same."""
    files = page_files()
    digest = sha256()
    for name, content in files.items():
        digest.update(f"{name} {len(content)} ".encode())
        digest.update(content)
    folder = digest.hexdigest()[:_DIGITS]
    return {f"{folder}/{name}": content for name, content in files.items() if name not in _NOT_KEPT}


@cache
def served_page(*, spectator: bool = False) -> bytes:
    """The page that a server sends: it names all its parts at their addresses, so that they come at once.

    That of a spectator knows that it only watches.
    """
    files = lasting_files()
    folder = next(iter(files)).partition("/")[0]
    page = page_files()["index.html"].decode()
    if spectator:
        page = page.replace("<body>", '<body class="spectator">')
    page = re.sub(r'href="(icon\.svg|style\.css)"', rf'href="{folder}/\1"', page)
    preloads = [
        f'<link rel="modulepreload" href="{name}" />'
        for name in files
        if name.endswith(".js") and not name.endswith("/starting.js")
    ]
    starting = f'<script defer src="{folder}/starting.js"></script>'
    return page.replace(_STARTING, "\n    ".join([starting, *preloads])).encode()
