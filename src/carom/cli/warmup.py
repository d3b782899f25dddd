"""Builds and loads the native library before it is needed."""

from __future__ import annotations

from carom.native.library import library


def warmup() -> None:
    """Load the native library; where kernels have been edited it is compiled first.

    Raises:
        NativeLibraryError: There is none, and it cannot be compiled.
    """
    library()
