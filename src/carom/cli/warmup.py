"""Building and loading the native library before the first world: `python -m carom warmup`."""

from __future__ import annotations

from carom.native.library import library


def warmup() -> None:
    """Load the native library; if kernels have been edited, it is compiled first.

    Raises:
        NativeLibraryError: There is no library, and it cannot be compiled.
    """
    library()
