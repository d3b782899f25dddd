"""Settings that hold for all tests."""

import gc
import os

# A process for each core leaves none for threads of matrix products, which would wait for each other. NumPy
# looks when it is imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from pathlib import Path

import pytest
from hypothesis import settings
from tests import rings
from tests.conformance.memory import resident_bytes
from tests.thorough.profiles import DEFAULT_CASES, FACTORS, PROFILE

# A busy machine is no reason to fail; and a run that decides about a change has to be repeatable. The long
# profile tries other cases each time, unless `--hypothesis-seed` says which.
for name, factor in FACTORS.items():
    settings.register_profile(
        name,
        deadline=None,
        derandomize=name == "short" and "CI" in os.environ,
        max_examples=DEFAULT_CASES * factor,
    )
settings.load_profile(PROFILE)
# Viewers open a browser where somebody could see it, but not here.
os.environ.setdefault("CI", "")
# The files are Carom's own, whatever copies the user has.
os.environ["CAROM_PYBULLET_DATA"] = "own"

# The file whose tests run, what was resident when garbage was last collected, and how much more is too much.
_FILE, _RESIDENT = pytest.StashKey[Path](), pytest.StashKey[int]()
_MUCH = 50_000_000


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--long", action="store_true", help="also run what takes long: `tests/rings.py` says what"
    )


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not even import what is long as a whole, unless it is asked for."""
    if config.option.long or not rings.is_long(collection_path):
        return None
    return None if any(rings.names(argument, collection_path) for argument in config.args) else True


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what is long as a whole, and leave out what belongs to other rings."""
    for item in items:
        if rings.is_long(item.path):
            item.add_marker("long")
    out = rings.left_out(config, items)
    if out:
        config.hook.pytest_deselected(items=out)
        ids = set(map(id, out))
        items[:] = [item for item in items if id(item) not in ids]


def pytest_collection_finish(session: pytest.Session) -> None:
    """Tests that collect garbage need not go through the heap of the suite each time."""
    _set_heap_aside(session.config)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> None:
    """Nor through what the files before have left, nor keep the memory of their worlds.

    Worlds that nobody closes are in cycles: large, but few objects, so that Python collects nothing.
    """
    stash = item.config.stash
    if item.path != stash.get(_FILE, None) or (resident_bytes() or 0) > stash[_RESIDENT] + _MUCH:
        stash[_FILE] = item.path
        _set_heap_aside(item.config)


def _set_heap_aside(config: pytest.Config) -> None:
    """Collect garbage, and let later collections pass over what is left; reference counts still free it."""
    gc.collect()
    gc.freeze()
    config.stash[_RESIDENT] = resident_bytes() or 0
