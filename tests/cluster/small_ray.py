"""Ray, as small as it can be: the tests run where there are few processors."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

STORE = 80_000_000
_ROOT = Path(__file__).parents[2]
_ATTEMPTS = 4


@contextmanager
def ray_here() -> Iterator[Any]:
    """Ray on this machine alone."""
    ray = _ray()

    def start() -> None:
        # Without an address Ray might find a cluster that somebody else has started here.
        small = {"num_cpus": 1, "object_store_memory": STORE, "include_dashboard": False}
        ray.init(address="local", log_to_driver=False, **small)

    with _path_of_other_processes():
        _patiently(start, ray.shutdown)
        try:
            yield ray
        finally:
            ray.shutdown()


@contextmanager
def cluster_of_two() -> Iterator[Any]:
    """Two nodes of one processor each, as processes of this machine."""
    ray = _ray()
    from ray.cluster_utils import Cluster  # pyright: ignore[reportMissingImports]

    nodes = Cluster()
    with _path_of_other_processes():
        try:
            _patiently(lambda: add_node(nodes, include_dashboard=False), nodes.shutdown)
            add_node(nodes)
            _patiently(lambda: ray.init(address=nodes.address, log_to_driver=False), ray.shutdown)
            yield nodes
        finally:
            ray.shutdown()
            nodes.shutdown()


def add_node(nodes: Any, num_cpus: int = 1, **options: Any) -> Any:
    """Another node."""
    return _patiently(lambda: nodes.add_node(num_cpus=num_cpus, object_store_memory=STORE, **options))


def _ray() -> Any:
    return pytest.importorskip("ray", reason="needs Ray: make cluster")


@contextmanager
def _path_of_other_processes() -> Iterator[None]:
    """Ray's processes find the tests and the examples, as this one does."""
    with pytest.MonkeyPatch.context() as patch:
        for folder in (_ROOT, _ROOT / "examples"):
            patch.setenv("PYTHONPATH", str(folder), prepend=os.pathsep)
        yield


def _patiently(start: Callable[[], Any], clear_up: Callable[[], Any] = lambda: None) -> Any:
    """Start something of Ray's; on a busy machine its processes give each other up too soon."""
    for _ in range(_ATTEMPTS - 1):
        try:
            return start()
        except Exception:
            clear_up()
    return start()
