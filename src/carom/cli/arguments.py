"""What words of the command line have to be."""

from __future__ import annotations

import argparse


def positive(text: str) -> float:
    """A positive number.

    Raises:
        ArgumentTypeError: It is something else.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def named_value(text: str) -> tuple[str, str]:
    """A name and its value, of `NAME=VALUE`.

    Raises:
        ArgumentTypeError: It is something else.
    """
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return name, value
