"""Building the native library."""

from __future__ import annotations

import functools
import json
import os
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import util
from pathlib import Path
from typing import Any, TextIO

from carom.native.building.cache import (
    MANIFEST,
    alone,
    cache_folder,
    content_key,
    is_there,
    keep,
    library_place,
    mark_used,
    work_folder,
)
from carom.native.building.flags import C_FLAGS, CPP_FLAGS, OWN_FLAGS, PLATFORM_FLAGS, flags_of_module
from carom.native.building.jobs import Job, run_all
from carom.native.building.libm import called_functions, include_folders, maths_sources
from carom.native.building.link import link_command, remove_time
from carom.native.building.progress import ProgressLine
from carom.native.building.prune import prune
from carom.native.building.zig import BuildError, Zig, find_zig
from carom.native.digest import source_digest
from carom.native.kernel_modules import KERNEL_MODULES
from carom.native.targets import Target

# What the library says of itself, see `carom.native.library`: the digest of its sources, and its kernels.
_ABOUT = """#include "prelude.h"
extern "C" {{
CAROM_EXPORT extern const char carom_digest[] = "{digest}";
CAROM_EXPORT extern const char carom_kernels[] =
{kernels};
}}
"""
_HERE = Path(__file__).parent


@dataclass(frozen=True)
class _Build:
    """Data that all parts of one build need."""

    root: Path
    modules: tuple[str, ...]
    target: Target
    level: str
    digest: str
    cache: Path
    zig: Zig
    warp: Path
    progress: ProgressLine
    own_flags: tuple[str, ...]


def build(
    root: Path,
    target: Target,
    level: str,
    progress: TextIO | None = sys.stderr,
    *,
    modules: Sequence[str] = KERNEL_MODULES,
    cache: Path | None = None,
    own_flags: tuple[str, ...] = OWN_FLAGS,
) -> Path:
    """Build the native library, or find it in the cache.

    `root` contains the package `carom`; `modules` are the Python modules whose kernels are included, and
    `own_flags` those of the compiler for hand-written C++; with others than usual, the cache has to be
    another. Without a stream there is no progress display; without a cache folder it is `cache_folder()`.

    Returns:
        The library, in the cache; `manifest.json` is beside it.

    Raises:
        BuildError: Something is missing or does not compile.
        KeyboardInterrupt: All that was started has been ended.
    """
    digest = source_digest(root)
    cache = cache or cache_folder()
    folder = digest if modules == KERNEL_MODULES else f"{digest}-{content_key(*modules)}"
    library = library_place(cache, folder, target.library_name(level))
    if not is_there(library):
        with alone(cache):
            # Another process may have built it meanwhile.
            if not is_there(library):
                line = ProgressLine(progress)
                try:
                    # Zig's cache does not depend on our sources, so all builds share it.
                    zig = find_zig(cache_folder() / "zig")
                    of_machine = target, level, digest, cache, zig, _warp_folder()
                    _make(_Build(root, tuple(modules), *of_machine, line, own_flags), library)
                    prune(cache)
                finally:
                    line.end()
    mark_used(library.parent)
    return library


def _make(parts: _Build, library: Path) -> None:
    code = _generated_code(parts)
    with work_folder(parts.cache) as work:
        objects = _compiled(parts, code, work)
        made = work / "linked" / library.name
        made.parent.mkdir()
        command = link_command(parts.zig, parts.target, parts.level, objects, made)
        job = Job(library.name, command, lambda: None)
        run_all([job], parts.zig.environment(), _shows(parts.progress, f"linking {parts.level}"))
        remove_time(made)
        keep(made, library)
        (work / MANIFEST).write_bytes((code / MANIFEST).read_bytes())
        keep(work / MANIFEST, library.parent / MANIFEST)
    parts.progress.show(f"{library.name} is built", now=True)


def build_all(
    root: Path, target: Target, levels: Sequence[str], progress: TextIO | None = sys.stderr
) -> list[Path]:
    """Build, or take from the cache, the libraries for some CPU levels; raises errors as `build`.

    Returns:
        A library for each level, and their manifest.
    """
    libraries = [build(root, target, level, progress) for level in levels]
    return [*libraries, libraries[0].parent / MANIFEST]


def _generated_code(parts: _Build) -> Path:
    """The folder with the kernels as C++, their manifest, and the header for hand-written C++."""
    # The digest also covers the code generator.
    key = content_key(parts.digest, (parts.warp / "config.py").read_bytes(), *parts.modules)
    folder = parts.cache / "code" / key
    if folder.is_dir():
        mark_used(folder)
        return folder
    with work_folder(parts.cache) as work:
        code = work / "code"
        code.mkdir()
        environment = {
            **os.environ,
            "PYTHONPATH": _search_path(parts.root),
            "WARP_CACHE_PATH": str(work / "warp"),
        }
        program = [sys.executable, "-m", "carom.native.building.codegen"]
        job = Job("the kernels' C++", [*program, parts.digest, str(code), *parts.modules], lambda: None)
        run_all([job], environment, _shows(parts.progress, "generating code"))
        keep(code, folder)
    return folder


