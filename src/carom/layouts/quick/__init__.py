"""Records that the native library keeps of worlds, bodies and calls, so that small calls need no Python."""
