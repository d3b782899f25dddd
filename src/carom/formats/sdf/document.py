"""Reading an SDF file as its author means it: models, those that they include, and options of the world."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from carom.files.bounded import read_bounded
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.reading.cursor import Cursor
from carom.formats.robot.context import shown, shown_path
from carom.formats.robot.file import Includes, warn_of_assumed_masses
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.frames import Frames
from carom.formats.sdf.network import is_remote, local_name
from carom.formats.sdf.options import read_options
from carom.formats.sdf.scene import SdfScene
from carom.formats.sdf.tree import Opened, read_tree
from carom.formats.sdf.written_model import read_written_model
from carom.formats.search import AssetSearch

_LATE_DECLARATION = rb"(?<=-->)\s*<\?xml[^>]*\?>"
_MODEL = "model://"
_MODEL_FILES = ("model.sdf", "model.config")


class Document:
    """The reading of one file and of all files that it includes."""

    def __init__(
        self, scale: float, search: AssetSearch, cursor: Cursor, *, missing_meshes: bool = False
    ) -> None:
        self._scale = scale
        self._search = search
        self._cursor = cursor
        self._missing_meshes = missing_meshes
        self._includes = Includes()
        self._including: dict[SdfContext, tuple[Path, ...]] = {}

    def read(self, file: Path, xacro_args: Sequence[tuple[str, str]] = ()) -> SdfScene:
        """All of a file; raises `DescriptionError`."""
        context = self._parse(file, (), xacro_args)
        world = context.root.first("world")
        tree = read_tree(context, world or context.root, self._open)
        frames = Frames(tree)
        for part in tree.of("joint"):
            part.context.leave_out_all(part.element, "models are not joined", "joints are those of a model")
        scene = SdfScene(options={} if world is None else read_options(context, world))
        for model in tree.models:
            scene.models.append(read_written_model(frames, model))
        for each in self._including:
            warn_of_assumed_masses(each)
        return scene

    def _parse(
        self, file: Path, including: tuple[Path, ...], xacro_args: Sequence[tuple[str, str]] = ()
    ) -> SdfContext:
        data, _ = read_bounded(file, "document_bytes")
        # Gazebo's parser takes a declaration anywhere before the first element, as after a licence.
        data = re.sub(_LATE_DECLARATION, _blank, data, count=1)
        root = parse_root(data, file, "sdf")
        if b"xacro" in data or file.suffix.lower() == ".xacro" or xacro_args:
            # Imported only here: few files need it.
            from carom.formats.xacro.document import expanded_if_xacro

            expanded = expanded_if_xacro(root, file, self._search, xacro_args)
            root = root if expanded is None else expanded.root
        root = self._cursor.trace(root, file)
        root.attributes.get("version")
        context = SdfContext(file, root, self._scale, self._search)
        context.cursor = self._cursor
        context.as_written = True
        context.missing_meshes = self._missing_meshes
        self._including[context] = (*including, file)
        return context

    def _open(self, context: SdfContext, element: Element) -> Opened | None:
        """The model of the file that an `<include>` names; None, which is reported, if there is none."""
        uri = context.text(element, "uri") or ""
        found, including = self._find(context, uri), self._including[context]
        if is_remote(uri) and found is not None and found.absolute() in including:
            # A file may stand for the model of the same name on the network.
            found = None
        if found is None:
            reason = f"{shown_path(uri)} was found neither beside the file nor in package_paths"
            context.leave_out_all(element, "the model is missing", reason)
            return None
        file = self._includes.admit(context, element, uri, found, including)
        inner = self._parse(file, including)
        world = inner.root.first("world")
        model = (world or inner.root).first("model")
        if model is None:
            context.leave_out_all(element, "it is missing", f"{shown(uri)} holds no <model>")
            return None
        for other in (world or inner.root).all("model"):
            if other is not model:
                inner.leave_out_all(other, "the model is missing", "an included file holds one model")
        return inner, model

    def _find(self, context: SdfContext, uri: str) -> Path | None:
        """The file at a URI, or the model file in the directory at that URI."""
        name = uri
        if is_remote(uri):
            name = local_name(uri)
        folder = name.rstrip("/")
        for candidate in (name, f"{folder}/{_MODEL_FILES[0]}"):
            file = self._search.find_included(candidate, context.file)
            if file is not None and (candidate == name or _is_in(file, folder)):
                return file
        config = self._search.find_included(f"{folder}/{_MODEL_FILES[1]}", context.file)
        return self._newest(config) if config is not None and _is_in(config, folder) else None

    def _newest(self, config: Path) -> Path | None:
        """The file of a model that its `model.config` names: that of the latest version of the format."""
        data, _ = read_bounded(config, "document_bytes")
        found: tuple[tuple[int, ...], Path] | None = None
        for element in parse_root(data, config, "model").all("sdf"):
            words = element.attributes.get("version", "0").split(".")
            version = tuple(int(word) for word in words if word.isdigit())
            file = config.parent / element.text.strip()
            if file.is_file() and (found is None or version > found[0]):
                found = version, file
        return None if found is None else found[1]


def _is_in(file: Path, folder: str) -> bool:
    """Whether a file is in the folder of the model that a URI names, and not that of another model."""
    return not folder.startswith(_MODEL) or file.absolute().parent.name == folder.rpartition("/")[2]


def _blank(match: re.Match[bytes]) -> bytes:
    """Spaces in place of a text, so that lines keep their numbers."""
    return re.sub(rb"[^\n]", b" ", match.group())
