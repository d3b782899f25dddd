"""Robot files whose text is given instead of a path, with the files that they refer to."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any
from weakref import finalize

_ROOT = re.compile(r"<([A-Za-z_][\w.:-]*)")
_EXTENSIONS = {"robot": ".urdf", "sdf": ".sdf", "mujoco": ".xml"}

Assets = Mapping[str, bytes | str]
"""Contents of files by their names, relative to the text."""


def is_text(what: Any) -> bool:
    """Whether something is the text of a robot file, or such a text and its assets."""
    text = what[0] if isinstance(what, tuple) and len(what) == 2 else what
    return isinstance(text, str) and text.lstrip("\ufeff \t\r\n").startswith("<")


class TextFiles:
    """A text and its assets as files of a temporary folder, which is removed when nobody has this object.

    Attributes:
        path: The file with the text.

    Raises:
        ValueError: A name of an asset leads out of the folder.
    """

    def __init__(self, what: str | tuple[str, Assets]) -> None:
        text, assets = (what, {}) if isinstance(what, str) else what
        folder = Path(tempfile.mkdtemp(prefix="carom-text-"))
        self._finalizer = finalize(self, shutil.rmtree, folder, ignore_errors=True)
        for name, content in assets.items():
            place = PurePosixPath(str(name).replace("\\", "/"))
            if place.is_absolute() or ".." in place.parts or not place.parts or ":" in place.parts[0]:
                raise ValueError(f"assets are named relative to the text, within its folder, not {name!r}")
            file = folder.joinpath(*place.parts)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content.encode() if isinstance(content, str) else bytes(content))
        comment_free = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
        root = _ROOT.search(comment_free)
        extension = _EXTENSIONS.get("" if root is None else root[1], ".xml")
        self.path: Path = folder / f"text{extension}"
        self.path.write_text(text.lstrip("\ufeff \t\r\n"), encoding="utf-8")
