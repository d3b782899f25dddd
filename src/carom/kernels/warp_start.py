"""Starting Warp without its messages on the user's terminal."""

from __future__ import annotations

import os
import sys
import tempfile

import warp as wp

# Warp's native code writes this on every machine without an NVIDIA driver; users need not see it.
_NO_NEWS = b"Could not find or load the NVIDIA CUDA driver"


def start_warp() -> None:
    """Initialise Warp; its banner and its message about a missing CUDA driver are not shown.

    Native code writes the message to the C stream `stderr`. So the file descriptor of standard error is
    redirected to a file while Warp starts. All other lines of that file are then written to standard error.
    """
    wp.config.log_level = wp.LOG_ERROR
    try:
        sys.stderr.flush()
        stderr = os.dup(2)
    except (OSError, ValueError, AttributeError):
        # There is no standard error stream to keep clean.
        wp.init()
        return
    with tempfile.TemporaryFile() as diverted:
        os.dup2(diverted.fileno(), 2)
        try:
            wp.init()
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)
            diverted.seek(0)
            kept = b"".join(line for line in diverted if _NO_NEWS not in line)
            if kept:
                os.write(2, kept)
