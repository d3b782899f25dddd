"""A small native library, built once."""

from __future__ import annotations

from pathlib import Path

import pytest

from carom.native.building.library import build
from carom.native.targets import TARGETS, Target, this_target

ROOT = Path(__file__).parents[3] / "src"
# One kernel, which compiles in a second or two.
SMALL_MODULE = "carom.kernels.queries.contact_report"


@pytest.fixture(scope="session")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("native")


@pytest.fixture(scope="session")
def target() -> Target:
    return this_target()


@pytest.fixture(scope="session")
def library(cache: Path, target: Target) -> Path:
    """The kernels of one module for this machine, of its oldest CPU level."""
    level = next(iter(TARGETS[target.name].levels))
    return build(ROOT, target, level, None, modules=[SMALL_MODULE], cache=cache)
