"""Starting Warp without noise on the user's terminal."""

from __future__ import annotations

import os
import sys
import tempfile

import warp as wp

# Written by Warp's native code wherever there is no NVIDIA driver, which is no news to anybody.
_NO_NEWS = b"Could not find or load the NVIDIA CUDA driver"


def start_warp() -> None:
    """Initialise Warp; its banner and its note on the missing GPU are not shown.

    Native code writes the note to the C stream, so the file descriptor is diverted while Warp starts;
    everything else that was written there is passed on.
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
