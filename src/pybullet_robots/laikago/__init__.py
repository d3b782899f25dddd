"""The walking robot Laikago."""
