"""A table of ten rows, printed and written to a file: `python -m pybullet_utils.examples.testlog`."""

from __future__ import annotations

from pybullet_utils.logger import Logger


def main() -> None:
    """Writes ten rows to `output/testlog.txt`."""
    logger = Logger()
    logger.configure_output_file("output/testlog.txt")
    for iteration in range(10):
        logger.log_tabular("Iteration", iteration)
        logger.log_tabular("Square", float(iteration**2))
        logger.print_tabular()
        logger.dump_tabular()


if __name__ == "__main__":
    main()
