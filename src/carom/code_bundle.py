"""The compiled modules of a first step in one file.

For each module Python looks into a folder, and opens, checks and reads the file of its compiled code: a tenth
of the time that a script needs to its first step, which takes 250 modules. So a process that has made a world
leaves their code in one file for those after it. As in Python's own files, the time and the size of its
source say whether a module has changed; then Python's usual way is taken. What keeps Python from writing
compiled code (`PYTHONDONTWRITEBYTECODE`, a folder that is not writable) keeps it from writing this file.

Modules that are imported one after the other are together in a part of the file, where what several of them
have, mostly names, is there once.
"""

from __future__ import annotations

import contextlib
import marshal
import os
import sys
from importlib.machinery import ModuleSpec, SourceFileLoader
from itertools import accumulate
from mmap import ACCESS_READ, mmap
from types import CodeType, ModuleType
from typing import Any

__all__ = ["use"]

_PACKAGES = ("carom", "pybullet")
# Modules in one part of the file, which is read as a whole.
_TOGETHER = 32
_FOLDER = os.path.dirname(os.path.dirname(__file__))
# A process with fewer modules that are not in the file leaves it as it is.
_NEW_MODULES = 16
# Without it no world has been made.
_PART = "carom.engine.engine"
# Python's files begin with a magic number, flags, and the time and the size of the source.
_HEADER_BYTES = 16
_LENGTH_BYTES = 4

# Of a module: its source and Python's own file of its code, time [s] and size of the source, the part with
# its code, and its place there.
_Entry = tuple[str, str, int, int, int, int]


class _Loader(SourceFileLoader):
    """Takes a module's code from the file; all else is as usual."""

    finder: _Finder

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """A module that has what Python would look for in vain, with an error each time, and then set."""
        module = ModuleType(spec.name)
        vars(module).update(__file__=spec.origin, __cached__=spec.cached)
        return module

    def get_code(self, fullname: str) -> CodeType | None:
        """The compiled code of the module."""
        try:
            return self.finder.code(fullname)
        except (EOFError, ValueError, TypeError):
            return super().get_code(fullname)


class _Finder:
    """Finds modules in the file.

    Attributes:
        index: What it has, by name.
    """

    def __init__(self, content: mmap, begin: int) -> None:
        end = begin + _LENGTH_BYTES
        begin, end = end, end + int.from_bytes(content[begin:end], "little")
        self.index: dict[str, _Entry]
        # Where each part ends, after the index.
        self._ends: list[int]
        self.index, self._ends = marshal.loads(content[begin:end])
        self._parts = memoryview(content)[end:]
        self._read: dict[int, list[CodeType | None]] = {}

    def find_spec(self, name: str, _path: Any = None, _target: Any = None) -> ModuleSpec | None:
        """How to import a module; None if the file does not have it as it is now."""
        entry = self.index.get(name)
        if entry is None:
            return None
        source, compiled, time, size, _, _ = entry
        if _stamp(source) != (time, size):
            return None
        loader = _Loader(name, source)
        loader.finder = self
        spec = ModuleSpec(name, loader, origin=source)
        if source.endswith("__init__.py"):
            spec.submodule_search_locations = [os.path.dirname(source)]
        spec.has_location = True
        spec.cached = compiled
        return spec

    def code(self, name: str) -> CodeType | None:
        """The code of a module that it has, which it does not keep."""
        *_, part, place = self.index[name]
        codes = self._read.get(part)
        if codes is None or codes[place] is None:
            begin = self._ends[part - 1] if part else 0
            codes = self._read[part] = marshal.loads(self._parts[begin : self._ends[part]])
        code, codes[place] = codes[place], None
        return code


def use(package: ModuleSpec) -> None:
    """Import modules of these packages from the file from now on, and write it at the end if it lacks some.

    Args:
        package: That of `carom`, which says where Python keeps compiled code.
    """
    if type(package.loader) is not SourceFileLoader or not package.cached:
        return
    place = package.cached.replace("__init__.", "bundled.")
    finder = _read(place)
    if finder is not None:
        sys.meta_path.insert(0, finder)
    if not sys.dont_write_bytecode:
        import atexit

        atexit.register(_keep, place, finder)


def _read(place: str) -> _Finder | None:
    beginning = _beginning()
    # Whatever is wrong with it, there are Python's own files.
    with contextlib.suppress(OSError, EOFError, ValueError, TypeError):
        with open(place, "rb") as file:
            content = mmap(file.fileno(), 0, access=ACCESS_READ)
        if content[: len(beginning)] == beginning:
            return _Finder(content, len(beginning))
    return None


def _beginning() -> bytes:
    """Which Python, which form and which folder a file is for."""
    return f"carom {sys.version} {sys.implementation.cache_tag} {_stamp(__file__)}\n{_FOLDER}\n".encode()


def _stamp(source: str) -> tuple[int, int] | None:
    """Time [s] and size of a source, as in Python's files of compiled code; None if there is none."""
    try:
        found = os.stat(source)
    except OSError:
        return None
    return int(found.st_mtime) & 0xFFFFFFFF, found.st_size & 0xFFFFFFFF


def _keep(place: str, finder: _Finder | None) -> None:
    """Write the file anew, with what it has and the modules that this process has imported besides."""
    if _PART not in sys.modules:
        return
    fresh = {name: found for name, module in list(sys.modules.items()) if (found := _compiled(name, module))}
    if len(fresh) < _NEW_MODULES:
        return
    known = finder.index if finder else {}
    with contextlib.suppress(EOFError, ValueError, TypeError):
        kept = {name: (*known[name][:4], finder.code(name)) for name in known if finder and name not in fresh}
        fresh = kept | fresh
    names = list(fresh)
    chunks = [names[first : first + _TOGETHER] for first in range(0, len(names), _TOGETHER)]
    index: dict[str, _Entry] = {
        name: (*fresh[name][:4], part, room)
        for part, chunk in enumerate(chunks)
        for room, name in enumerate(chunk)
    }
    parts = [marshal.dumps([fresh[name][4] for name in chunk]) for chunk in chunks]
    written = marshal.dumps((index, list(accumulate(map(len, parts)))))
    content = b"".join((_beginning(), len(written).to_bytes(_LENGTH_BYTES, "little"), written, *parts))
    from carom.writing import write_whole

    with contextlib.suppress(OSError):
        # Others may be reading the one that is there, which must not change under them: not even where the
        # folder allows no new files, and the one that is there would be written in place.
        with contextlib.suppress(FileNotFoundError):
            os.unlink(place)
        write_whole(place, content)


def _compiled(name: str, module: Any) -> tuple[str, str, int, int, CodeType | None] | None:
    """What `_Entry` has of a module, and its code; None unless it was imported in Python's usual way."""
    spec: ModuleSpec | None = getattr(module, "__spec__", None)
    if name.partition(".")[0] not in _PACKAGES or spec is None or type(spec.loader) is not SourceFileLoader:
        return None
    source, compiled = spec.origin or "", spec.cached
    if not source.startswith(_FOLDER) or not compiled:
        return None
    try:
        with open(compiled, "rb") as file:
            content = file.read()
        code: CodeType = marshal.loads(memoryview(content)[_HEADER_BYTES:])
    except (OSError, EOFError, ValueError, TypeError):
        return None
    time, size = (int.from_bytes(content[place : place + 4], "little") for place in (8, 12))
    # With flags it is checked in another way.
    if any(content[4:8]) or (time, size) != _stamp(source):
        return None
    return source, compiled, time, size, code
