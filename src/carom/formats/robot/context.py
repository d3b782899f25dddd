"""State that all parts of a reader share: file, scale, and methods that parse and check numbers."""

from __future__ import annotations

import re
from contextlib import suppress
from math import inf, isfinite, isnan
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from carom.description import Material, Pose
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import quaternion_from_rpy
from carom.errors import DescriptionError
from carom.files.boundary import Locator
from carom.files.xml_element import Element, from_calls
from carom.formats.search import AssetSearch
from carom.layouts.magnitudes import MAX_MAGNITUDE
from carom.logger import Logger

if TYPE_CHECKING:
    from carom.formats.reading.cursor import Cursor
    from carom.formats.reading.written import Written

Default = TypeVar("Default")

_log = Logger(__name__)
# Patterns are compiled when a text needs them: few do.
_LEADING_NUMBER = r"(?![+-]?0[xX])[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_LEADING_BITS = r"[+-]?0[xX][0-9a-fA-F]+|" + _LEADING_NUMBER
_LEADING_HEXADECIMAL = r"[+-]?0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)(?:[pP][+-]?\d+)?"
_LEADING_NOT_FINITE = r"[+-]?(?:inf(?:inity)?|nan)"
# The numbers that C's `strtod` knows.
_LEADING_BOUND = f"(?i:{_LEADING_NOT_FINITE}|{_LEADING_HEXADECIMAL}|{_LEADING_NUMBER})"
# What consists of these alone is a number for C exactly if it is one for Python.
_DECIMAL = frozenset("+-.0123456789")
_MIN_BITS = -(1 << 31)

_LONGEST_SHOWN = 60
_LONGEST_PATH = 400


class MissingFile(DescriptionError):
    """A file that a robot file refers to is missing, or of a kind that cannot be read."""


