"""Where the examples and the manual are: in the package, or in the clone that it is used from."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
_CLONE = _PACKAGE.parents[1]


def example_files() -> dict[str, Path]:
    """The scripts of the examples by name, sorted.

    Raises:
        FileNotFoundError: They are missing; the message says where they should be.
    """
    folder = _folder("examples/scripts", "examples", "*.py")
    return {file.stem: file for file in sorted(folder.glob("*.py"))}


def manual_pages() -> dict[str, Path]:
    """The pages of the manual by topic, such as "contact" and "tutorials/pid", sorted.

    Raises:
        FileNotFoundError: They are missing; the message says where they should be.
    """
    folder = _folder("manual", "docs", "*.md")
    return {
        file.relative_to(folder).with_suffix("").as_posix(): file for file in sorted(folder.rglob("*.md"))
    }


def _folder(shipped: str, in_clone: str, pattern: str) -> Path:
    for folder in (_PACKAGE / shipped, _CLONE / in_clone):
        if any(folder.glob(pattern)):
            return folder
    raise FileNotFoundError(
        f"{_PACKAGE / shipped} has no {pattern}: this copy of Carom was not installed from a wheel, nor is "
        "it a clone; install it with: pip install carom"
    )
