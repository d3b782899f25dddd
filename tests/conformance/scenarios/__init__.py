"""The scenarios; every module registers its own on import."""
