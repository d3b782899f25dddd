"""Ids of connections: each belongs to one connection, whoever connects or disconnects meanwhile."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from threading import Barrier
from typing import Any

import pytest

import pybullet as p
from pybullet._clients import clients as registry

THREADS, ROUNDS = 8, 25


@pytest.fixture(autouse=True)
def _no_connections() -> Iterator[None]:
    yield
    for number in range(THREADS + 2):
        if p.isConnected(number):
            p.disconnect(number)


class OldClient:
    """As scripts copy `BulletClient`: its finalizer ends the connection, though it may have ended before."""

    def __init__(self) -> None:
        self.client = p.connect(p.DIRECT)
        self.itself = self

    def __del__(self) -> None:
        with suppress(p.error):
            p.disconnect(physicsClientId=self.client)


def test_threads_get_ids_of_their_own() -> None:
    barrier = Barrier(THREADS)

    def connect() -> int:
        barrier.wait()
        return p.connect(p.DIRECT)

    with ThreadPoolExecutor(THREADS) as threads:
        for _ in range(ROUNDS):
            ids = sorted(job.result() for job in [threads.submit(connect) for _ in range(THREADS)])
            assert ids == list(range(THREADS))
            for number in ids:
                p.disconnect(number)


def test_ids_are_the_lowest_free_ones_as_in_pybullet() -> None:
    assert [p.connect(p.DIRECT) for _ in range(3)] == [0, 1, 2]
    p.disconnect(1)
    p.disconnect(0)
    assert [p.connect(p.DIRECT) for _ in range(3)] == [0, 1, 3]


def test_old_clients_in_cycles_do_not_end_later_connections() -> None:
    for _ in range(10):
        old = OldClient()
        p.disconnect(old.client)
        del old
        number = p.connect(p.DIRECT)
        gc.collect()
        assert p.isConnected(number)
        p.disconnect(number)


def test_a_finalizer_within_connect_does_not_end_the_new_connection(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from pybullet._connections import connection

    real = connection._let_quick_calls_in
    refused = []

    def finalized(slot: int, client: Any) -> None:
        try:
            p.disconnect(slot)
        except p.error:
            refused.append(slot)
        real(slot, client)

    monkeypatch.setattr(connection, "_let_quick_calls_in", finalized)
    number = p.connect(p.DIRECT)
    assert refused == [number]
    assert p.isConnected(number)
    p.disconnect(number)


def test_a_connection_that_fails_leaves_its_id_free() -> None:
    with pytest.raises(p.error):
        p.connect(99)
    assert not registry._being_connected
    assert p.connect(p.DIRECT) == 0
