"""The user's own copy of PyBullet's files for `pybullet_data`: `python -m carom data`."""

from __future__ import annotations

import hashlib
import os
import shutil
from base64 import urlsafe_b64encode
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory, mkdtemp
from zipfile import BadZipFile, ZipFile

from carom.errors import CaromError
from carom.writing import write_whole
from pybullet_data._copies import SERVED, copies_folder, is_data_folder, served_copy

_PACKAGE = "pybullet_data"
_LISTING = "LISTING"
"""A file in each copy: digest, size and name of each other file."""

# The digest of the listing of the files of a version; they are the same on all platforms.
_KNOWN = {"3.2.7": "a0421047a2e9bf3cb264af150d32adfb2b312822488942af4d1a3a7625903eb8"}
_MAX_NAMED = 3


@dataclass(frozen=True, slots=True)
class Copy:
    """A copy of PyBullet's files.

    Attributes:
        folder: Where it is.
        version: The version of PyBullet whose files they are.
        count: The number of files.
    """

    folder: Path
    version: str
    count: int


def take_over(source: Path) -> Copy:
    """Copy the files of PyBullet's `pybullet_data`, and have `getDataPath` serve them.

    They are those of the version whose digest Carom knows, or else agree with the `RECORD` that is in the
    wheel or beside the installed package.

    Args:
        source: A wheel of PyBullet, a folder `pybullet_data`, or a folder with one, as `site-packages`.

    Raises:
        CaromError: It has no such files, or they are not as PyBullet has published them.
        OSError: They cannot be read or copied.
    """
    with _opened(source) as folder:
        listing = _listing_of(folder)
        version = _version_of(folder, listing)
        name = f"{version}-{_digest_of(listing)[:16]}"
        copies = Path(copies_folder())
        target = copies / name
        if not target.is_dir():
            _copy(folder, listing, target)
    write_whole(copies / SERVED, f"{name}\n".encode())
    return check()


def check() -> Copy:
    """The copy that is served, after all of its files have been read and compared.

    Raises:
        CaromError: There is none, or a file has changed since it was copied.
    """
    served = served_copy()
    if served is None:
        raise CaromError("getDataPath serves Carom's own files; there is no copy of PyBullet's")
    folder = Path(served)
    noted = folder.joinpath(_LISTING).read_text("utf-8").splitlines()
    present = [f"{digest} {size} {name}" for name, (digest, size) in _listing_of(folder).items()]
    differing = sorted({line.split(" ", 2)[2] for line in set(noted) ^ set(present)})
    if differing:
        raise CaromError(f"{folder} has changed: {_named(differing)}; copy the files again")
    return Copy(folder, folder.name.partition("-")[0], len(present))


def serve_own() -> None:
    """Have `getDataPath` serve Carom's own files again; copies stay."""
    Path(copies_folder(), SERVED).unlink(missing_ok=True)


@contextmanager
def _opened(source: Path) -> Iterator[Path]:
    """The folder `pybullet_data` of a source, in a temporary folder if it is a wheel."""
    if source.is_file():
        with TemporaryDirectory() as folder:
            try:
                with ZipFile(source) as wheel:
                    names = [name for name in wheel.namelist() if _is_wanted(name)]
                    wheel.extractall(folder, names)
            except BadZipFile as problem:
                raise CaromError(f"{source} is not a wheel: {problem}") from problem
            yield _data_folder(Path(folder), source)
    else:
        yield _data_folder(source, source)


def _is_wanted(name: str) -> bool:
    first, *rest = PurePosixPath(name).parts
    return first == _PACKAGE or (first.endswith(".dist-info") and rest == ["RECORD"])


def _data_folder(folder: Path, source: Path) -> Path:
    for candidate in (folder / _PACKAGE, folder):
        if is_data_folder(str(candidate)):
            return candidate
    raise CaromError(
        f"{source} has no {_PACKAGE}: a wheel of PyBullet, or a folder with its files, is needed"
    )


def _listing_of(folder: Path) -> dict[str, tuple[str, int]]:
    """Digest (SHA-256) and size of all files but Python's, by their names with slashes, in order."""
    found = {}
    for path in folder.rglob("*"):
        if path.is_file() and path.suffix not in (".py", ".pyc") and path != folder / _LISTING:
            data = path.read_bytes()
            found[path.relative_to(folder).as_posix()] = hashlib.sha256(data).hexdigest(), len(data)
    return dict(sorted(found.items()))


def _digest_of(listing: dict[str, tuple[str, int]]) -> str:
    lines = [f"{digest} {size} {name}\n" for name, (digest, size) in listing.items()]
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def _version_of(folder: Path, listing: dict[str, tuple[str, int]]) -> str:
    """The version of PyBullet whose files these are."""
    digest = _digest_of(listing)
    for version, known in _KNOWN.items():
        if digest == known:
            return version
    records = sorted(folder.parent.glob("pybullet-*.dist-info/RECORD"))
    if not records:
        versions = " or ".join(_KNOWN)
        raise CaromError(
            f"the {len(listing)} files of {folder} are not those of PyBullet {versions}, and there is no "
            "pybullet-*.dist-info/RECORD beside it that says how they were; give a wheel"
        )
    expected = _recorded(records[-1])
    present = {name: (_as_recorded(digest), size) for name, (digest, size) in listing.items()}
    differing = [name for name in sorted({*expected, *present}) if expected.get(name) != present.get(name)]
    if differing:
        raise CaromError(f"files of {folder} are not as PyBullet published them: {_named(differing)}")
    return records[-1].parent.name.removeprefix("pybullet-").removesuffix(".dist-info")


def _recorded(record: Path) -> dict[str, tuple[str, int]]:
    """Digest and size of the data files in a RECORD, by their names in `pybullet_data`."""
    found = {}
    for line in record.read_text("utf-8").splitlines():
        name, digest, size = line.rsplit(",", 2)
        name = name.strip('"')
        if name.startswith(f"{_PACKAGE}/") and not name.endswith((".py", ".pyc")):
            found[name.removeprefix(f"{_PACKAGE}/")] = digest, int(size or 0)
    return found


def _as_recorded(digest: str) -> str:
    return "sha256=" + urlsafe_b64encode(bytes.fromhex(digest)).decode().rstrip("=")


def _named(names: list[str]) -> str:
    more = f" and {len(names) - _MAX_NAMED} more" if len(names) > _MAX_NAMED else ""
    return ", ".join(names[:_MAX_NAMED]) + more


def _copy(folder: Path, listing: dict[str, tuple[str, int]], target: Path) -> None:
    """Copy the files of a listing to a new folder, which is there whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = Path(mkdtemp(prefix=".unfinished-", dir=target.parent))
    try:
        unfinished.chmod(0o755)
        lines = []
        for name, (digest, size) in listing.items():
            place = unfinished / name
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(folder / name, place)
            lines.append(f"{digest} {size} {name}\n")
        unfinished.joinpath(_LISTING).write_bytes("".join(lines).encode())
        os.replace(unfinished, target)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
