"""`BulletClient` closes its connection when nothing holds it any more."""

import gc

import pybullet as p
from pybullet_utils.bullet_client import BulletClient


def test_a_client_that_is_gone_is_disconnected() -> None:
    client = BulletClient(p.DIRECT)
    number = client._client
    assert p.isConnected(number)
    del client
    gc.collect()
    assert not p.isConnected(number)
