"""Copies of the checkout in which mutants are tried, with a cache of native libraries of their own."""

from __future__ import annotations

import compileall
import importlib.util
import os
import py_compile
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from carom.native.building.cache import MANIFEST, alone, cache_folder, content_key
from carom.native.digest import source_digest
from carom.native.kernel_modules import KERNEL_MODULES

ROOT = Path(__file__).parents[2]
# What the native library is compiled from.
_BY_HAND = "src/carom/native/source/"
_COMPILED = ("src/carom/kernels/", "src/carom/layouts/", _BY_HAND)
_SECONDS_TO_BUILD = 1200.0
# Some mutants never come to an end.
SECONDS_TO_TEST = 600.0
# All tests of some files are long, and left out.
_FINE = (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)


def is_compiled(file: str) -> bool:
    """Whether the native library has to be built anew for a change of a file."""
    return file.startswith(_COMPILED)


def copy_checkout(folder: Path) -> None:
    """Copy what git knows of the checkout, and new files it does not ignore, as they are now."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, folder / name)
    # Compiled Python is usually told apart by times in seconds and sizes, which mutants have in common.
    mode = py_compile.PycInvalidationMode.CHECKED_HASH
    compileall.compile_dir(folder / "src", quiet=2, invalidation_mode=mode)


def copy_cache(folder: Path) -> None:
    """Copy objects, generated code and what the compiler keeps: mutants drive nothing out of the cache."""
    kept = cache_folder()
    # While nobody builds: files come and go.
    with alone(kept):
        for part in ("libraries", "objects", "zig", "code"):
            if (kept / part).is_dir():
                shutil.copytree(kept / part, folder / part)


def take_over_code(cache: Path, before: str, after: str) -> None:
    """Keep the C++ that was generated from kernels for sources of which only C++ written by hand is another.

    Its key holds the digest of all sources, so it would be generated anew, which takes longer than all else.

    Args:
        cache: The cache of native libraries.
        before: Digest of the sources it was generated from; nothing is done if there is none of them.
        after: That of the others.
    """
    warp = importlib.util.find_spec("warp")
    if warp is None or warp.origin is None:
        return
    config = Path(warp.origin).with_name("config.py").read_bytes()
    old, new = (cache / "code" / content_key(digest, config, *KERNEL_MODULES) for digest in (before, after))
    if old.is_dir() and not new.exists():
        shutil.copytree(old, new)
        manifest = (old / MANIFEST).read_text(encoding="utf-8")
        (new / MANIFEST).write_text(manifest.replace(before, after), encoding="utf-8", newline="\n")


class Copy:
    """A copy of the checkout in which one mutant after the other is tried.

    Args:
        folder: Where it is.
        cache: Where native libraries are kept, for all copies.
    """

    def __init__(self, folder: Path, cache: Path) -> None:
        self._folder = folder
        self._cache = cache
        self._environment = {
            **os.environ,
            "PYTHONPATH": str(folder / "src"),
            # What is compiled is compiled before, by content.
            "PYTHONDONTWRITEBYTECODE": "1",
            "CAROM_CACHE_PATH": str(cache),
            # The same random cases each time.
            "CI": "1",
        }

    def passes(
        self, tests: Sequence[str], limit: float | None = SECONDS_TO_TEST, *, quiet: bool = True
    ) -> str | None:
        """None if tests pass; else `killed`, or `timed out`."""
        options = ("-x", "-q", "-p", "no:cacheprovider")
        return self._runs(("pytest", *options, *tests), limit, "killed", quiet)

    def builds(self) -> str | None:
        """None if the native library can be built; else what is wrong."""
        return self._runs(("carom", "warmup"), _SECONDS_TO_BUILD, "does not build", True)

    def _runs(self, command: Sequence[str], limit: float | None, failed: str, quiet: bool) -> str | None:
        arguments = [sys.executable, "-m", *command]
        output = subprocess.DEVNULL if quiet else None
        try:
            done = subprocess.run(
                arguments,
                cwd=self._folder,
                env=self._environment,
                stdout=output,
                stderr=output,
                timeout=limit,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return "timed out"
        return None if done.returncode in _FINE else failed

    def tried(self, file: str, mutated: str, tests: Sequence[str]) -> str:
        """Change a file, run tests, and take the change back; what becomes of the mutant.

        Returns:
            `killed` or `timed out`, which both mean that tests notice; `survived`, or `does not build`.
        """
        path = self._folder / file
        source = path.read_bytes()
        before = source_digest(self._folder / "src") if file.startswith(_BY_HAND) else None
        path.write_text(mutated, encoding="utf-8", newline="")
        try:
            if before is not None:
                take_over_code(self._cache, before, source_digest(self._folder / "src"))
            return (self.builds() if is_compiled(file) else None) or self.passes(tests) or "survived"
        finally:
            path.write_bytes(source)
