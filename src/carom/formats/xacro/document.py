"""Documents with macros of xacro: which they are, and what they expand to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.boundary import WrongArgument
from carom.files.bounded import FileStamp
from carom.files.xml_element import MAX_DEPTH, Element, PlacedElement
from carom.formats.search import AssetSearch
from carom.formats.xacro.expansion import PREFIX, Expansion
from carom.formats.xacro.limits import Allowance
from carom.formats.xacro.sources import Sources, is_unchanged
from carom.formats.xacro.texts import Texts


@dataclass(eq=False, slots=True)
class Expanded:
    """A document without macros.

    Attributes:
        root: Its root element; every element has its file and line.
        files: The other files that were read for it.
        packages: Packages that were looked for from a file, and what was found.
        arguments: The values of the arguments that it declares, by name; empty for those without a value.
        is_lasting: Whether it is the same as long as all these are; not if it asks the environment.
    """

    root: PlacedElement
    files: dict[Path, FileStamp] = field(default_factory=dict)
    packages: dict[tuple[str, Path], Path | None] = field(default_factory=dict)
    arguments: dict[str, str] = field(default_factory=dict)
    is_lasting: bool = True

    def is_still_valid(self, search: AssetSearch) -> bool:
        """Whether the document would be the same if its file were read again, unchanged."""
        return (
            self.is_lasting
            and is_unchanged(self.files)
            and all(search.find_package(name, file) == it for (name, file), it in self.packages.items())
        )


def expanded_if_xacro(
    root: Element, file: Path, search: AssetSearch, arguments: Sequence[tuple[str, str]]
) -> Expanded | None:
    """The expanded document of a root element; None if there is nothing to expand.

    Raises:
        DescriptionError: As `expand`.
        ValueError: There are arguments that the document does not have.
    """
    if is_xacro(root, file):
        return expand(root, file, search, dict(arguments))
    if arguments:
        raise WrongArgument(
            f"{file} is no xacro file, so it has no argument {arguments[0][0]!r} for xacro_args"
        )
    return None


def is_xacro(root: Element, file: Path) -> bool:
    """Whether a document has anything to expand.

    That is so if an element is one of xacro's, or if it declares the namespace, or its name ends with
    `.xacro`, and has an expression somewhere.
    """
    may_have = file.suffix.lower() == ".xacro" or "xmlns:xacro" in root.attributes
    pending = [root]
    while pending:
        element = pending.pop()
        if element.tag.startswith(PREFIX):
            return True
        if may_have and any(
            "${" in text or "$(" in text for text in (element.text, *element.attributes.values())
        ):
            return True
        pending.extend(element.children)
    return False


def expand(root: Element, file: Path, search: AssetSearch, arguments: Mapping[str, str]) -> Expanded:
    """The document of a root element with all macros, conditions and expressions of xacro expanded.

    `arguments` are values of `<xacro:arg>`, by name. `search` finds packages.

    Raises:
        DescriptionError: The document has an error, or exceeds the bounds of `carom.formats.xacro.limits`.
        ValueError: It declares no argument of a name that is given.
    """
    budget, sources = Allowance(), Sources()
    texts = Texts(file, search, arguments, budget)
    texts.read = sources.read
    expansion = Expansion(texts, sources, budget)
    result = expansion.document(PlacedElement.of(root, file))
    unknown = sorted(set(arguments) - expansion.declared - texts.used)
    if unknown:
        known = ", ".join(sorted(expansion.declared)) or "none"
        raise WrongArgument(f"{file} has no argument {unknown[0]!r} for xacro_args; its arguments: {known}")
    _check_depth(result)
    budget.settle()
    declared = {name: texts.arguments.get(name, "") for name in sorted(expansion.declared)}
    return Expanded(result, sources.stamps, texts.packages, declared, texts.is_lasting)


def _check_depth(root: PlacedElement) -> None:
    level: list[Element] = [root]
    for _ in range(MAX_DEPTH):
        level = [child for element in level for child in element.children]
        if not level:
            return
    raise DescriptionError(f"elements nested deeper than {MAX_DEPTH}", file=root.file, line=level[0].line)
