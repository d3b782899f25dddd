"""The commands of `python -m carom`."""
