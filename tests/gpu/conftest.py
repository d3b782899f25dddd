"""The device that worlds are tried on: Warp's own CPU device, or a GPU if one is named.

`CAROM_TEST_DEVICE=cuda` names one, as `make gpu` does.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path

import pytest

from carom import World

# Modules of the kernels that steps of worlds and their questions launch.
_MODULES = (
    "arrays.arithmetic",
    "dynamics.kinematics",
    "parallel.batches",
    "parallel.contact_rows",
    "parallel.detection",
    "parallel.joint_rows",
    "parallel.restless_sweeps",
    "parallel.runs",
    "parallel.soft_contact",
    "parallel.soft_motion",
    "parallel.soft_nodes",
    "parallel.sweeps",
    "parallel.trees",
    "queries.closest",
    "queries.rays",
    "queries.touching",
    "solver.sleeping",
)
_PATIENCE = 300.0


@pytest.fixture(scope="session")
def device() -> str:
    """The device's name. Kernels for Warp's CPU device are compiled before, quickly: not optimised."""
    import warp as wp

    from carom.kernels.warp_start import start_warp

    named = os.environ.get("CAROM_TEST_DEVICE", "warp-cpu")
    if named != "warp-cpu":
        return named
    start_warp()
    wp.config.optimization_level = 0
    # One of the processes that share the tests compiles, and the others find what it has made.
    with _alone("carom-warp-cpu-tests"):
        for name in _MODULES:
            module = f"carom.kernels.{name}"
            import_module(module)
            wp.load_module(module, device="cpu")
    return named


@contextmanager
def _alone(name: str) -> Iterator[None]:
    """Wait until no other process holds a folder of that name, and hold it."""
    folder = Path(tempfile.gettempdir()) / name
    while True:
        with suppress(FileExistsError):
            folder.mkdir()
            break
        with suppress(FileNotFoundError):
            if time.time() - folder.stat().st_mtime > _PATIENCE:
                # Whoever made it is gone.
                break
        time.sleep(0.1)
    try:
        yield
    finally:
        with suppress(FileNotFoundError):
            folder.rmdir()


@pytest.fixture(autouse=True)
def contacts_that_gpus_have(monkeypatch: pytest.MonkeyPatch) -> None:
    """Worlds that do not name a law of contacts have the only one that is built for GPUs."""
    defaults = World.__init__.__kwdefaults__
    assert defaults is not None
    monkeypatch.setitem(defaults, "contact", "bullet")
