from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p

ROBOTS = Path(__file__).parent / "robots"


@pytest.fixture(autouse=True)
def _no_connection_left() -> Iterator[None]:
    yield
    for client in range(8):
        if p.isConnected(client):
            p.disconnect(client)


@pytest.fixture
def client() -> int:
    return p.connect(p.DIRECT)


@pytest.fixture
def zoo(client: int) -> int:
    """Joints: 0 turning, 1 sliding, 2 fixed, 3 ball, 4 turning without end. The base is fixed."""
    return p.loadURDF(str(ROBOTS / "zoo.urdf"), useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def arm(client: int) -> int:
    """Joints: 0 and 1 turning, 2 sliding. The base is fixed."""
    return p.loadURDF(str(ROBOTS / "arm.urdf"), useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def floating_arm(client: int) -> int:
    """The arm on a base that floats, without gravity."""
    return p.loadURDF(str(ROBOTS / "arm.urdf"), [0.1, 0.2, 0.3], flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def arm_path() -> str:
    return str(ROBOTS / "arm.urdf")