class FileContext(Locator):
    """State of one reading, for formats that keep values in the attributes of elements.

    Attributes:
        file: The file being read.
        root: The element that holds all others.
        scale: Factor on every length.
        search: The search for meshes and textures.
        references: The path that each file name in the file was resolved to; None if there is no such file.
        links_without_inertial: Names of links that got the default mass.
        materials: The materials of a URDF file read so far, by name.
        written: How to read the file as its author meant it; None to read it as PyBullet does.
        cursor: What the reader has taken, if that is reported.
        parts: The files that macros included into this one.
        mesh_directory: Where meshes are that are not found by the name in the file; empty for nowhere.
    """

    def __init__(self, file: Path, root: Element, scale: float, search: AssetSearch) -> None:
        self.file = file
        self.root = root
        self.scale = scale
        self.search = search
        self.references: dict[str, Path | None] = {}
        self.links_without_inertial: list[str] = []
        self.materials: dict[str, Material] = {}
        self.written: Written | None = None
        self.cursor: Cursor | None = None
        self.mesh_directory = ""
        self.parts: list[Path] = []

    def error(self, element: Element, reason: str) -> DescriptionError:
        """An error at an element, with its line and its path in the document."""
        names = (_label(step) for step in self.root.path_to(element) or [element])
        return DescriptionError(
            reason + from_calls(element),
            file=self.file_of(element),
            line=element.line,
            element=" > ".join(names),
        )

    def file_of(self, element: Element) -> Path:
        """The file that contains an element: an included one for what macros made of that."""
        # Reached only with a warning or an error.
        from carom.formats.reading.cursor import TracedElement

        return element.file if isinstance(element, TracedElement) else self.file

    def warn(self, element: Element, message: str) -> None:
        """Log a warning about something that the author of the file may have meant differently."""
        _log.warning("%s:%d: %s: %s", self.file_of(element), element.line, _label(element), message)

    def required(self, element: Element, attribute: str) -> str:
        """The text of a required attribute."""
        try:
            return element.attributes[attribute]
        except KeyError:
            raise self.error(element, f"attribute {attribute!r} is missing") from None

    def find_file(self, name: str) -> Path | None:
        """The file that a name in this file refers to; the result is kept in `references`."""
        if name not in self.references:
            found = self.search.find_referenced(name, self.file)
            for file in self.parts if found is None else ():
                found = found or self.search.find_referenced(name, file)
            if found is None and self.mesh_directory:
                found = self.search.find_in(self.mesh_directory, name, self.file)
            self.references[name] = found
        return self.references[name]

    def states(self, element: Element, key: str) -> bool:
        """Whether an element states a value."""
        return self.stated(element, key) is not None

    def stated(self, element: Element, key: str) -> tuple[Element, str] | None:
        """The element that holds a value of an element, and the text of the value; None if it is missing."""
        text = element.attributes.get(key)
        return None if text is None else (element, text)

    def value(self, element: Element, key: str, default: float | None = None) -> float:
        """A finite number that an element states; an error if it is missing and has no default."""
        stated = self.stated(element, key)
        if stated is not None:
            return self.parse_number(stated[0], key, stated[1])
        if default is None:
            raise self.error(element, f"{self.value_name(key)} is missing")
        return default

    def value_name(self, key: str) -> str:
        """What messages call a value."""
        return f"attribute {key!r}"

    def bound(self, element: Element, key: str, default: float) -> float:
        """A number of any size that bounds something; infinite where there is no bound.

        As in PyBullet, a text that does not begin with a number is read as 0, with a warning.
        """
        stated = self.stated(element, key)
        if stated is None:
            return default
        place, text = stated
        bound = _leading_number(_LEADING_BOUND, text)
        if bound is None:
            self.warn(place, f"{key}={shown(text)} is no number, so it is read as 0, as in PyBullet")
            return 0.0
        if isnan(bound[0]):
            raise self.error(place, f"{key}={shown(text)} is not a number")
        if bound[1] != text.strip():
            self.warn(place, f"{key}={shown(text)} is read as {bound[1]}")
        return bound[0]

    def place(self, parent: Element, tag: str) -> tuple[Element, str]:
        """The arguments of `value` for a number that a child of an element states."""
        child = parent.first(tag)
        if child is None:
            raise self.error(parent, f"<{tag}> is missing")
        return child, "value"

    def child_value(self, parent: Element, tag: str, default: Default) -> float | Default:
        """The number that a child of an element states; `default` without such a child."""
        return default if parent.first(tag) is None else self.value(*self.place(parent, tag))

    def non_negative(self, element: Element, key: str) -> float:
        """A required number that must not be negative."""
        value = self.value(element, key)
        if value < 0.0:
            raise self.error(element, f"{key}={value:g} must not be negative")
        return value

    def bit_mask(self, element: Element, attribute: str) -> int | None:
        """32 bits from an attribute, as a signed number; None where it is not given."""
        text = element.attributes.get(attribute)
        return None if text is None else self.parse_bits(element, attribute, text)

    def parse_bits(self, element: Element, attribute: str, text: str) -> int:
        """32 bits, as a signed number.

        As in PyBullet, a text that is not a number (such as the name of a group) sets no bit, and a number
        that is too large sets only the highest.
        """
        match = re.match(_LEADING_BITS, text.strip())
        if match is None:
            self.warn(element, f"{attribute}={shown(text)} is no number, so it is read as 0, as in PyBullet")
            return 0
        digits = match.group()
        value = int(digits, 16) if "x" in digits.lower() else _whole(float(digits))
        if not _MIN_BITS <= value < 1 << 32:
            self.warn(element, f"{attribute}={shown(text)} does not fit into 32 bits; the highest is set")
            return _MIN_BITS
        return value if value < 1 << 31 else value - (1 << 32)

    def parse_number(self, element: Element, attribute: str, text: str) -> float:
        """A finite number; any text after it is ignored with a warning, as in PyBullet."""
        try:
            value = float(text)
        except ValueError:
            value = self._number_before_text(element, attribute, text)
        if not isfinite(value) or abs(value) > MAX_MAGNITUDE:
            raise self.error(element, f"{attribute}={shown(text)} is not a finite number of sensible size")
        return value

    def parse_components(
        self, element: Element, name: str, text: str, counts: tuple[int, ...]
    ) -> list[float] | None:
        """The components of a colour; None, with a warning but no error, if they cannot be read."""
        try:
            components = [self.parse_number(element, name, word) for word in text.split()]
        except DescriptionError as error:
            self.warn(element, f"ignored: {error.reason}")
            return None
        if len(components) not in counts:
            self.warn(element, f"{name}={shown(text)} needs {counts[0]} numbers; ignored")
            return None
        return components

    def _number_before_text(self, element: Element, attribute: str, text: str) -> float:
        number = _leading_number(_LEADING_NUMBER, text)
        if number is None:
            raise self.error(element, f"{attribute}={shown(text)} is not a number")
        self.warn(element, f"{attribute}={shown(text)} is read as {number[1]}")
        return number[0]

    def vector(self, element: Element, attribute: str) -> Vector3 | None:
        """Three numbers from an attribute; None where it holds fewer. More than three are ignored."""
        words = element.attributes[attribute].split()
        if len(words) < 3:
            return None
        try:
            vector = (float(words[0]), float(words[1]), float(words[2]))
        except ValueError:
            x, y, z = (self._component(element, attribute, word) for word in words[:3])
            vector = (x, y, z)
        # One test for all three: NaN and infinity both fail it.
        if not abs(vector[0]) + abs(vector[1]) + abs(vector[2]) <= MAX_MAGNITUDE:
            raise self.error(
                element, f"{attribute}={shown(element.attributes[attribute])} is not finite or out of range"
            )
        return vector

    def _component(self, element: Element, attribute: str, word: str) -> float:
        """One number of a vector. Some robot files hold unexpanded xacro, which PyBullet reads as zeros."""
        if "$" in element.attributes[attribute] and re.match(_LEADING_NUMBER, word) is None:
            self.warn(element, f"{attribute}: {shown(word)} is read as 0 (unexpanded xacro?)")
            return 0.0
        return self.parse_number(element, attribute, word)

    def vector_or_zero(self, element: Element, attribute: str) -> Vector3:
        """Three numbers; zeros where the attribute is missing, or, with a warning, holds fewer."""
        text = element.attributes.get(attribute)
        if text is None:
            return (0.0, 0.0, 0.0)
        vector = self.vector(element, attribute)
        if vector is None:
            self.warn(element, f"{attribute}={shown(text)} needs three numbers; read as zeros")
            return (0.0, 0.0, 0.0)
        return vector

    def pose(self, parent: Element) -> Pose:
        """The pose in the `<origin>` of an element, scaled."""
        element = parent.first("origin")
        if element is None:
            return IDENTITY
        x, y, z = self.vector_or_zero(element, "xyz")
        roll, pitch, yaw = self.vector_or_zero(element, "rpy")
        scale = self.scale
        position = (x * scale, y * scale, z * scale)
        if roll == 0.0 and pitch == 0.0 and yaw == 0.0:
            return Pose(position)
        return Pose(position, quaternion_from_rpy(roll, pitch, yaw))

    def refuse_duplicate(self, element: Element, name: str, lines: dict[str, int]) -> None:
        """Record the line of a name in `lines`; raises `DescriptionError` if it is there already."""
        if name in lines:
            raise self.error(element, f"the name {shown(name)} is taken already, on line {lines[name]}")
        lines[name] = element.line

    def leave_out(self, element: Element, consequence: str, reason: str, *attributes: str) -> None:
        """Report something that is read and not simulated; without a cursor, as a warning."""
        if self.cursor is not None:
            self.cursor.leave_out(element, consequence, reason, attributes=attributes)
        else:
            self.warn(element, f"{consequence}: {reason}")

    def leave_out_all(self, element: Element, consequence: str, reason: str) -> None:
        """Report an element that is not simulated, once for all that is in it."""
        self.leave_out(element, consequence, reason)
        _take(element)

    def not_found(self, element: Element, name: str) -> MissingFile:
        """The error for a file that was not found."""
        problem = self.error(
            element, f"{shown_path(name)} was found neither beside the file nor in a directory above it"
        )
        return MissingFile(problem.reason, file=problem.file, line=problem.line, element=problem.element)

    def user_data(self, owner: Element) -> dict[str, str]:
        """Key and value pairs in `<bullet><user-data key="...">` below an element; the last one counts."""
        pairs: dict[str, str] = {}
        for bullet in owner.all("bullet"):
            for entry in bullet.all("user-data"):
                pairs[self.required(entry, "key")] = "" if entry.text.isspace() else entry.text
        return pairs


