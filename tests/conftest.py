"""Settings that hold for all tests."""

import os

import pytest
from hypothesis import settings
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


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what only `make thorough` runs, unless `-m thorough` asks for it or a test is named."""
    if "thorough" in config.option.markexpr or any("::" in argument for argument in config.args):
        return
    left_out = [item for item in items if item.get_closest_marker("thorough")]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not item.get_closest_marker("thorough")]
