"""Modules that PyBullet has and Carom has not: they can be imported, and say at their use what is missing.

Scripts import more than they use. So a module that is not here still gives whatever is asked of it; what it
gives raises `pybullet.error` when it is called, subclassed, or asked for anything itself.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import CodeType, ModuleType
from typing import Any, NoReturn


class Absent:
    """Something out of a module that is not here."""

    def __init__(self, name: str, reason: str) -> None:
        self.__dict__["_absent"] = f"{name} is not available in this version of Carom: {reason}"

    def _raise(self, *arguments: Any, **keywords: Any) -> NoReturn:
        import pybullet

        raise pybullet.error(self.__dict__["_absent"])

    __call__ = __iter__ = __len__ = __getitem__ = __setattr__ = __mro_entries__ = __float__ = _raise
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __neg__ = __bool__ = __index__ = _raise

    def __getattr__(self, name: str) -> Any:
        # Who inspects an object asks for such names and expects this answer.
        if name.startswith("__"):
            raise AttributeError(name)
        self._raise()

    def __repr__(self) -> str:
        return f"<{self.__dict__['_absent']}>"


class _AbsentModule(ModuleType):
    """A module that is not here."""

    absent_reason: str

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return Absent(f"{self.__name__}.{name}", self.absent_reason)


class _AbsentLoader(Loader):
    """Makes modules that are not here, for one reason."""

    def __init__(self, reason: str) -> None:
        self.reason = reason

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = _AbsentModule(spec.name, f"Not available in this version of Carom: {self.reason}.")
        module.absent_reason = self.reason
        return module

    def exec_module(self, module: ModuleType) -> None:
        """There is nothing to run."""

    def get_code(self, name: str) -> CodeType:
        """What `python -m` runs: it says what is missing and ends."""
        text = f"{name} is not available in this version of Carom: {self.reason}"
        return compile(f"raise SystemExit({text!r})", f"<{name}>", "exec")


class _AbsentFinder(MetaPathFinder):
    """Finds what nobody else has found."""

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
    """Makes modules known that PyBullet has, so that they can be imported.

    Args:
        package: The package they are in.
        listing: Lines `folder: module module ...`, the folder relative to the package and `.` for itself,
            under lines `# reason` that say why they are missing.
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


def _lines(listing: str) -> Iterator[tuple[str, list[str], str]]:
    reason = ""
    for line in filter(None, map(str.strip, listing.splitlines())):
        if line.startswith("#"):
            reason = line[1:].strip()
        else:
            folder, _, names = line.partition(":")
            yield folder, names.split(), reason


def absent_modules() -> list[str]:
    """Names of all modules made known so far, in order."""
    return sorted(_finder.reasons)
