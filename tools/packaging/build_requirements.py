"""Prints what builds Carom, `build-system.requires` of pyproject.toml, for builds without isolation.

    python -m pip install $(python tools/packaging/build_requirements.py)

Runs with pip alone, on Python 3.10 as well, which has no reader of TOML of its own.
"""

from pathlib import Path

from pip._vendor import tomli

_PROJECT = Path(__file__).parents[2] / "pyproject.toml"

if __name__ == "__main__":
    for requirement in tomli.loads(_PROJECT.read_text("utf-8"))["build-system"]["requires"]:
        print(requirement.replace(" ", ""))
