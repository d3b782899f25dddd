"""The boundary of readers: where their work is accounted for, and foreign exceptions become ours.

Whatever NumPy, Pillow, zlib, the standard library or arithmetic raises for the content of a file leaves a
reader as `DescriptionError`, with the file, and the element whose turn it was. `MemoryError` stays what it
is, and so do errors of types, which would be ours.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextvars import Token
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from carom.errors import DescriptionError
from carom.files.budget import Ledger, current
from carom.files.budget import budget as present_budget

if TYPE_CHECKING:
    from carom.files.xml_element import Element

# Packages whose exceptions files cause, and those of the interpreter's own that do.
_PACKAGES = frozenset(
    (
        *("PIL", "numpy", "struct", "zlib", "lzma", "_lzma", "zipfile"),
        *("binascii", "json", "yaml", "xml", "pyexpat"),
    )
)
_OWN = (OSError, ArithmeticError, LookupError, ValueError, EOFError, SyntaxError, RecursionError)
# Those whose meaning is another: a program's own limit of time, or a signal that came.
_OTHERS = (TimeoutError, InterruptedError)
_BY_TYPES = (TypeError, AttributeError)
_NAMES = ("element", "child", "asset", "entry", "owner", "node", "parent")


class WrongArgument(ValueError):
    """An argument of a caller is out of range; it is no matter of the file."""


class Locator(ABC):
    """State of a reading that knows where in its file an element is.

    Attributes:
        file: The file being read.
    """

    file: Path

    @abstractmethod
    def error(self, element: Element, reason: str) -> DescriptionError:
        """An error at an element, with its line and its path in the document."""


class reading:
    """The context in which a file is read; inside another one it counts for the same budget.

    Args:
        file: The file, for messages; None if there is none.
        untyped: The content decides about types, as in JSON, so that errors of types are matters of the file.

    Raises:
        DescriptionError: Instead of a foreign exception, from which it is raised.
    """

    __slots__ = ("_file", "_ledger", "_token", "_untyped")

    def __init__(self, file: Path | None, *, untyped: bool = False) -> None:
        self._file = file
        self._untyped = untyped
        self._token: Token[Ledger | None] | None = None

    def __enter__(self) -> None:
        ledger = current.get()
        if ledger is None:
            ledger = Ledger(present_budget())
            self._token = current.set(ledger)
        self._ledger = ledger
        ledger.files.append(self._file)

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ledger.files.pop()
        if self._token is not None:
            current.reset(self._token)
        if problem is not None and (
            is_foreign(problem) or (self._untyped and isinstance(problem, _BY_TYPES))
        ):
            raise _translated(problem, self._file) from problem


def is_foreign(problem: BaseException) -> bool:
    """Whether an exception is one that the content of files causes in what readers use."""
    package = type(problem).__module__.partition(".")[0]
    if package == "builtins":
        return isinstance(problem, _OWN) and not isinstance(problem, _OTHERS)
    return package in _PACKAGES and not isinstance(problem, MemoryError)


def reason_of(problem: BaseException) -> str:
    """What a message says about a foreign exception."""
    if isinstance(problem, OSError) and problem.strerror:
        return f"cannot be read: {problem.strerror}"
    if isinstance(problem, RecursionError):
        return "it is nested too deeply"
    if isinstance(problem, OverflowError):
        return f"a number is too large to be used ({problem})"
    if isinstance(problem, ZeroDivisionError):
        return "a size or another number is 0, or too small or too large beside the others, to be used"
    return f"its content is invalid: {problem or type(problem).__name__}"


def _translated(problem: BaseException, file: Path | None) -> DescriptionError:
    reason = reason_of(problem)
    context, element = _place(problem.__traceback__)
    # An image or a mesh has no elements; those around it are of the file that names it.
    if element is None or (context is not None and file is not None and context.file.name != file.name):
        return DescriptionError(reason, file=file)
    if context is not None:
        return context.error(element, reason)
    return DescriptionError(
        reason, file=getattr(element, "file", file), line=element.line, element=f"<{element.tag}>"
    )


def _place(trace: TracebackType | None) -> tuple[Locator | None, Element | None]:
    """The context and the element at which a reader was: the innermost ones in its frames."""
    # Here, since readers of images and meshes do not need it.
    from carom.files.xml_element import Element

    context: Locator | None = None
    element: Element | None = None
    while trace is not None:
        seen = trace.tb_frame.f_locals
        if isinstance(seen.get("context"), Locator):
            context = seen["context"]
        here = next((seen[name] for name in _NAMES if isinstance(seen.get(name), Element)), None)
        element = element if here is None else here
        trace = trace.tb_next
    return context, element