def _leading_number(numbers: str, text: str) -> tuple[float, str] | None:
    """The number that a text begins with, and how it is written there; None if there is none.

    `numbers` is the pattern of the numbers that are read.
    """
    text = text.strip()
    if _DECIMAL.issuperset(text):
        with suppress(ValueError):
            return float(text), text
    match = re.match(numbers, text)
    if match is None:
        return None
    digits = match.group()
    return _float_from_hexadecimal(digits) if "x" in digits.lower() else float(digits), digits


def _float_from_hexadecimal(digits: str) -> float:
    try:
        return float.fromhex(digits)
    except OverflowError:
        return -inf if digits.startswith("-") else inf


def _whole(value: float) -> int:
    """A number without its fraction; for infinity, one that does not fit into 32 bits."""
    return int(value) if isfinite(value) else 1 << 32


def shown(text: str) -> str:
    """Text from a file for use in a message: quoted, and shortened if it is long."""
    return repr(_cut(text))


def shown_path(text: str) -> str:
    """The path of a file, or its address, for use in a message: quoted, and whole unless it is very long."""
    half = _LONGEST_PATH // 2
    return repr(text if len(text) <= _LONGEST_PATH else f"{text[:half]}...{text[-half:]}")


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def _label(element: Element) -> str:
    name = element.attributes.get("name")
    return f"<{element.tag}>" if name is None else f'<{element.tag} name="{_cut(name)}">'


def _take(element: Element) -> None:
    """Note that an element is used, with all in it."""
    element.note()
    for name in list(element.attributes):
        element.attributes.get(name)
    for child in element.children:
        _take(child)