def _search_path(root: Path) -> str:
    """Where the code generator's process finds modules: where this one does.

    In front are the kernels of this root, whatever version of Carom is installed. Warp may be in a folder
    that only this process was told of, as in the environments that pip makes for a build.
    """
    return os.pathsep.join([str(root), *(folder for folder in sys.path if folder)])


def _compiled(parts: _Build, code: Path, work: Path) -> list[Path]:
    """Objects of kernels, of hand-written C++, and of the maths functions that these call."""
    folder = parts.root / "carom" / "native" / "source"
    about = work / "about.cpp"
    kernels = json.loads((code / MANIFEST).read_text("utf-8"))["kernels"]
    about.write_text(_ABOUT.format(digest=parts.digest, kernels=_listed(kernels)))
    rooms = [folder, *sorted(room for room in folder.iterdir() if room.is_dir())]
    own = [*(source for room in rooms for source in sorted(room.glob("*.cpp"))), about]
    if parts.target.suffix == ".dll":
        own.append(_HERE / "windows.cpp")
    kernels, headers = sorted(code.glob("*.cpp")), [_HERE, parts.warp / "native"]
    objects = _objects(parts, "kernels", "c++", CPP_FLAGS, kernels, headers, work)
    objects += _objects(parts, "the rest", "c++", parts.own_flags, own, [*headers, *rooms, code], work)
    maths = maths_sources(called_functions(objects), parts.zig.library)
    folders = include_folders(parts.zig.library)
    return objects + _objects(parts, "maths", "cc", C_FLAGS, maths, folders, work)


def _listed(kernels: Mapping[str, Any]) -> str:
    """A line for each kernel, as strings in C++: its name, its symbol, and name and type of each argument."""
    lines = []
    for name, kernel in kernels.items():
        arguments = " ".join(f"{argument}:{kind}" for argument, kind, _ in kernel["arguments"])
        lines.append(f'    "{name} {kernel["symbol"]} {arguments}\\n"')
    return "\n".join(lines)


def _objects(
    parts: _Build,
    what: str,
    language: str,
    flags: tuple[str, ...],
    sources: list[Path],
    includes: list[Path],
    work: Path,
) -> list[Path]:
    """Object files of sources, compiled if they are not in the cache."""
    flags = (*flags, *PLATFORM_FLAGS[parts.target.suffix])
    header_files = [path for folder in includes for path in sorted(folder.glob("*.h"))]
    headers = content_key(*(path.read_bytes() for path in header_files))
    objects = []
    jobs = []
    # The longest first, so that no core is left with one of them at the end.
    for source in sorted(sources, key=lambda path: -path.stat().st_size):
        own = (*flags, *flags_of_module(source.stem))
        plain = parts.zig.command(language, parts.target, parts.level, own)[1:]
        key = content_key(source.read_bytes(), headers, parts.zig.version, *plain)
        kept = parts.cache / "objects" / f"{key}.o"
        objects.append((source.name, kept))
        if kept.exists():
            mark_used(kept)
            continue
        made = work / f"{key}.o"
        arguments = [*own, *(f"-I{folder}" for folder in includes), "-c", source, "-o", made]
        command = parts.zig.command(language, parts.target, parts.level, arguments)
        jobs.append(Job(source.stem, command, functools.partial(keep, made, kept)))
    run_all(jobs, parts.zig.environment(), _shows(parts.progress, f"compiling {what} for {parts.level}"))
    return [kept for _, kept in sorted(objects)]


def _shows(line: ProgressLine, doing: str) -> functools.partial[None]:
    def show(ended: int, count: int) -> None:
        line.show(f"{doing} {ended}/{count}" if count > 1 else doing)

    return functools.partial(show)


def _warp_folder() -> Path:
    package = util.find_spec("warp")
    folders = list(package.submodule_search_locations or ()) if package else []
    if not folders:
        raise BuildError(
            "the native library is built from code that NVIDIA Warp generates, but Warp is not installed: "
            f"run {sys.executable} -m pip install 'carom[build]'"
        )
    version = re.search(
        r'^version: str = "([^"]*)"', (Path(folders[0]) / "config.py").read_text(), re.MULTILINE
    )
    if version is None or not version[1].startswith("1.19."):
        raise BuildError(
            "the native library is built from code that NVIDIA Warp 1.19 generates; the installed version is "
            f"{version[1] if version else 'unknown'}"
        )
    return Path(folders[0])
