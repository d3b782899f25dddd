"""The native library: finding the one for this machine, loading it, and descriptions of its kernels."""

from __future__ import annotations

import ctypes
import functools
import threading
from importlib import util
from pathlib import Path
from typing import Any

from carom.errors import NativeLibraryError
from carom.forks import free_in_forks
from carom.native.cpu import cpu_levels
from carom.native.digest import source_digest
from carom.native.targets import NoTarget, Target, this_target

Arguments = tuple[tuple[str, str], ...]

_HERE = Path(__file__).parent
_ROOT = _HERE.parents[1]
MANIFEST = "manifest.json"
_MANIFEST_BEGINNING = '{"digest":"'
_DIGEST_PLACE, _DIGEST_DIGITS = len(_MANIFEST_BEGINNING), 32
PACKAGED = _HERE / "libraries"
"""The folder of the libraries in wheels."""
# Packages that compile libraries.
_COMPILERS = ("warp", "ziglang")
_loading = free_in_forks(threading.RLock())


class Library:
    """A loaded library; its `manifest.json` is beside it, and both have the required digest, if there is one.

    Attributes:
        path: The file.
        perform: Performs programs of launches; see `carom.engine.interpreter`.
        symbols: Its functions and variables by name.

    Raises:
        NativeLibraryError: It is damaged, for another platform, or built from other sources.
    """

    def __init__(self, path: Path, digest: str | None) -> None:
        try:
            # One of other sources is not loaded: it would stay in memory.
            found = _stated_digest(path.parent / MANIFEST)
            expected = digest or found
            if found == expected:
                # Calls through it release the GIL, so that other threads run meanwhile.
                self._loaded = ctypes.CDLL(str(path))
                found = _text(self._loaded, "carom_digest")
                lines = _text(self._loaded, "carom_kernels").splitlines()
                self._kernels: dict[str, str] = {line.partition(" ")[0]: line for line in lines}
                self.perform: Any = self._loaded.carom_perform
        except (OSError, ValueError) as problem:
            raise NativeLibraryError(f"{path} cannot be loaded: {problem}. {_cure()}") from None
        if found != expected:
            raise NativeLibraryError(
                f"{path} was built from other kernels than those installed here. {_cure()}"
            )
        self.perform.restype = None
        self.path = path
        self.symbols: ctypes.CDLL = self._loaded

    def arguments(self, kernel: str) -> Arguments:
        """Name and type of each argument of a kernel."""
        _, _, *arguments = self._entry(kernel)
        pairs = (argument.partition(":") for argument in arguments)
        return tuple((name, kind) for name, _, kind in pairs)

    def function(self, kernel: str) -> Any:
        """The C function of a kernel, which takes the addresses of its bounds and of its arguments."""
        _, symbol, *_ = self._entry(kernel)
        function = getattr(self._loaded, symbol)
        function.restype = None
        return function

    def maths(self, name: str) -> Any:
        """The C function that replaces the number at an address by its sine, or whatever `name` is."""
        function = getattr(self._loaded, f"carom_{name}_of")
        function.restype = None
        return function

    def number_kernel(self, kernel: str) -> Any:
        """The C function of a kernel of quick calls: takes numbers, an array for the results, and a `Call`.

        Numbers are bytes, the `Call` is given by its address. It returns whether there are results. The GIL
        is held meanwhile.
        """
        signature = ctypes.PYFUNCTYPE(ctypes.c_int, *[ctypes.c_void_p] * 3)
        return signature((f"carom_{kernel}", self.symbols))

    def _entry(self, kernel: str) -> list[str]:
        """Its name, its symbol, and name and type of each argument, with a colon between them."""
        line = self._kernels.get(kernel)
        if line is None:
            raise NativeLibraryError(f"the native library has no kernel {kernel!r}")
        return line.split(" ")


def _stated_digest(manifest: Path) -> str:
    """The digest with which a manifest begins; reading it all would take as long as the rest."""
    with manifest.open(encoding="utf-8") as file:
        beginning = file.read(_DIGEST_PLACE + _DIGEST_DIGITS)
    if not beginning.startswith(_MANIFEST_BEGINNING) or len(beginning) < _DIGEST_PLACE + _DIGEST_DIGITS:
        raise ValueError(f"{manifest} does not begin with a digest")
    return beginning[_DIGEST_PLACE:]


def _text(library: ctypes.CDLL, name: str) -> str:
    return ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(library, name))).decode()


def library() -> Library:
    """The library for this machine; it is built first if kernels have been edited.

    Raises:
        NativeLibraryError: There is none, and none can be built.
    """
    # Threads that start at the same time get the same library.
    with _loading:
        return _library()


@functools.cache
def _library() -> Library:
    try:
        target = this_target()
    except NoTarget as problem:
        raise NativeLibraryError(f"{problem}") from None
    offered = cpu_levels()
    levels = target.usable_levels(offered)
    if not levels:
        raise NativeLibraryError(
            f"CAROM_CPU_LEVEL is {offered[0]!r}; expected one of {', '.join(target.levels)}"
        )
    packaged = [PACKAGED / target.library_name(level) for level in levels]
    found = next((path for path in packaged if path.exists()), None)
    can_build = all(util.find_spec(compiler) for compiler in _COMPILERS)
    if found is not None and not _is_clone():
        # The sources came with it. Reading them all would take a tenth of the time to the first step.
        return Library(found, None)
    digest = source_digest(_ROOT)
    if found is not None:
        try:
            return Library(found, digest)
        except NativeLibraryError:
            if not can_build:
                raise
    elif not can_build:
        raise NativeLibraryError(f"Carom's native library is missing ({packaged[0]}). {_cure()}")
    return Library(_built(target, levels[0], digest), digest)


def _built(target: Target, level: str, digest: str) -> Path:
    """The library for a CPU level, from the cache or compiled now."""
    from carom.native.building.cache import cache_folder, is_there, library_place, mark_used

    # The code that builds it is imported only if there is something to build.
    path = library_place(cache_folder(), digest, target.library_name(level))
    if is_there(path):
        mark_used(path.parent)
        return path
    from carom.native.building.library import build
    from carom.native.building.zig import BuildError

    try:
        return build(_ROOT, target, level)
    except BuildError as problem:
        raise NativeLibraryError(f"{problem}") from None


def _is_clone() -> bool:
    """Whether the sources are those of a clone, which somebody may edit."""
    return (_ROOT.parent / "pyproject.toml").exists()


def _cure() -> str:
    if _is_clone():
        return (
            "Run `pip install --editable .` in the clone, which builds it; after `pip install --editable "
            "'.[build]'` it is built whenever kernels have been edited."
        )
    return "Install Carom again: `pip install --force-reinstall carom`."
