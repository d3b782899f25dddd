"""Placeholders for modules that PyBullet has and Carom lacks: importing them works, using them raises.

Scripts import more than they use. So a placeholder module returns a placeholder object for any name; that
object raises `pybullet.error`, with the reason, when it is called or subclassed, or its attributes are read.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import CodeType, ModuleType
from typing import Any, NoReturn


class Absent:
    """Placeholder for an object of a missing module: almost any use raises `pybullet.error`."""

    def __init__(self, name: str, reason: str) -> None:
        self.__dict__["_absent"] = f"{name} is not available in this version of Carom: {reason}"

    def _raise(self, *arguments: Any, **keywords: Any) -> NoReturn:
        import pybullet

        raise pybullet.error(self.__dict__["_absent"])

    __call__ = __iter__ = __len__ = __getitem__ = __setattr__ = __mro_entries__ = __float__ = _raise
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __neg__ = __bool__ = __index__ = _raise

    def __getattr__(self, name: str) -> Any:
        # Code that inspects objects looks up special names and expects this error.
        if name.startswith("__"):
            raise AttributeError(name)
        self._raise()

    def __repr__(self) -> str:
        return f"<{self.__dict__['_absent']}>"


class _AbsentModule(ModuleType):
    """Placeholder for a missing module."""

    absent_reason: str

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return Absent(f"{self.__name__}.{name}", self.absent_reason)


class _AbsentLoader(Loader):
    """Makes placeholders for modules that are missing for the same reason."""

    def __init__(self, reason: str) -> None:
        self.reason = reason

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = _AbsentModule(spec.name, f"Not available in this version of Carom: {self.reason}.")
        module.absent_reason = self.reason
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Does nothing: placeholders have no code."""

    def get_code(self, name: str) -> CodeType:
        """Code for `python -m`: exits with a message that names the missing module."""
        text = f"{name} is not available in this version of Carom: {self.reason}"
        return compile(f"raise SystemExit({text!r})", f"<{name}>", "exec")


class _AbsentFinder(MetaPathFinder):
    """Finds placeholders; it is the last finder, so that real modules come first."""

    def __init__(self) -> None:
        self.reasons: dict[str, str] = {}
        self.packages: set[str] = set()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        reason = self.reasons.get(fullname)
        if reason is None:
            return None
        return ModuleSpec(fullname, _AbsentLoader(reason), is_package=fullname in self.packages)


_finder = _AbsentFinder()


def announce(package: str, listing: str) -> None:
    """Registers modules that PyBullet has and Carom lacks, so that they can be imported.

    Args:
        package: The package that contains the modules.
        listing: Lines `folder: module module ...`, the folder relative to the package and `.` for the
            package itself, below lines `# reason` that say why these modules are missing.
    """
    if _finder not in sys.meta_path:
        sys.meta_path.append(_finder)
    for folder, names, reason in _lines(listing):
        inside = package if folder == "." else f"{package}.{folder}"
        _finder.packages.add(inside)
        _finder.reasons.update({f"{inside}.{name}": reason for name in names})
        while inside != package:
            _finder.packages.add(inside)
            _finder.reasons.setdefault(inside, reason)
            inside = inside.rpartition(".")[0]


def absent_names(module: str, names: str, reason: str) -> Callable[[str], Absent]:
    """A module's `__getattr__`, which gives placeholders for the names that it lacks."""
    lacking = names.split()

    def find(name: str) -> Absent:
        if name not in lacking:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        return Absent(f"{module}.{name}", reason)

    return find


def _lines(listing: str) -> Iterator[tuple[str, list[str], str]]:
    reason = ""
    for line in filter(None, map(str.strip, listing.splitlines())):
        if line.startswith("#"):
            reason = line[1:].strip()
        else:
            folder, _, names = line.partition(":")
            yield folder, names.split(), reason


def absent_modules() -> list[str]:
    """Sorted names of all registered modules."""
    return sorted(_finder.reasons)
