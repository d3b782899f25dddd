"""The search for files that scripts and robot files refer to."""

from __future__ import annotations

import os
import re
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from carom.files.unpacking import appears

# Scripts written against a source tree name files relative to a `data` folder near the working directory.
_DATA_PREFIXES = ("", "./data/", "../data/", "../../data/", "../../../data/", "../../../../data/")
_SCHEMES = ("package://", "model://")
_CACHED = 1024
_PACKAGE_NAME = r"<name>([^<]*)</name>"
_PACKAGE_BYTES = 1 << 16


class AssetSearch(NamedTuple):
    """The directories that are searched for files, and their order.

    Attributes:
        additional: A directory searched after the working directory, as set by the user.
        folders: Directories searched after that.
        packages: Directories of packages, or directories that contain them, for `package://` and `model://`;
            with them (also if there are none) the folders above a robot file are searched for packages. None
            to search as PyBullet does.
    """

    additional: Path | None = None
    folders: tuple[Path, ...] = ()
    packages: tuple[Path, ...] | None = None

    @property
    def places(self) -> tuple[Path | None, ...]:
        """The directories that are searched besides the working directory."""
        return (self.additional, *self.folders)

    def find(self, name: str | os.PathLike[str]) -> Path | None:
        """The file that a script names: as named or in a nearby `data` folder, then in `places`.

        Its path is as it was found; None if there is no such file.
        """
        text = os.fspath(name)
        found = _nearby(text)
        for folder in self.places if found is None else ():
            if folder is not None and (found := _nearby(os.path.join(folder, text.lstrip("/\\")))):
                break
        return found

    def find_referenced(self, name: str, source: Path) -> Path | None:
        """The existing file that a robot file, `source`, refers to by this name, or None.

        `file://`, `package://` and `model://` are removed. Then the working directory, the directory of the
        robot file, each directory above that, and the two directories above the working directory are tried.
        The additional directory is not: it is for scripts only.
        """
        package, _, rest = _without_scheme(name).partition("/") if name.startswith(_SCHEMES) else ("", "", "")
        if package and rest and self.packages and (found := _in_packages(self.packages, package, rest)):
            return found
        name = _without_scheme(name)
        if _is_file(name):
            return path_of(name)
        # A name with a leading slash, left by `file:///`, still counts as relative to these directories.
        relative = name.lstrip("/\\")
        for directory in _folders_above(source):
            candidate = os.path.join(directory, relative)
            if _is_file(candidate):
                return path_of(candidate)
        for prefix in ("../", "../../"):
            if _is_file(prefix + relative):
                return path_of(prefix + relative)
        if package and rest and self.packages is not None:
            return _in_package_above(package, rest, source)
        return None

    def find_package(self, name: str, source: Path) -> Path | None:
        """The folder of a package that a robot file, `source`, names: in `packages`, or above the file.

        A folder is that of a package by its own name or by the one that its `package.xml` states; the folders
        beside those above the file count as well.
        """
        if not name or "/" in name or "\\" in name or name in (".", ".."):
            return None
        for folder in self.packages or ():
            for candidate in (folder / name, folder):
                if candidate.is_dir() and name in (candidate.name, _package_name(str(candidate))):
                    return candidate
        for above in _folders_above(source):
            if os.path.basename(above) == name or _package_name(above) == name:
                return path_of(above)
            beside = os.path.join(above, name)
            if os.path.isdir(beside):
                return path_of(beside)
        return None

    def find_in(self, directory: str, name: str, source: Path) -> Path | None:
        """The file of a name in a directory that a robot file states, with or without folders, or None."""
        name = _without_scheme(name)
        for path in (name, os.path.basename(name)):
            if found := self.find_referenced(os.path.join(directory, path), source):
                return found
        return None

    def find_included(self, name: str, source: Path) -> Path | None:
        """The file that a robot file includes: as `find_referenced`, and then as `find`."""
        return self.find_referenced(name, source) or self.find(_without_scheme(name))


@lru_cache(_CACHED)
def path_of(text: str) -> Path:
    """The path of a text, the same object each time: making one takes as long as looking for its file."""
    return Path(text)


@lru_cache(_CACHED)
def _folders_above(file: Path) -> tuple[str, ...]:
    return tuple(map(str, file.parents))


def _in_packages(packages: tuple[Path, ...], package: str, rest: str) -> Path | None:
    """A file of a package in one of some directories, or in one that is the package itself."""
    for folder in packages:
        inside = [os.path.join(folder, package, rest)]
        if folder.name == package or _package_name(str(folder)) == package:
            inside.append(os.path.join(folder, rest))
        for candidate in inside:
            if _is_file(candidate):
                return path_of(candidate)
    return None


def _in_package_above(package: str, rest: str, source: Path) -> Path | None:
    """A file of a package that is a folder above a robot file; its `package.xml` may state another name.

    Without such a folder, the file of that path below any of them.
    """
    above = _folders_above(source)
    named = [folder for folder in above if _package_name(folder) == package]
    for folder in (*named, *above[:-1]):
        candidate = os.path.join(folder, rest)
        if _is_file(candidate):
            return path_of(candidate)
    return None


@lru_cache(_CACHED)
def _package_name(folder: str) -> str | None:
    """The name of the ROS package in a folder, or None if there is none."""
    try:
        path = os.path.join(folder, "package.xml")
        # A named pipe would block.
        if not os.path.isfile(path):
            return None
        with open(path, encoding="utf-8", errors="replace") as stream:
            match = re.search(_PACKAGE_NAME, stream.read(_PACKAGE_BYTES))
    except (OSError, ValueError):
        return None
    return match.group(1).strip() if match else None


def _nearby(candidate: str) -> Path | None:
    """The file with a path, or, if that is relative, with this path in a nearby `data` folder."""
    for prefix in _DATA_PREFIXES[:1] if os.path.isabs(candidate) else _DATA_PREFIXES:
        if _is_file(prefix + candidate):
            return path_of(prefix + candidate)
    return None


def _without_scheme(name: str) -> str:
    name = name.removeprefix("file://")
    for scheme in _SCHEMES:
        if name.startswith(scheme):
            return name[len(scheme) :]
    return name


def _is_file(path: str) -> bool:
    try:
        # Most places that are searched have no such file, and this says so in less than half the time.
        return (os.access(path, os.F_OK) and os.path.isfile(path)) or appears(path)
    except ValueError:  # embedded NUL characters
        return False
