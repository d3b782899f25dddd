"""Arguments parsed by `ArgParser`: `python -m pybullet_utils.examples.testargs --bodies 1 2 --name x`."""

from __future__ import annotations

import sys

from pybullet_utils.arg_parser import ArgParser


def main() -> None:
    """Prints the arguments of the command line."""
    arguments = ArgParser()
    arguments.load_args(sys.argv[1:])
    print("name =", arguments.parse_string("name", "nobody"))
    print("bodies =", arguments.parse_ints("bodies"))


if __name__ == "__main__":
    main()
