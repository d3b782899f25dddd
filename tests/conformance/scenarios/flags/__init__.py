"""Flags of `loadURDF` that change how robots move."""
