"""The files that a document is put together from."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.files.bounded import FileStamp, read_bounded
from carom.files.budget import charge
from carom.files.xml_element import PlacedElement
from carom.files.xml_tree import parse_xml
from carom.formats.xacro.globs import has_magic, matches
from carom.formats.xacro.limits import ExpressionError
from carom.formats.xacro.texts import Texts


class Sources:
    """Reads the files of one document, each once.

    Attributes:
        stamps: The files that were read, and what they were like.
    """

    def __init__(self) -> None:
        self.stamps: dict[Path, FileStamp] = {}
        self._roots: dict[Path, PlacedElement] = {}

    def read(self, file: Path) -> bytes:
        """The content of a file."""
        charge("includes", file=file)
        data, self.stamps[file] = read_bounded(file, "document_bytes")
        return data

    def root(self, file: Path) -> PlacedElement:
        """The root element of an included file."""
        if file not in self._roots:
            self._roots[file] = PlacedElement.of(parse_xml(self.read(file), file)[0], file)
        return self._roots[file]

    @staticmethod
    def included(name: str, texts: Texts, *, is_optional: bool) -> list[Path]:
        """The files that an `<xacro:include>` names, by a name or a pattern, relative to the present file.

        Raises:
            ExpressionError: There is no such file, and it is not optional.
        """
        found = texts.located(name)
        if found is not None:
            return [found.resolve()]
        if has_magic(name):
            found_all = matches(str(texts.file.parent / name), texts.budget.step)
            return [Path(it).resolve() for it in found_all]
        if is_optional:
            return []
        hint = ""
        if name.startswith("package://"):
            package = name.removeprefix("package://").partition("/")[0]
            hint = f"; package {package!r} is in no folder above, so give its folder by package_paths="
        raise ExpressionError(f"there is no file {name!r}{hint}")


def is_unchanged(stamps: dict[Path, FileStamp]) -> bool:
    """Whether files certainly are as they were when they were read."""
    try:
        return all(stamp.is_of(file) for file, stamp in stamps.items())
    except (OSError, DescriptionError):
        return False
