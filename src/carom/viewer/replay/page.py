"""The page as one file that plays a recording, without a server and without a network.

Browsers do not let a page that is a local file load modules from other files. So the modules are packed into
the page, under names (`carom/view/scene.js`) in an import map, and a short script unpacks them.
"""

from __future__ import annotations

import json
import posixpath
import re
from base64 import b64encode
from functools import cache
from html import escape
from zlib import compress

from carom.viewer.page_files import page_files

PLACE = "RECORDING"
"""What stands in the page without a recording, in its place."""
# Matches an import by a path relative to the importing module.
_IMPORT = re.compile(r'(\bfrom ")(\.[^"]+)(")')
_STYLE = re.compile(r'<link rel="stylesheet"[^>]*>')
_ICON = re.compile(r'<link rel="icon"[^>]*>')
_TITLE = re.compile(r"<title>[^<]*</title>")
_WHAT_IT_IS = "A recorded simulation: turn it, go through its time, look at joints and contacts."
_SCRIPT = re.compile(r'<script type="module"[^>]*></script>')
_UNPACK = """
(async () => {
  const packed = await (await fetch("data:application/octet-stream;base64,%s")).blob();
  const text = await new Response(packed.stream().pipeThrough(new DecompressionStream("deflate"))).text();
  const imports = {};
  for (const [name, source] of Object.entries(JSON.parse(text))) {
    imports["carom/" + name] = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  }
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({ imports });
  document.head.append(map);
  await import("carom/main.js");
})();
"""


@cache
def replay_page() -> str:
    """The page with `RECORDING` in place of the recording, which is in base 64."""
    files = {name: content.decode() for name, content in page_files().items()}
    modules = {
        name: _with_absolute_imports(name, text)
        for name, text in files.items()
        if name.endswith(".js") and name != "starting.js"
    }
    packed = b64encode(compress(json.dumps(modules).encode(), 9)).decode()
    script = (
        f'<script type="application/octet-stream" id="recording">{PLACE}</script>\n'
        f"    <script>{_UNPACK % packed}</script>"
    )
    page = _STYLE.sub(lambda _: f"<style>\n{files['style.css']}</style>", files["index.html"])
    page = _ICON.sub("", _SCRIPT.sub("", page))
    return page.replace("</body>", f"  {script}\n  </body>")


def replay_of(recording: bytes, title: str) -> str:
    """A page that plays a recording; see `recording.py` for its format.

    Where a link to it is shown, it has its title and what it is.
    """
    named = escape(title)
    told = (
        f'<title>{named}</title>\n    <meta property="og:type" content="website" />'
        f'\n    <meta property="og:title" content="{named}" />'
        f'\n    <meta property="og:description" content="{_WHAT_IT_IS}" />'
    )
    page = _TITLE.sub(lambda _: told, replay_page(), count=1)
    return page.replace(PLACE, b64encode(recording).decode())


def _with_absolute_imports(name: str, text: str) -> str:
    folder = posixpath.dirname(name)

    def absolute(found: re.Match[str]) -> str:
        return f"{found[1]}carom/{posixpath.normpath(posixpath.join(folder, found[2]))}{found[3]}"

    return _IMPORT.sub(absolute, text)
