"""Ray for the tests of this folder."""

from collections.abc import Iterator
from typing import Any

import pytest
from tests.cluster.small_ray import cluster_of_two, ray_here


@pytest.fixture(scope="module")
def laptop() -> Iterator[Any]:
    """Ray on this machine alone."""
    with ray_here() as ray:
        yield ray


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two nodes, as processes of this machine."""
    with cluster_of_two() as nodes:
        yield nodes
